// Spline shapes in native scenes.
#include <gtest/gtest.h>

#include "io/scene_file.h"
#include "scene/validate.h"

using namespace crescente;

namespace {

scene::Scene read(const std::string& text) {
    auto loaded = io::read_scene_text(text, "s.json", ".");
    EXPECT_TRUE(loaded) << loaded.error().text();
    return loaded ? std::move(loaded->scene) : scene::Scene{};
}

std::string errors(const std::string& text) {
    const auto loaded = io::read_scene_text(text, "s.json", ".");
    if (!loaded) return loaded.error().text();
    std::string all;
    for (const Problem& problem : scene::validate(loaded->scene, "s.json")) all += problem.text() + "\n";
    return all;
}

constexpr const char* every_kind = R"({"unit": "mm", "shapes": {
    "patch": {"bicubic": {"basis": "b_spline",
        "patches": [[[0,0,0],[0,1,0],[0,2,0],[0,3,0], [1,0,1],[1,1,1],[1,2,1],[1,3,1], [2,0,1],[2,1,1],[2,2,1],[2,3,1], [3,0,0],[3,1,0],[3,2,0],[3,3,0]]],
        "weights": [[1,1,1,1, 1,2,2,1, 1,2,2,1, 1,1,1,1]]}},
    "cylinder": {"nurbs": {"degree_u": 2, "degree_v": 1, "points": [[[1,0,0],[1,5,0]], [[1,0,1],[1,5,1]], [[0,0,1],[0,5,1]]],
        "weights": [[1,1],[0.7,0.7],[1,1]], "knots_u": [0,0,0,1,1,1], "knots_v": [0,0,1,1]}},
    "vase": {"revolution": {"profile": [{"kind": "polyline", "points": [[10,0,0],[12,5,0]]}, {"kind": "arc", "points": [[12,5,0],[14,8,0],[12,11,0]]}],
        "sweep": 180, "pitch": 4, "twist": 30, "pivot": [11,5,0], "directrix": [1, 0.9, 1]}},
    "wall": {"extrusion": {"profile": {"kind": "nurbs", "degree": 2, "points": [[0,0,0],[1,0,0],[2,1,0]], "knots": [0,0,0,1,1,1]}, "direction": [0,0,9]}},
    "sheet": {"ruled": {"from": {"kind": "bezier", "points": [[0,0,0],[1,1,0],[2,0,0]]}, "to": {"kind": "b_spline", "closed": true, "points": [[0,0,3],[1,0,3],[1,1,3],[0,1,3]]}}}},
  "objects": [{"shape": "patch"}, {"shape": "cylinder"}, {"shape": "vase"}, {"shape": "wall"}, {"shape": "sheet"}]})";

}  // namespace

TEST(SplineScene, EveryKindIsRead) {
    scene::Scene s = read(every_kind);
    EXPECT_TRUE(scene::validate(s, "s.json").empty());
    for (auto& shape : s.shapes) {
        EXPECT_EQ(geometry::parts(shape.shape), 0u);
        geometry::prepare(shape.shape);
        EXPECT_GT(geometry::parts(shape.shape), 0u) << shape.name;
        EXPECT_TRUE(geometry::bounds(shape.shape).bounded());
    }
    const auto& vase = std::get<geometry::Revolution>(s.shapes.at(2).shape);
    EXPECT_EQ(vase.profile.size(), 2u);
    EXPECT_DOUBLE_EQ(vase.profile[1].points[1].x, 0.014);
    EXPECT_DOUBLE_EQ(vase.pitch, 0.004);
    EXPECT_DOUBLE_EQ(vase.sweep, math::pi);
    EXPECT_EQ(vase.directrix, (std::vector<double>{1, 0.9, 1}));
    const auto& nurbs = std::get<geometry::Nurbs>(s.shapes.at(1).shape);
    EXPECT_EQ(nurbs.weights[1][0], 0.7);  // without a unit
}

TEST(SplineScene, WritesWhatItReads) {
    const std::string text = io::write_scene_text(read(every_kind));
    EXPECT_EQ(io::write_scene_text(read(text)), text);
    const scene::Scene first = read(every_kind), second = read(text);
    for (std::size_t i = 0; i < first.shapes.size(); ++i) {
        std::visit([&](const auto& a) {
            using Kind = std::remove_cvref_t<decltype(a)>;
            if constexpr (requires { a.patches(); }) {
                const auto p = a.patches(), q = std::get<Kind>(second.shapes[i].shape).patches();
                ASSERT_TRUE(p && q);
                EXPECT_EQ(*p, *q) << first.shapes[i].name;
            }
        }, first.shapes[i].shape);
    }
}

TEST(SplineScene, WhatIsWrongIsTold) {
    const auto shape = [](const std::string& text) { return errors(R"({"shapes": {"s": )" + text + R"(}, "objects": [{"shape": "s"}]})"); };
    EXPECT_NE(shape(R"({"bicubic": {"patches": [[[0,0,0]]]}})").find("/shapes/s/bicubic/patches/0: has 1 elements, must have 16"), std::string::npos);
    EXPECT_NE(shape(R"({"bicubic": {}})").find("patches is missing"), std::string::npos);
    EXPECT_NE(shape(R"({"bicubic": {"basis": "bezzier", "patches": []}})").find("bezier"), std::string::npos);
    EXPECT_NE(shape(R"({"nurbs": {"points": [[[0,0,0],[1,0,0]],[[0,1,0],[1,1,0]]], "degree_u": 1, "degree_v": 1, "knots_u": [0,0,1], "knots_v": [0,0,1,1]}})")
                  .find("/shapes/s/nurbs/knots_u: there are 3 knots, must be 4"), std::string::npos);
    EXPECT_NE(shape(R"({"extrusion": {"profile": {"kind": "polyline", "pointz": [[0,0,0],[1,0,0]]}}})").find("points"), std::string::npos);
    EXPECT_NE(shape(R"({"extrusion": {"profile": {"points": [[0,0,0]]}}})").find("too few points"), std::string::npos);
    EXPECT_NE(shape(R"({"revolution": {"profile": {"points": [[1,0,0],[1,1,0]]}, "sweep": 0}})").find("sweep"), std::string::npos);
}
