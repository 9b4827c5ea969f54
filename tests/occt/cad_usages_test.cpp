// Colours that a STEP file gives to a part in one place only (specified higher usage occurrences): written by OpenCASCADE, read back by us.
#include <array>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <utility>
#include <vector>

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

using Place = std::pair<int, int>;
using Color = std::array<float, 3>;
constexpr Color red{1, 0, 0}, green{0, 1, 0}, blue{0, 0, 1};

// A document of unit boxes, all the same part and blue.
class Boxes {
public:
    Boxes() {
        XCAFApp_Application::GetApplication()->NewDocument("BinXCAF", document_);
        shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
        colors_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
        box_ = shapes_->AddShape(BRepPrimAPI_MakeBox(1, 1, 1).Shape(), false);
        paint(box_, blue);
    }

    TDF_Label box() const { return box_; }
    TDF_Label assembly() { return shapes_->NewShape(); }
    TDF_Label add(const TDF_Label& to, const TDF_Label& what, double x, double y) { return shapes_->AddComponent(to, what, moved(x, y)); }

    // Says of the last of these components that it has this colour as it stands in the others, outermost first. After all components are there.
    void paint_in_place(const std::vector<TDF_Label>& components, const Color& color) {
        TDF_LabelSequence way;
        for (const TDF_Label& each : components) way.Append(each);
        Handle(XCAFDoc_GraphNode) usage;
        ASSERT_TRUE(shapes_->SetSHUO(way, usage));
        paint(usage->Label(), color);
    }

    // Written as STEP and read by us.
    Expected<CadModel> read_back() {
        shapes_->UpdateAssemblies();
        const fs::path file = fs::temp_directory_path() / ("crescente_usages_" + std::to_string(getpid()) + ".step");
        STEPCAFControl_Writer writer;
        writer.SetSHUOMode(true);
        EXPECT_TRUE(writer.Transfer(document_));
        EXPECT_EQ(writer.Write(file.c_str()), IFSelect_RetDone);
        ReadOptions options;
        options.cache = false;
        auto model = read_cad_model(file, options);
        fs::remove(file);
        return model;
    }

private:
    void paint(const TDF_Label& label, const Color& c) { colors_->SetColor(label, Quantity_Color(c[0], c[1], c[2], Quantity_TOC_RGB), XCAFDoc_ColorSurf); }

    Handle(TDocStd_Document) document_;
    Handle(XCAFDoc_ShapeTool) shapes_;
    Handle(XCAFDoc_ColorTool) colors_;
    TDF_Label box_;
};

// The colours of the boxes by where they stand.
std::map<Place, Color> colors_seen(const CadModel& model) {
    std::map<Place, Color> seen;
    const std::function<void(std::uint32_t, math::Affine)> visit = [&](std::uint32_t index, math::Affine above) {
        const CadNode& node = model.nodes[index];
        const math::Affine place = above * node.transform;
        for (const std::uint32_t child : node.children) visit(child, place);
        if (node.part >= model.parts.size()) return;
        ASSERT_EQ(node.colors.size(), 1u);
        ASSERT_LT(node.colors[0], model.colors.size());
        const math::Vec3 at = place.point({});
        const math::Rgb color = model.colors[node.colors[0]].rgb;
        seen[{static_cast<int>(std::lround(at.x)), static_cast<int>(std::lround(at.y))}] = {color.r, color.g, color.b};
    };
    for (const std::uint32_t root : model.roots) visit(root, {});
    return seen;
}

// Two pairs of boxes; of the first box of the second pair the document says in place that it is red.
TEST(CadUsages, AColourInOnePlaceIsThatPlacesAlone) {
    Boxes boxes;
    const TDF_Label pair = boxes.assembly(), all = boxes.assembly();
    const TDF_Label first = boxes.add(pair, boxes.box(), 0, 0);
    boxes.add(pair, boxes.box(), 2, 0);
    boxes.add(all, pair, 0, 0);
    const TDF_Label second = boxes.add(all, pair, 0, 5);
    boxes.paint_in_place({second, first}, red);
    const auto model = boxes.read_back();
    ASSERT_TRUE(model) << model.error().text();
    EXPECT_EQ(model->parts.size(), 1u);
    EXPECT_EQ(colors_seen(*model), (std::map<Place, Color>{{{0, 0}, blue}, {{2, 0}, blue}, {{0, 5}, red}, {{2, 5}, blue}}));
}

// Two rows of two pairs: one way begins within another, and where both say something of the same box the longer one counts.
TEST(CadUsages, TheLongestWayCounts) {
    Boxes boxes;
    const TDF_Label pair = boxes.assembly(), row = boxes.assembly(), all = boxes.assembly();
    const TDF_Label left = boxes.add(pair, boxes.box(), 0, 0), right = boxes.add(pair, boxes.box(), 2, 0);
    const TDF_Label near = boxes.add(row, pair, 0, 0);
    boxes.add(row, pair, 10, 0);
    const TDF_Label below = boxes.add(all, row, 0, 0);
    boxes.add(all, row, 0, 5);
    boxes.paint_in_place({below, near, left}, red);
    boxes.paint_in_place({near, left}, green);
    boxes.paint_in_place({near, right}, green);
    const auto model = boxes.read_back();
    ASSERT_TRUE(model) << model.error().text();
    EXPECT_EQ(colors_seen(*model), (std::map<Place, Color>{{{0, 0}, red}, {{2, 0}, green}, {{10, 0}, blue}, {{12, 0}, blue},
                                                           {{0, 5}, green}, {{2, 5}, green}, {{10, 5}, blue}, {{12, 5}, blue}}));
}

// 6 levels of 6 instances each are 46,656 boxes, but 36 nodes, beside a colour in one place as well as (once more) around one.
TEST(CadUsages, WhatIsTheSameElsewhereStaysShared) {
    constexpr int levels = 6, instances = 6;
    Boxes boxes;
    TDF_Label deep = boxes.box();
    std::vector<TDF_Label> way;  // to the last box of all
    int count = 1;
    for (int level = 0; level < levels; ++level, count *= instances) {
        const TDF_Label around = boxes.assembly();
        for (int i = 0; i < instances; ++i) {
            const TDF_Label instance = boxes.add(around, deep, 2 * count * i, 0);
            if (i + 1 == instances) way.insert(way.begin(), instance);
        }
        deep = around;
    }
    const TDF_Label pair = boxes.assembly(), all = boxes.assembly();
    const TDF_Label first = boxes.add(pair, boxes.box(), 0, 0);
    boxes.add(pair, boxes.box(), 2, 0);
    boxes.add(all, pair, 0, -5);
    const TDF_Label second = boxes.add(all, pair, 0, -10);
    boxes.add(all, deep, 0, 0);
    way.insert(way.begin(), boxes.add(all, deep, 0, 5));
    std::map<Place, Color> expected{{{0, -5}, blue}, {{2, -5}, blue}, {{0, -10}, red}, {{2, -10}, blue}};
    for (int i = 0; i < count; ++i) expected[{2 * i, 0}] = expected[{2 * i, 5}] = blue;

    boxes.paint_in_place({second, first}, red);
    const auto beside = boxes.read_back();
    ASSERT_TRUE(beside) << beside.error().text();
    EXPECT_EQ(beside->nodes.size(), 1u + 4u + 2u * 2u + levels * instances);
    EXPECT_EQ(colors_seen(*beside), expected);

    boxes.paint_in_place(way, green);
    expected[{2 * (count - 1), 5}] = green;
    const auto around = boxes.read_back();
    ASSERT_TRUE(around) << around.error().text();
    EXPECT_EQ(around->nodes.size(), 1u + 4u + 2u * 2u + 2u * levels * instances);  // the way down, and all beside it shared
    EXPECT_EQ(colors_seen(*around), expected);
}

}  // namespace
}  // namespace crescente::io
