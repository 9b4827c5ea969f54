// The language of edits: every verb, names of every kind, everything that can be wrong with them.
#include "io/edit_text.h"

#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "io/edit_reference.h"
#include "io/edit_script.h"
#include "io/scene_file.h"
#include "scene/material_library.h"
#include "scene/validate.h"

namespace crescente::io {
namespace {

using scene::Edit;
using scene::NodeId;
using scene::Scene;

constexpr const char* garage = R"({
  "unit": "cm",
  "camera": {"position": [0, 10, 50]},
  "lights": {"key": {"position": [0, 50, 0]}, "fill": {"position": [9, 9, 9]}, "v1.2": {"intensity": 2}},
  "materials": {
    "red": {"base_color": [1, 0, 0]}, "paint/matt.2": {"roughness": 1},
    "chrome": {"model": "classic", "reflection": 0.9}
  },
  "shapes": {"ball": {"sphere": {"radius": 3}}, "disk": {"disk": {}}},
  "groups": {"spare": {"shape": "disk"}, "pair": {"children": {"left": {"shape": "ball"}, "right": {"shape": "ball", "transform": {"translate": [9, 0, 0]}}}}},
  "objects": {
    "ground": {"shape": {"plane": {}}},
    "car": {"material": "red", "children": {
      "wheel": {"shape": "disk", "material": "chrome", "transform": {"translate": [10, 0, 0]}},
      "body": {"shape": {"box": {}}}}},
    "van": {"children": {"wheel": {"shape": "disk"}, "a/b.c": {"shape": "ball"}}},
    "front": {"instance": "pair"},
    "back": {"instance": "pair", "transform": {"translate": [0, 0, 20]}}
  }
})";

Scene scene_of(const char* text) {
    auto loaded = read_scene_text(text, "scene.json", "/no folder");
    EXPECT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(scene::validate(loaded->scene, "scene.json").size(), 0u);
    return std::move(loaded->scene);
}

class Edits : public testing::Test {
protected:
    Scene s = scene_of(garage);

    // Does the edit; returns what undoes it.
    std::vector<Edit> apply(const std::string& text) {
        auto edits = read_edit_text(text, s, "script");
        EXPECT_TRUE(edits) << text << "\n" << edits.error().text();
        if (!edits) return {};
        auto undo = scene::apply(std::move(*edits), s, "script");
        EXPECT_TRUE(undo) << text << "\n" << undo.error().text();
        return undo ? std::move(*undo) : std::vector<Edit>{};
    }
    std::string problems_of(const std::string& text) {
        const auto edits = read_edit_text(text, s, "f");
        if (edits) return "none";
        EXPECT_EQ(edits.error().kind, ErrorKind::input);
        return edits.error().text();
    }

    std::uint32_t node(const std::string& name, std::size_t which = 0) const {
        for (std::uint32_t i = 0; i < s.nodes.size(); ++i) {
            if (s.nodes[i].name == name && which-- == 0) return i;
        }
        ADD_FAILURE() << "no node " << name;
        return 0;
    }
    bool is_child(const std::string& parent, std::uint32_t child) const {
        const auto& children = s.nodes[node(parent)].children;
        return std::find(children.begin(), children.end(), NodeId{child}) != children.end();
    }
    bool is_root(std::uint32_t n) const { return std::find(s.roots.begin(), s.roots.end(), NodeId{n}) != s.roots.end(); }
    const scene::PhysicalMaterial& physical(std::size_t i) const { return std::get<scene::PhysicalMaterial>(s.materials[i].model); }
    math::Vec3 origin(std::uint32_t n) const { return s.nodes[n].transform.origin; }
};

TEST_F(Edits, MaterialsOfTheLibrary) {
    const auto library = [](const char* name) { return scene::find_in_library(name)->material; };
    const auto physical = [this](std::size_t i) { return std::get<scene::PhysicalMaterial>(s.materials.at(i).model); };
    const auto undo = apply(R"({"set": {"material.red.library": "gold satin", "material.red.roughness": 0.1}})");
    scene::PhysicalMaterial gold = library("gold satin");
    gold.roughness = 0.1;
    EXPECT_EQ(physical(0), gold);
    apply(R"({"material": {"name": "chrome", "library": "chromium polished"}})");
    EXPECT_EQ(physical(2), library("chromium polished"));
    apply(R"({"assign": {"object": "ground", "material": {"library": "porcelain"}}})");
    ASSERT_EQ(s.materials.size(), 4u);
    EXPECT_EQ(physical(3), library("porcelain"));
    apply(R"({"assign": {"object": "van", "material": {"library": "porcelain"}}})");
    EXPECT_EQ(s.materials.size(), 4u) << "it is there";
    EXPECT_NE(problems_of(R"({"set": {"material.red.library": "porcelaine"}})").find("did you mean 'porcelain'"), std::string::npos);
    EXPECT_NE(problems_of(R"({"assign": {"object": "van", "material": {"library": 1}}})").find("/assign/material/library"), std::string::npos);
}

TEST_F(Edits, SetValuesByPath) {
    apply(R"({"set": {"material.red.base_color": "#00ff00", "light.key.intensity": 3, "settings.threshold": 0.5, "camera.position": [100, 200, 300],
                      "environment.strength": 0.5, "shape.ball.radius": 5, "settings.level": "shadows"}})");
    EXPECT_EQ(physical(0).base_color, (math::Rgb{0, 1, 0}));
    EXPECT_EQ(s.lights[0].intensity, 3);
    EXPECT_EQ(s.settings.threshold, 0.5);
    EXPECT_EQ(s.settings.level, scene::Level::shadows);
    EXPECT_EQ(s.camera->position, (math::Vec3{1, 2, 3}));
    EXPECT_EQ(s.environment->strength, 0.5);
    EXPECT_EQ(std::get<geometry::Sphere>(s.shapes[0].shape).radius, 0.05);
    apply(R"({"set": {"material.paint/matt.2.roughness": 0.25, "material.\"red\".metallic": 1, "light.v1.2.color": 0.5}})");
    EXPECT_EQ(physical(1).roughness, 0.25);
    EXPECT_EQ(physical(0).metallic, 1);
    EXPECT_EQ(s.lights[2].color, math::gray(0.5f));
}

TEST_F(Edits, MoveReplacesOrFollows) {
    const std::uint32_t wheel = node("wheel");
    apply(R"({"move": {"object": "car/wheel", "by": {"translate": [5, 1, 0]}}})");
    EXPECT_EQ(origin(wheel), (math::Vec3{10 * 0.01 + 5 * 0.01, 0.01, 0}));
    EXPECT_EQ(origin(node("wheel", 1)), (math::Vec3{0, 0, 0}));
    apply(R"({"move": {"object": "car/wheel", "by": [{"rotate": {"axis": "z", "angle": 90}}, {"translate": [0, 0, 1]}]}})");
    EXPECT_NEAR(origin(wheel).x, -0.01, 1e-15);  // turned about the parent's origin
    EXPECT_NEAR(origin(wheel).y, 0.15, 1e-15);
    EXPECT_EQ(origin(wheel).z, 0.01);
    apply(R"({"move": {"object": ["wheel", "body"], "transform": {"translate": [1, 2, 3]}}})");  // all of the name
    for (const std::uint32_t n : {wheel, node("wheel", 1), node("body")}) EXPECT_EQ(s.nodes[n].transform, math::Affine::translation({0.01, 0.02, 0.03}));
}

TEST_F(Edits, MoveSetsTheMotion) {
    const scene::Node& wheel = s.nodes[node("wheel")];
    apply(R"({"move": {"object": "car/wheel", "motion": {"translate": [2, 0, 0]}}})");
    EXPECT_EQ(wheel.transform.origin.x, 0.1);
    EXPECT_EQ(wheel.motion, math::Affine::translation({0.02, 0, 0}));
    apply(R"({"move": {"object": "car/wheel", "by": {"translate": [5, 0, 0]}}})");
    EXPECT_EQ(wheel.motion, math::Affine::translation({0.02, 0, 0})) << "goes along";
    apply(R"({"move": {"object": "car/wheel", "transform": {"translate": [1, 0, 0]}, "motion": null}})");
    EXPECT_EQ(wheel.transform, math::Affine::translation({0.01, 0, 0}));
    EXPECT_FALSE(wheel.motion);
    EXPECT_NE(problems_of(R"({"move": {"object": "car/wheel", "motion": 3}})").find("/move/motion"), std::string::npos);
}

TEST_F(Edits, AnObjectThatIsNamedTwiceIsMovedOnce) {
    apply(R"({"move": {"object": ["body", "car/body"], "by": {"translate": [1, 0, 0]}}})");
    EXPECT_EQ(origin(node("body")).x, 0.01);
}

TEST_F(Edits, ShowAndHide) {
    apply(R"({"hide": "wheel"})");
    EXPECT_FALSE(s.nodes[node("wheel")].visible);
    EXPECT_FALSE(s.nodes[node("wheel", 1)].visible);
    apply(R"({"show": ["van/wheel", "ground"]})");
    EXPECT_FALSE(s.nodes[node("wheel")].visible);
    EXPECT_TRUE(s.nodes[node("wheel", 1)].visible);
    apply("{\"hide\": " + std::to_string(node("ground")) + "}");
    EXPECT_FALSE(s.nodes[node("ground")].visible);
    apply(R"({"hide": "van/a/b.c"})");  // a name with a slash, in a path
    EXPECT_FALSE(s.nodes[node("a/b.c")].visible);
    apply(R"({"show": "a/b.c"})");
    EXPECT_TRUE(s.nodes[node("a/b.c")].visible);
}

TEST_F(Edits, UnnamedThingsGoByTheirIndex) {
    s.nodes[node("body")].name.clear();
    const std::uint32_t body = [&] {
        std::uint32_t i = 0;
        while (!s.nodes[i].name.empty()) ++i;
        return i;
    }();
    apply("{\"hide\": \"car/" + std::to_string(body) + "\"}");
    EXPECT_FALSE(s.nodes[body].visible);
    s.materials[2].name.clear();
    apply(R"({"set": {"material.2.shininess": 7}})");
    EXPECT_EQ(std::get<scene::ClassicMaterial>(s.materials[2].model).shininess, 7);
    apply(R"({"assign": {"object": "ground", "material": 2}})");
    EXPECT_EQ(s.nodes[node("ground")].materials, std::vector<scene::MaterialId>{{2}});
}

TEST_F(Edits, AssignMaterials) {
    apply(R"({"assign": {"object": "van", "material": "red"}})");
    EXPECT_EQ(s.nodes[node("van")].materials, std::vector<scene::MaterialId>{{0}});
    apply(R"({"assign": {"object": "body", "materials": ["chrome", "paint/matt.2"]}})");
    EXPECT_EQ(s.nodes[node("body")].materials, (std::vector<scene::MaterialId>{{2}, {1}}));
    apply(R"({"assign": {"object": "car", "material": "paint/matt.2", "below": true}})");
    EXPECT_EQ(s.nodes[node("car")].materials, std::vector<scene::MaterialId>{{1}});
    EXPECT_TRUE(s.nodes[node("wheel")].materials.empty());
    EXPECT_TRUE(s.nodes[node("body")].materials.empty());
    apply(R"({"assign": {"object": "car", "materials": []}})");
    EXPECT_TRUE(s.nodes[node("car")].materials.empty());
}

TEST_F(Edits, WholeThingsAreSetOrAdded) {
    apply(R"({"material": {"name": "red", "model": "classic", "diffuse": 0.25}})");
    EXPECT_EQ(s.materials.size(), 3u);
    EXPECT_EQ(std::get<scene::ClassicMaterial>(s.materials[0].model).diffuse, math::gray(0.25f));
    apply(R"({"material": {"name": "new"}})");
    ASSERT_EQ(s.materials.size(), 4u);
    EXPECT_EQ(s.materials[3].name, "new");
    apply(R"({"light": {"name": "key", "intensity": 9}})");
    EXPECT_EQ(s.lights[0].intensity, 9);
    EXPECT_EQ(s.lights[0].position, (math::Vec3{0, 0, 0}));  // what is left out has its default
    apply(R"({"light": {"name": "rim", "position": [100, 0, 0]}})");
    ASSERT_EQ(s.lights.size(), 4u);
    EXPECT_EQ(s.lights[3].position.x, 1);
    apply(R"({"shape": {"name": "disk", "sphere": {"radius": 100}}})");
    EXPECT_EQ(std::get<geometry::Sphere>(s.shapes[1].shape).radius, 1);
    const std::size_t shapes = s.shapes.size();
    apply(R"({"shape": {"name": "slab", "box": {}}})");
    EXPECT_EQ(s.shapes.size(), shapes + 1);
    apply(R"({"camera": {"position": [0, 0, 300], "projection": "orthographic"}})");
    EXPECT_EQ(s.camera->position.z, 3);
    EXPECT_EQ(s.camera->projection, scene::Projection::orthographic);
    apply(R"({"environment": {"zenith": 1}})");
    EXPECT_EQ(s.environment->zenith, math::gray(1));
    apply(R"({"environment": null})");
    EXPECT_FALSE(s.environment);
}

TEST_F(Edits, LightsAreTakenAway) {
    apply(R"({"remove_light": "key"})");
    ASSERT_EQ(s.lights.size(), 2u);
    EXPECT_EQ(s.lights[0].name, "fill");
    apply(R"({"remove_light": 1})");
    ASSERT_EQ(s.lights.size(), 1u);
    EXPECT_EQ(s.lights[0].name, "fill");
}

TEST_F(Edits, ObjectsAreAdded) {
    const std::size_t nodes = s.nodes.size();
    apply(R"({"add": {"name": "bulb", "shape": {"sphere": {"radius": 10}}, "material": "red", "transform": {"translate": [0, 100, 0]}}})");
    const std::uint32_t bulb = node("bulb");
    EXPECT_TRUE(is_root(bulb));
    EXPECT_EQ(origin(bulb).y, 1);
    EXPECT_EQ(std::get<geometry::Sphere>(s.shapes[s.nodes[bulb].shape.value].shape).radius, 0.1);
    apply(R"({"add": {"name": "hub", "shape": "ball", "to": "car/wheel", "children": {"nut": {"shape": "ball"}, "bolt": {"shape": {"box": {}}, "visible": false}}}})");
    EXPECT_FALSE(is_root(node("hub")));
    EXPECT_TRUE(is_child("wheel", node("hub")));
    EXPECT_TRUE(is_child("hub", node("bolt")));
    EXPECT_EQ(s.nodes[node("nut")].shape, s.nodes[node("hub")].shape);
    EXPECT_EQ(s.nodes.size(), nodes + 4);
    apply(R"({"hide": "hub/nut"})");
    EXPECT_FALSE(s.nodes[node("nut")].visible);
    apply(R"({"add": {"name": "fifth", "instance": "spare"}})");  // a group that nothing showed
    EXPECT_TRUE(is_child("fifth", node("spare")));
    apply(R"({"add": {"name": "second car", "instance": "car", "transform": {"translate": [0, 0, 50]}}})");
    EXPECT_TRUE(is_child("second car", node("car")));
}

TEST_F(Edits, RemovedObjectsComeBackByUndo) {
    const std::uint32_t car = node("car");
    auto undo = apply(R"({"remove": "car"})");
    EXPECT_FALSE(is_root(car));
    EXPECT_NE(problems_of(R"({"hide": "car"})").find("there is no object 'car'"), std::string::npos);
    EXPECT_NE(problems_of("{\"hide\": " + std::to_string(car) + "}").find("there is no object"), std::string::npos);
    ASSERT_TRUE(scene::apply(std::move(undo), s));
    EXPECT_TRUE(is_root(car));
    apply(R"({"hide": "car"})");
    EXPECT_FALSE(s.nodes[car].visible);
}

TEST_F(Edits, RemovingByPathLeavesTheOtherPlaces) {
    const std::uint32_t pair = node("pair");
    EXPECT_TRUE(is_child("front", pair) && is_child("back", pair));
    apply(R"({"remove": "front/pair"})");
    EXPECT_FALSE(is_child("front", pair));
    EXPECT_TRUE(is_child("back", pair));
    apply(R"({"remove": ["wheel"]})");  // by name: everywhere
    EXPECT_FALSE(is_child("car", node("wheel")));
    EXPECT_FALSE(is_child("van", node("wheel", 1)));
}

TEST_F(Edits, Duplicates) {
    apply(R"({"duplicate": {"object": "car/wheel", "name": "wheel 2", "by": {"translate": [0, 0, 100]}}})");
    const std::uint32_t copy = node("wheel 2");
    EXPECT_TRUE(is_child("car", copy));
    EXPECT_EQ(origin(copy), (math::Vec3{0.1, 0, 1}));
    EXPECT_EQ(s.nodes[copy].shape, s.nodes[node("wheel")].shape);
    EXPECT_EQ(s.nodes[copy].materials, s.nodes[node("wheel")].materials);
    apply(R"({"duplicate": {"object": "car", "name": "car 2"}})");
    EXPECT_TRUE(is_root(node("car 2")));
    EXPECT_TRUE(is_child("car 2", node("wheel")));  // shared
}

TEST_F(Edits, ABatchIsOneEditWhosePartsSeeThoseBefore) {
    const Scene before = s;
    auto undo = apply(R"({"batch": [
        {"material": {"name": "gold"}}, {"set": {"material.gold.metallic": 1}},
        {"add": {"name": "stand", "children": {"top": {"shape": "disk"}}}}, {"assign": {"object": "stand/top", "material": "gold"}},
        {"duplicate": {"object": "stand/top", "name": "bottom"}}, {"move": {"object": "bottom", "by": {"translate": [0, -1, 0]}}},
        {"move": {"object": "bottom", "by": {"translate": [0, -1, 0]}}},
        {"remove_light": "key"}, {"light": {"name": "sun", "kind": "directional"}}, {"batch": [{"hide": "ground"}]}]})");
    EXPECT_EQ(physical(3).metallic, 1);
    EXPECT_EQ(s.nodes[node("top")].materials, std::vector<scene::MaterialId>{{3}});
    EXPECT_TRUE(is_child("stand", node("bottom")));
    EXPECT_EQ(origin(node("bottom")).y, -0.02);
    ASSERT_EQ(s.lights.size(), 3u);
    EXPECT_EQ(s.lights[0].name, "fill");
    EXPECT_EQ(s.lights[2].name, "sun");
    EXPECT_FALSE(s.nodes[node("ground")].visible);
    ASSERT_TRUE(scene::apply(std::move(undo), s));
    EXPECT_EQ(s.roots, before.roots);
    EXPECT_EQ(s.lights, before.lights);
    EXPECT_TRUE(s.nodes[node("ground")].visible);
}

TEST_F(Edits, OneThingThatIsWrongUndoesTheWhole) {
    const std::string problems = problems_of(R"({"batch": [{"hide": "ground"}, {"hide": "grund"}, {"set": {"material.red.roughnes": 1, "light.kye.intensity": 1}},
        {"move": {"object": "car"}}, {"shw": "car"}]})");
    for (const char* part : {"/batch/1/hide: there is no object 'grund' (did you mean 'ground'?)", "'roughnes' is no field of material (did you mean 'roughness'?)",
                             "there is no light 'kye' (did you mean 'key'?)", "/batch/3/move: 'transform' or 'by' is missing",
                             "/batch/4/shw: 'shw' is not known here (did you mean 'show'?)"}) {
        EXPECT_NE(problems.find(part), std::string::npos) << part << "\nin\n" << problems;
    }
}

TEST_F(Edits, BadInputOfEveryKind) {
    const std::vector<std::pair<std::string, std::string>> cases{
        {"", "f: line 1, column 1"},
        {"{", "line 1, column 2"},
        {"[]", "must be an object with one member"},
        {"{}", "an object of 0 members"},
        {R"({"show": "car", "hide": "car"})", "an object of 2 members"},
        {R"({"show": "car", "show": "car"})", "given twice"},
        {R"({"show": "cra"})", "did you mean 'car'?"},
        {R"({"show": "car/weel"})", "did you mean 'car/wheel'?"},
        {R"({"show": "cra/wheel"})", "there is no object 'cra/wheel'"},
        {R"({"show": true})", "must be an object's name, path or index"},
        {R"({"show": -1})", "there is no object -1"},
        {R"({"show": 99999999999})", "there is no object 99999999999"},
        {R"({"show": ["car", "cat"]})", "/show/1: there is no object 'cat'"},
        {R"({"show": "spare"})", "there is no object 'spare'"},  // nothing shows it
        {R"({"set": 3})", "must be an object of paths and values"},
        {R"({"set": {"red": 3}})", "/set/red: has no '.'"},
        {R"({"set": {"materials.red.ior": 3}})", "did you mean 'material'?"},
        {R"({"set": {"material.red.ior": "3"}})", "must be a number"},
        {R"({"set": {"material.red.roughness": 3}})", "is 3, must be from 0 to 1"},
        {R"({"set": {"material.red.shininess": 3}})", "is no field of material"},
        {R"({"set": {"material.roughness": 3}})", "which material is meant?"},
        {R"({"set": {"settings.a.depth": 3}})", "there is only one settings"},
        {R"({"set": {"camera.projection": "flat"}})", "is no choice for projection"},
        {R"({"move": "car"})", "must be an object"},
        {R"({"move": {"transform": []}})", "'object' is missing"},
        {R"({"move": {"object": "car", "transform": [], "by": []}})", "has both transform and by"},
        {R"({"move": {"object": "car", "by": {"turn": 3}}})", "/move/by/turn: 'turn' is not known here"},
        {R"({"move": {"object": "car", "buy": {}}})", "did you mean 'by'?"},
        {R"({"assign": {"object": "car"}})", "'material' or 'materials' is missing"},
        {R"({"assign": {"object": "car", "material": "rad"}})", "did you mean 'red'?"},
        {R"({"assign": {"object": "car", "materials": ["red", 17]}})", "there is no material 17"},
        {R"({"assign": {"object": "car", "materials": "red"}})", "must be a list"},
        {R"({"assign": {"object": "car", "material": "red", "below": 1}})", "must be true or false"},
        {R"({"material": {"base_color": 1}})", "'name' is missing"},
        {R"({"material": {"name": 4}})", "must be a text"},
        {R"({"material": {"name": "x", "model": "clasic"}})", "did you mean 'classic'?"},
        {R"({"material": "x"})", "must be an object"},
        {R"({"light": {"name": "x", "inensity": 1}})", "did you mean 'intensity'?"},
        {R"({"shape": {"name": "x"}})", "says no kind of shape"},
        {R"({"shape": {"name": "x", "sphere": {}, "box": {}}})", "one kind only"},
        {R"({"remove_light": "keys"})", "did you mean 'key'?"},
        {R"({"remove_light": 3})", "there is no light 3"},
        {R"({"remove_light": {}})", "must be the name or index of a light"},
        {R"({"add": "ball"})", "must be an object"},
        {R"({"add": {"shape": "bal"}})", "did you mean 'ball'?"},
        {R"({"add": {"shape": "ball", "to": "wheel"}})", "there are 2 such objects, one must be meant (by index: "},
        {R"({"add": {"file": "x.glb"}})", "an edit cannot bring a file"},
        {R"({"add": {"too": "car"}})", "did you mean 'to'?"},
        {R"({"add": {"instance": "carr"}})", "did you mean 'car'?"},
        {R"({"duplicate": {"object": "car"}})", "'name' is missing"},
        {R"({"duplicate": {"object": "wheel", "name": "w"}})", "there are 2 such objects"},
        {R"({"camera": {"positon": [0, 0, 0]}})", "did you mean 'position'?"},
        {R"({"environment": {"zenith": -1}})", "must be at least 0"},
        {R"({"batch": {}})", "must be a list of edits"},
        {R"({"batch": [3]})", "/batch/0: is a number"},
    };
    for (const auto& [text, part] : cases) EXPECT_NE(problems_of(text).find(part), std::string::npos) << text << "\nsays\n" << problems_of(text) << "not\n" << part;
}

TEST_F(Edits, WhatWouldBreakTheSceneIsRefusedWhole) {
    const std::size_t nodes = s.nodes.size();
    for (const char* text : {R"({"move": {"object": "car", "transform": {"scale": 0}}})", R"({"add": {"instance": "car", "to": "car"}})",
                             R"({"set": {"camera.target": [0, 10, 50]}})"}) {
        auto edits = read_edit_text(text, s, "f");
        ASSERT_TRUE(edits) << text << edits.error().text();
        EXPECT_FALSE(scene::apply(std::move(*edits), s, "f")) << text;
        EXPECT_EQ(s.nodes.size(), nodes);
        EXPECT_EQ(scene::validate(s, "f").size(), 0u);
    }
}

TEST_F(Edits, DeepNestingIsRefusedOrDone) {
    std::string deep, end;
    for (int i = 0; i < 200; ++i) deep += R"({"batch": [)", end += "]}";
    EXPECT_EQ(apply(deep + R"({"hide": "car"})" + end).size(), 1u);
    std::string children, close;
    for (int i = 0; i < 400; ++i) children += R"({"children": [)", close += "]}";
    EXPECT_NE(problems_of("{\"add\": " + children + close + "}"), "none");
}

TEST_F(Edits, EveryVerbIsUnderstood) {
    for (const Word& word : edit_words()) {
        EXPECT_NE(problems_of("{\"" + word.name + "\": 17.5}"), "none") << word.name;  // no verb takes that in silence
    }
}

// 2^40 places of shared groups: a path into them must not be followed through each.
TEST(EditNames, SharedGroupsAreWalkedOnce) {
    Scene s;
    for (std::uint32_t i = 0; i < 41; ++i) {
        scene::Node node;
        node.name = "a";
        if (i > 0) node.children = {{i - 1}, {i - 1}};
        s.nodes.push_back(std::move(node));
    }
    s.roots = {{40}};
    std::string path = "a";
    for (int i = 0; i < 40; ++i) path += "/a";
    const auto edits = read_edit_text("{\"hide\": \"" + path + "\"}", s, "f");
    ASSERT_TRUE(edits) << edits.error().text();
    ASSERT_EQ(edits->size(), 1u);
    EXPECT_EQ(std::get<scene::SetNode>(edits->front()).node.value, 0u);
    EXPECT_FALSE(read_edit_text("{\"hide\": \"" + path + "/a\"}", s, "f"));
}

TEST(EditScript, LinesOfEveryKind) {
    const auto lines = read_edit_script("// a comment\n\n{\"hide\": \"car\"}\r\n  {\"undo\": 2}\n{\"redo\": 1}\n{\"advance\": {\"seconds\": 0.5, \"level\": \"shadows\"}}\n"
                                        "{\"advance\": {}}\n{\"picture\": \"a.png\"}", "s.jsonl");
    ASSERT_TRUE(lines) << lines.error().text();
    ASSERT_EQ(lines->size(), 6u);
    EXPECT_EQ((*lines)[0].number, 3u);
    EXPECT_EQ((*lines)[0].text, "{\"hide\": \"car\"}");
    EXPECT_EQ(std::get<Json>((*lines)[0].step).find("hide")->line(), 3u);
    EXPECT_EQ(std::get<Undo>((*lines)[1].step).times, 2);
    EXPECT_EQ(std::get<Redo>((*lines)[2].step).times, 1);
    EXPECT_EQ(std::get<Advance>((*lines)[3].step).seconds, 0.5);
    EXPECT_EQ(std::get<Advance>((*lines)[3].step).level, scene::Level::shadows);
    EXPECT_FALSE(std::get<Advance>((*lines)[4].step).seconds);
    EXPECT_EQ(std::get<SavePicture>((*lines)[5].step).file, "a.png");
    EXPECT_TRUE(read_edit_script("", "s")->empty());
}

TEST(EditScript, EveryBadLineIsTold) {
    const auto lines = read_edit_script("{\"hide\": \"car\"}\n{\"hide\" \"car\"}\n{\"undo\": 0}\n{\"advance\": {\"second\": 1}}\n{\"advance\": {\"level\": \"shadow\"}}\n"
                                        "{\"advance\": {\"seconds\": -1}}\n{\"picture\": 3}\n{\"hid\": \"car\"}\n{\"udo\": 1}\n{\"redo\": \"all\"}\nhide\n", "s.jsonl");
    ASSERT_FALSE(lines);
    EXPECT_EQ(lines.error().kind, ErrorKind::input);
    const std::string text = lines.error().text();
    for (const char* part : {"s.jsonl: line 2, column 13: syntax error", "s.jsonl: line 3, /undo: must be a whole number", "line 4, /advance/second: 'second' is not known here (did you mean 'seconds'?)",
                             "line 5, /advance/level: 'shadow' is no choice for level (did you mean 'shadows'?)", "line 6, /advance/seconds: must be a number from 0 to 1e6",
                             "line 7, /picture: must be the path", "line 8, /hid: 'hid' is not known here (did you mean 'hide'?)",
                             "line 9, /udo: 'udo' is not known here (did you mean 'undo'?)", "line 10, /redo: must be", "line 11, column"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << "\nin\n" << text;
    }
}

TEST(EditReference, ItsExampleIsAScript) {
    const std::string page = edit_reference();
    const std::size_t begin = page.find("```json\n") + 8;
    const auto lines = read_edit_script(page.substr(begin, page.find("```", begin) - begin), "edits.md");
    ASSERT_TRUE(lines) << lines.error().text();
    EXPECT_GT(lines->size(), 10u);
}

TEST(EditReference, TheCommittedPageIsGenerated) {
    std::ifstream stream(CRESCENTE_ROOT "/docs/edits.md");
    std::stringstream text;
    text << stream.rdbuf();
    EXPECT_TRUE(text.str() == edit_reference()) << "run: crescente schema --edits > docs/edits.md";
}

}  // namespace
}  // namespace crescente::io
