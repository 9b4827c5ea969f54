#include "io/occt/colors.h"

#include <algorithm>

#include <Quantity_ColorRGBA.hxx>
#include <TDF_LabelSequence.hxx>
#include <TopoDS_Iterator.hxx>
#include <XCAFDoc_DocumentTool.hxx>

namespace crescente::io::occt {
namespace {

// Hands colours down: to each face the nearest above it. Shapes that carry none of their own below are not entered twice.
class Painter {
public:
    Painter(const TopTools_DataMapOfShapeInteger& own, const TopTools_IndexedMapOfShape& faces, std::vector<std::uint32_t>& result)
        : own_(own), faces_(faces), result_(result) {}

    void paint(const TopoDS_Shape& shape, std::uint32_t color) {
        if (const int* own = own_.Seek(shape)) color = static_cast<std::uint32_t>(*own);
        if (shape.ShapeType() == TopAbs_FACE) {
            if (const int index = faces_.FindIndex(shape); index > 0 && color != Colors::none) result_[static_cast<std::size_t>(index - 1)] = color;
            return;
        }
        for (TopoDS_Iterator below(shape); below.More(); below.Next()) {
            if (below.Value().ShapeType() <= TopAbs_FACE) paint(below.Value(), color);
        }
    }

private:
    const TopTools_DataMapOfShapeInteger& own_;
    const TopTools_IndexedMapOfShape& faces_;
    std::vector<std::uint32_t>& result_;
};

}  // namespace

Colors::Colors(const TDF_Label& main, std::vector<CadColor>& table)
    : tool_(XCAFDoc_DocumentTool::ColorTool(main)), shapes_(XCAFDoc_DocumentTool::ShapeTool(main)), table_(table) {}

std::uint32_t Colors::index_of(const CadColor& color) {
    const auto found = std::find(table_.begin(), table_.end(), color);
    if (found != table_.end()) return static_cast<std::uint32_t>(found - table_.begin());
    table_.push_back(color);
    return static_cast<std::uint32_t>(table_.size() - 1);
}

std::uint32_t Colors::of(const TDF_Label& label) {
    Quantity_ColorRGBA color;
    if (!tool_->GetColor(label, XCAFDoc_ColorSurf, color) && !tool_->GetColor(label, XCAFDoc_ColorGen, color)) return none;
    const Quantity_Color& rgb = color.GetRGB();  // linear since OpenCASCADE 7.5
    return index_of({{static_cast<float>(rgb.Red()), static_cast<float>(rgb.Green()), static_cast<float>(rgb.Blue())}, color.Alpha()});
}

std::vector<std::uint32_t> Colors::of_faces(const TDF_Label& part, const TopoDS_Shape& shape, const TopTools_IndexedMapOfShape& faces) {
    std::vector<std::uint32_t> result(static_cast<std::size_t>(faces.Extent()), none);
    TDF_LabelSequence inside;
    shapes_->GetSubShapes(part, inside);
    TopTools_DataMapOfShapeInteger own;
    for (TDF_LabelSequence::Iterator each(inside); each.More(); each.Next()) {
        const std::uint32_t color = of(each.Value());
        if (color == none) continue;
        own.Bind(XCAFDoc_ShapeTool::GetShape(each.Value()), static_cast<int>(color));
    }
    if (!own.IsEmpty()) Painter(own, faces, result).paint(shape, none);
    return result;
}

}  // namespace crescente::io::occt
