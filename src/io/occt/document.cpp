#include "io/occt/document.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BinTools.hxx>
#include <IGESCAFControl_Reader.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESModel.hxx>
#include <Message_ProgressIndicator.hxx>
#include <Message_ProgressScope.hxx>
#include <STEPCAFControl_ExternFile.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_SequenceOfAsciiString.hxx>
#include <TopoDS_Shape.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "io/occt/references.h"

namespace crescente::io::occt {
namespace {

namespace fs = std::filesystem;

// Carries OpenCASCADE's idea of how far it is to ours.
class Indicator : public Message_ProgressIndicator {
public:
    Indicator(const Progress& progress, double from, double to, const char* stage) : progress_(progress), from_(from), to_(to), stage_(stage) {}

protected:
    void Show(const Message_ProgressScope&, const Standard_Boolean) override {
        const double now = from_ + (to_ - from_) * GetPosition();
        constexpr double step = 0.005;
        if (now < last_ + step) return;
        last_ = now;
        progress_(now, stage_);
    }

private:
    const Progress& progress_;
    double from_, to_, last_ = -1;
    const char* stage_;
};

constexpr double parsed = 0.3, transferred = 0.8;  // shares of the whole, about
constexpr const char* reading = "reading";
constexpr const char* transferring = "building shapes";

struct LengthUnit {
    const char* name;  // as OpenCASCADE says it
    const char* shown;
    double metres;
};
constexpr LengthUnit step_units[] = {{"metre", "m", 1},          {"millimetre", "mm", 1e-3},   {"centimetre", "cm", 1e-2},  {"kilometre", "km", 1e3},
                                     {"micrometre", "um", 1e-6}, {"decimetre", "dm", 1e-1},    {"inch", "in", 0.0254},      {"foot", "ft", 0.3048},
                                     {"mile", "mi", 1609.344},   {"milliinch", "mil", 2.54e-5}, {"microinch", "uin", 2.54e-8}};

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

void take_step_unit(const STEPControl_Reader& reader, CadDocument& result) {
    TColStd_SequenceOfAsciiString lengths, angles, solid_angles;
    const_cast<STEPControl_Reader&>(reader).FileUnits(lengths, angles, solid_angles);
    if (lengths.IsEmpty()) return;
    const std::string name = lower(lengths.First().ToCString());
    for (const LengthUnit& unit : step_units) {
        if (name == unit.name || name == std::string(unit.name) + "s" || name == unit.shown) {
            result.unit = unit.shown, result.unit_metres = unit.metres;
            return;
        }
    }
    result.warnings.push_back({{}, {}, "its unit of length '" + name + "' is not known here: lengths are shown in millimetres", {}});
}

void tell_missing_references(const STEPCAFControl_Reader& reader, const fs::path& file, CadDocument& result) {
    const auto& files = reader.ExternFiles();
    for (NCollection_DataMap<TCollection_AsciiString, Handle(STEPCAFControl_ExternFile)>::Iterator each(files); each.More(); each.Next()) {
        if (!each.Value().IsNull() && each.Value()->GetLoadStatus() == IFSelect_RetDone) continue;
        const std::string name = each.Key().ToCString();
        std::error_code code;
        const bool there = fs::exists(file.parent_path() / name, code);
        result.warnings.push_back({{}, {}, "'" + name.substr(0, 100) + "', which it names, " + (there ? "cannot be read" : "is not there"), {}});
    }
}

// Nothing if it was read; else what is wrong.
std::string read_step(const fs::path& file, const Progress& progress, CadDocument& result) {
    STEPCAFControl_Reader reader;
    reader.SetColorMode(true), reader.SetNameMode(true), reader.SetLayerMode(true), reader.SetSHUOMode(true);
    reader.SetPropsMode(false), reader.SetGDTMode(false), reader.SetMatMode(false), reader.SetViewMode(false);
    if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) return "is not a STEP file, or is damaged: OpenCASCADE cannot read it";
    take_step_unit(reader.Reader(), result);
    progress(parsed, transferring);
    const Handle(Indicator) indicator = new Indicator(progress, parsed, transferred, transferring);
    if (!reader.Transfer(result.document, indicator->Start())) return "has no shape that OpenCASCADE can build";
    tell_missing_references(reader, file, result);
    return {};
}

void take_iges_unit(const IGESCAFControl_Reader& reader, CadDocument& result) {
    const auto model = Handle(IGESData_IGESModel)::DownCast(reader.Model());
    if (model.IsNull()) return;
    constexpr LengthUnit by_flag[] = {{"", "", 0},       {"", "in", 0.0254}, {"", "mm", 1e-3}, {"", "", 0},       {"", "ft", 0.3048},  {"", "mi", 1609.344},
                                      {"", "m", 1},      {"", "km", 1e3},    {"", "mil", 2.54e-5}, {"", "um", 1e-6}, {"", "cm", 1e-2}, {"", "uin", 2.54e-8}};
    const int flag = model->GlobalSection().UnitFlag();  // IGES 5.3, table 5
    if (flag >= 1 && flag < static_cast<int>(std::size(by_flag)) && by_flag[flag].metres > 0) {
        result.unit = by_flag[flag].shown, result.unit_metres = by_flag[flag].metres;
    }
}

std::string read_iges(const fs::path& file, const Progress& progress, CadDocument& result) {
    IGESCAFControl_Reader reader;
    reader.SetColorMode(true), reader.SetNameMode(true), reader.SetLayerMode(true);
    if (reader.ReadFile(file.c_str()) != IFSelect_RetDone) return "is not an IGES file, or is damaged: OpenCASCADE cannot read it";
    take_iges_unit(reader, result);
    progress(parsed, transferring);
    const Handle(Indicator) indicator = new Indicator(progress, parsed, transferred, transferring);
    return reader.Transfer(result.document, indicator->Start()) ? std::string{} : "has no shape that OpenCASCADE can build";
}

// A boundary representation as OpenCASCADE writes it itself, as text or bytes.
std::string read_brep(const fs::path& file, const Progress& progress, CadDocument& result) {
    std::ifstream stream(file, std::ios::binary);
    std::string head(64, '\0');
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    stream.clear(), stream.seekg(0);
    // OpenCASCADE does not look whether a number could be read, and goes on for as many as the file announced.
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    TopoDS_Shape shape;
    const Handle(Indicator) indicator = new Indicator(progress, 0, transferred, reading);
    const auto says = [&](const char* words) { return head.find(words) != std::string::npos; };
    if (says("Open CASCADE Topology")) BinTools::Read(shape, stream, indicator->Start());
    else if (says("CASCADE Topology") || says("DBRep_DrawableShape")) BRepTools::Read(shape, stream, BRep_Builder(), indicator->Start());
    if (shape.IsNull()) return "is not an OpenCASCADE BREP file, or is damaged";
    XCAFDoc_DocumentTool::ShapeTool(result.document->Main())->AddShape(shape, true);
    return {};
}

}  // namespace

Expected<CadDocument> read_document(const std::string& file, const std::string& shown_name, const Progress& progress) {
    CadDocument result;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", result.document);
    const std::string extension = lower(fs::path(file).extension().string());
    progress(0, reading);
    std::string wrong;
    try {
        if (extension == ".igs" || extension == ".iges") wrong = read_iges(file, progress, result);
        else if (extension == ".brep" || extension == ".brp" || extension == ".rle") wrong = read_brep(file, progress, result);
        else {
            auto references = references_of(file, shown_name);
            if (!references) return tl::unexpected<Error>(std::move(references.error()));
            result.referenced = std::move(*references);
            wrong = read_step(file, progress, result);
        }
    } catch (const Standard_Failure& failure) {
        wrong = std::string("is damaged: OpenCASCADE says '") + failure.GetMessageString() + "'";
    } catch (const std::ios_base::failure&) {
        wrong = "is damaged: it ends too soon, or has no number where one belongs";
    }
    if (!wrong.empty()) return failure(ErrorKind::input, {shown_name, {}, wrong, {}});
    for (Problem& warning : result.warnings) warning.file = shown_name;
    return result;
}

}  // namespace crescente::io::occt
