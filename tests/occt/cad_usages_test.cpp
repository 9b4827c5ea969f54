// Colours that a STEP file gives to a part in one place only (specified higher usage occurrences): written by OpenCASCADE, read back by us.
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>

#include <gtest/gtest.h>
#include <unistd.h>

#include <BRepPrimAPI_MakeBox.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDocStd_Document.hxx>
#include <TopLoc_Location.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_GraphNode.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Trsf.hxx>

#include "io/cad_reader.h"

namespace crescente::io {
namespace {

namespace fs = std::filesystem;

TopLoc_Location moved(double x, double y) {
    gp_Trsf by;
    by.SetTranslation({x, y, 0});
    return by;
}

// Two pairs of boxes, all the same and blue; of the first box of the second pair the document says in place that it is red.
TEST(CadUsages, AColourInOnePlaceIsThatPlacesAlone) {
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document);
    const auto shapes = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    const auto colors = XCAFDoc_DocumentTool::ColorTool(document->Main());
    const TDF_Label box = shapes->AddShape(BRepPrimAPI_MakeBox(1, 1, 1).Shape(), false), pair = shapes->NewShape(), all = shapes->NewShape();
    const TDF_Label first = shapes->AddComponent(pair, box, moved(0, 0));
    shapes->AddComponent(pair, box, moved(2, 0));
    shapes->AddComponent(all, pair, moved(0, 0));
    const TDF_Label second = shapes->AddComponent(all, pair, moved(0, 5));
    shapes->UpdateAssemblies();
    colors->SetColor(box, Quantity_Color(0, 0, 1, Quantity_TOC_RGB), XCAFDoc_ColorSurf);
    TDF_LabelSequence way;
    way.Append(second), way.Append(first);
    Handle(XCAFDoc_GraphNode) usage;
    ASSERT_TRUE(shapes->SetSHUO(way, usage));
    colors->SetColor(usage->Label(), Quantity_Color(1, 0, 0, Quantity_TOC_RGB), XCAFDoc_ColorSurf);

    const fs::path file = fs::temp_directory_path() / ("crescente_usages_" + std::to_string(getpid()) + ".step");
    STEPCAFControl_Writer writer;
    writer.SetSHUOMode(true);
    ASSERT_TRUE(writer.Transfer(document));
    ASSERT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
    ReadOptions options;
    options.cache = false;
    const auto model = read_cad_model(file, options);
    fs::remove(file);
    ASSERT_TRUE(model) << model.error().text();

    EXPECT_EQ(model->parts.size(), 1u);
    std::map<std::pair<int, int>, std::array<float, 3>> seen;  // by where the boxes stand
    const std::function<void(std::uint32_t, math::Affine)> visit = [&](std::uint32_t index, math::Affine above) {
        const CadNode& node = model->nodes[index];
        const math::Affine place = above * node.transform;
        for (const std::uint32_t child : node.children) visit(child, place);
        if (node.part >= model->parts.size()) return;
        ASSERT_EQ(node.colors.size(), 1u);
        ASSERT_LT(node.colors[0], model->colors.size());
        const math::Vec3 at = place.point({});
        const math::Rgb color = model->colors[node.colors[0]].rgb;
        seen[{static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y))}] = {color.r, color.g, color.b};
    };
    for (const std::uint32_t root : model->roots) visit(root, {});
    const std::array<float, 3> red{1, 0, 0}, blue{0, 0, 1};
    ASSERT_EQ(seen.size(), 4u);
    EXPECT_EQ((seen[{0, 0}]), blue);
    EXPECT_EQ((seen[{2, 0}]), blue);
    EXPECT_EQ((seen[{0, 5}]), red);
    EXPECT_EQ((seen[{2, 5}]), blue);
}

}  // namespace
}  // namespace crescente::io
