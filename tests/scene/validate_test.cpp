#include "scene/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace crescente;
using namespace crescente::scene;

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

Scene good_scene() {
    Scene scene;
    scene.shapes.push_back({"ball", geometry::Sphere{}});
    scene.materials.push_back({"chrome", PhysicalMaterial{}});
    scene.nodes.push_back({"car", {}, ShapeId{0}, {MaterialId{0}}, {}, true});
    scene.roots.push_back(NodeId{0});
    scene.camera = Camera{};
    scene.environment = Environment{};
    scene.lights.push_back(Light{});
    return scene;
}

template <class Break>
Problems problems_after(Break&& change) {
    Scene scene = good_scene();
    change(scene);
    return validate(scene, "s.json");
}

// One change, one problem, at that place, with that in its reason.
#define EXPECT_PROBLEM(place_text, reason_part, ...)                                         \
    do {                                                                                     \
        const Problems found = problems_after([&](Scene& s) { __VA_ARGS__; });                 \
        ASSERT_EQ(found.size(), 1u) << (found.empty() ? "" : Error{ErrorKind::input, found}.text()); \
        EXPECT_EQ(found[0].place, place_text);                                               \
        EXPECT_EQ(found[0].file, "s.json");                                                  \
        EXPECT_NE(found[0].reason.find(reason_part), std::string::npos) << found[0].reason;  \
    } while (false)

geometry::Polygon square() { return {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}}; }
geometry::Mesh triangle() {
    geometry::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles = {{0, 1, 2}};
    return mesh;
}

}  // namespace

TEST(Validate, GoodScene) { EXPECT_TRUE(validate(good_scene(), "s.json").empty()); }

TEST(Validate, FieldRanges) {
    EXPECT_PROBLEM("/materials/chrome/roughness", "is 1.5, must be from 0 to 1", std::get<PhysicalMaterial>(s.materials[0].model).roughness = 1.5);
    EXPECT_PROBLEM("/materials/chrome/ior", "is 0, must be from 0.1", s.materials[0].model = ClassicMaterial{.ior = 0});
    EXPECT_PROBLEM("/materials/0/ior", "finite", (s.materials[0] = {"", ClassicMaterial{.ior = nan_value}}));
    EXPECT_PROBLEM("/lights/0/position", "component y", s.lights[0].position.y = nan_value);
    EXPECT_PROBLEM("/settings/width", "is 0 px", s.settings.width = 0);
    EXPECT_PROBLEM("/environment/zenith", "at least 0", s.environment->zenith.g = -1);
    // Told in the unit of the user.
    EXPECT_PROBLEM("/shapes/ball/sphere/radius", "is -2 mm, must be at least 0 mm",
                   (s.unit = {"mm", 0.001}, s.shapes[0].shape = geometry::Sphere{-0.002}));
}

TEST(Validate, Camera) {
    EXPECT_PROBLEM("/camera/target", "looks nowhere", s.camera->target = s.camera->position);
    EXPECT_PROBLEM("/camera/up", "parallel", (s.camera->up = {0, 0, -3}));
    EXPECT_PROBLEM("/camera/up", "no length", (s.camera->up = {0, 0, 0}));
    EXPECT_PROBLEM("/camera/field_of_view", "179", s.camera->field_of_view = 3.2);
}

TEST(Validate, LensAndShutter) {
    EXPECT_PROBLEM("/camera/aperture", "at least 0", s.camera->aperture = -1);
    EXPECT_PROBLEM("/camera/blades", "3 or more", s.camera->blades = 2);
    EXPECT_PROBLEM("/camera/blades", "64", s.camera->blades = 65);
    EXPECT_PROBLEM("/camera/shutter_close", "before it opens", (s.camera->shutter_open = 0.5, s.camera->shutter_close = 0.25));
    EXPECT_PROBLEM("/camera/travel", "looks nowhere", (s.camera->travel = (s.camera->target - s.camera->position) * 2));  // through the target, halfway
    EXPECT_PROBLEM("/camera/travel", "nothing is up then", (s.camera->target_travel = s.camera->position - s.camera->target + math::Vec3{0, 5, 0}));
    EXPECT_TRUE(problems_after([](Scene& s) { s.camera->travel = {1, 2, 3}, s.camera->target_travel = {1, 0, 0}, s.camera->roll = 1; }).empty());
}

TEST(Validate, Motion) {
    EXPECT_PROBLEM("/objects/car/motion", "finite", (s.nodes[0].motion = math::Affine::translation({nan_value, 0, 0})));
    EXPECT_PROBLEM("/objects/car/motion", "inverted", (s.nodes[0].motion = math::Affine::scaling({0, 1, 1})));
    EXPECT_PROBLEM("/objects/car/motion", "inside out", (s.nodes[0].motion = math::Affine::scaling({-1, 1, 1})));
    EXPECT_TRUE(problems_after([](Scene& s) { s.nodes[0].motion = math::Affine::rotation({0, 1, 0}, 1); }).empty());
}

TEST(Validate, Lights) {
    EXPECT_PROBLEM("/lights/0/direction", "points nowhere", (s.lights[0].kind = LightKind::directional, s.lights[0].direction = {}));
    EXPECT_PROBLEM("/lights/0/inner_angle", "60 deg, more than the outer angle of 30 deg",
                   (s.lights[0].inner_angle = math::pi / 3, s.lights[0].outer_angle = math::pi / 6));
    EXPECT_PROBLEM("/lights/0/constant", "all terms", (s.lights[0].falloff = Falloff::classic, s.lights[0].constant = 0));
    // A point light that shines all around needs no direction.
    EXPECT_TRUE(problems_after([](Scene& s) { s.lights[0].direction = {}; }).empty());
}

TEST(Validate, LightsWithExtent) {
    EXPECT_PROBLEM("/lights/0/width", "is 0", (s.lights[0].kind = LightKind::rectangle, s.lights[0].width = 0));
    EXPECT_PROBLEM("/lights/0/radius", "is 0", (s.lights[0].kind = LightKind::sphere, s.lights[0].radius = 0));
    EXPECT_PROBLEM("/lights/0", "too small", (s.lights[0].kind = LightKind::disk, s.lights[0].radius = 1e-200));
    EXPECT_PROBLEM("/lights/0", "too large", (s.lights[0].kind = LightKind::rectangle, s.lights[0].width = s.lights[0].height = 1e200));
    EXPECT_PROBLEM("/lights/0/up", "points nowhere", (s.lights[0].kind = LightKind::rectangle, s.lights[0].up = {}));
    EXPECT_PROBLEM("/lights/0/direction", "points nowhere", (s.lights[0].kind = LightKind::disk, s.lights[0].direction = {}));
    EXPECT_PROBLEM("/lights/0/outer_angle", "without extent", (s.lights[0].kind = LightKind::disk, s.lights[0].outer_angle = 1));
    EXPECT_PROBLEM("/lights/0/falloff", "without extent", (s.lights[0].kind = LightKind::sphere, s.lights[0].falloff = Falloff::none));
    EXPECT_PROBLEM("/lights/0/range", "without extent", (s.lights[0].kind = LightKind::sphere, s.lights[0].range = 2));
    EXPECT_TRUE(problems_after([](Scene& s) { s.lights[0].kind = LightKind::sphere, s.lights[0].direction = s.lights[0].up = {}; }).empty());
    EXPECT_PROBLEM("/environment/image", "not read", (s.environment.emplace().image = "sky.hdr"));
}

TEST(Light, UpwardIsPerpendicularWhateverItIs) {
    Light light;
    light.direction = {0, -2, 0};
    EXPECT_EQ(upward_of(light), (math::Vec3{0, 0, -1})) << "up is along the axis";
    light.direction = {0, 0, 3}, light.up = {0, 0, -1};
    EXPECT_EQ(upward_of(light), (math::Vec3{0, 1, 0}));
    light.direction = {1, 0, 0}, light.up = {5, 0, 2};
    EXPECT_EQ(upward_of(light), (math::Vec3{0, 0, 1}));
}

TEST(Validate, PictureSize) { EXPECT_PROBLEM("/settings", "larger than", s.settings.width = s.settings.height = 65536); }

TEST(Validate, SolidShapes) {
    EXPECT_PROBLEM("/shapes/ball/sphere/radius", "is 0", s.shapes[0].shape = geometry::Sphere{0});
    EXPECT_PROBLEM("/shapes/ball/box", "in y", (s.shapes[0].shape = geometry::Box{{0, 1, 0}, {1, 0, 1}}));
    EXPECT_PROBLEM("/shapes/ball/cone/base_radius", "both", (s.shapes[0].shape = geometry::Cone{0, 0, 1}));
    EXPECT_PROBLEM("/shapes/ball/cylinder/height", "is 0", (s.shapes[0].shape = geometry::Cylinder{1, 0}));
    EXPECT_PROBLEM("/shapes/ball/torus/minor_radius", "is 0", (s.shapes[0].shape = geometry::Torus{1, 0}));
    EXPECT_PROBLEM("/shapes/ball/disk/inner_radius", "not smaller", (s.shapes[0].shape = geometry::Disk{1, 1}));
}

TEST(Validate, Polygons) {
    const auto with = [](auto change) {
        geometry::Polygon p = square();
        change(p.loops);
        return p;
    };
    EXPECT_TRUE(problems_after([&](Scene& s) { s.shapes[0].shape = square(); }).empty());
    EXPECT_PROBLEM("/shapes/ball/polygon/loops", "at least one", s.shapes[0].shape = geometry::Polygon{});
    EXPECT_PROBLEM("/shapes/ball/polygon/loops/0", "has 2 points", s.shapes[0].shape = with([](auto& l) { l[0].resize(2); }));
    EXPECT_PROBLEM("/shapes/ball/polygon/loops", "one plane", s.shapes[0].shape = with([](auto& l) { l[0][1].z = 1e-4; }));
    EXPECT_PROBLEM("/shapes/ball/polygon/loops/0", "no area", s.shapes[0].shape = with([](auto& l) { l[0][2] = {2, 0, 0}, l[0][3] = {3, 0, 0}; }));
    EXPECT_PROBLEM("/shapes/ball/polygon/loops/0/2", "finite", s.shapes[0].shape = with([](auto& l) { l[0][2].x = nan_value; }));
    // Far away and flat enough for its size.
    EXPECT_TRUE(problems_after([&](Scene& s) {
        s.shapes[0].shape = with([](auto& l) { for (auto& p : l[0]) p += {1e6, 1e6, 1e6}; });
    }).empty());
}

TEST(Validate, Meshes) {
    const auto with = [](auto change) {
        geometry::Mesh m = triangle();
        change(m);
        return m;
    };
    EXPECT_TRUE(problems_after([&](Scene& s) { s.shapes[0].shape = triangle(); }).empty());
    EXPECT_PROBLEM("/shapes/ball/mesh/triangles", "at least one", s.shapes[0].shape = geometry::Mesh{});
    EXPECT_PROBLEM("/shapes/ball/mesh/triangles/0", "beyond the 3", s.shapes[0].shape = with([](auto& m) { m.triangles[0][1] = 3; }));
    EXPECT_PROBLEM("/shapes/ball/mesh/positions/1", "1 more", s.shapes[0].shape = with([](auto& m) { m.positions[1].x = m.positions[2].y = nan_value; }));
    EXPECT_PROBLEM("/shapes/ball/mesh/normals", "2 normals", s.shapes[0].shape = with([](auto& m) { m.normals.resize(2); }));
    EXPECT_PROBLEM("/shapes/ball/mesh/slots", "2 slots", s.shapes[0].shape = with([](auto& m) { m.slots.resize(2); }));
}

TEST(Validate, Indices) {
    EXPECT_PROBLEM("/objects/car/shape", "no shape 7", s.nodes[0].shape = ShapeId{7});
    EXPECT_PROBLEM("/objects/car/materials", "no material 3", s.nodes[0].materials[0] = MaterialId{3});
    EXPECT_PROBLEM("/objects/car/materials", "missing", s.nodes[0].materials[0] = MaterialId{});
    EXPECT_PROBLEM("/objects/car/children", "no node 5", s.nodes[0].children.push_back(NodeId{5}));
    EXPECT_PROBLEM("/objects/1", "no node 9", s.roots.push_back(NodeId{9}));
}

TEST(Validate, Transforms) {
    EXPECT_PROBLEM("/objects/car/transform", "inverted", (s.nodes[0].transform = math::Affine::scaling({1, 0, 1})));
    EXPECT_PROBLEM("/objects/car/transform", "inverted", (s.nodes[0].transform.y = s.nodes[0].transform.x));
    EXPECT_PROBLEM("/objects/car/transform", "finite", s.nodes[0].transform.origin.x = nan_value);
    // Small and large, mirrored and stretched are no reason to complain.
    for (const math::Vec3 scale : {math::Vec3{1e-9, 1e-9, 1e-9}, {1e9, 1e9, 1e9}, {-1, 1, 1}, {1e-3, 1e3, 1}}) {
        EXPECT_TRUE(problems_after([&](Scene& s) { s.nodes[0].transform = math::Affine::scaling(scale); }).empty());
    }
}

TEST(Validate, CycleIsNamed) {
    EXPECT_PROBLEM("/objects", "'wheel' -> 'spoke' -> 'wheel'", (s.nodes.push_back({"wheel", {}, {}, {}, {NodeId{2}}, true}),
                                                                  s.nodes.push_back({"spoke", {}, {}, {}, {NodeId{1}}, true}),
                                                                  s.nodes[0].children.push_back(NodeId{1})));
    EXPECT_PROBLEM("/objects", "'car' -> 'car'", s.nodes[0].children.push_back(NodeId{0}));
}

TEST(Validate, PlaceIsThePathFromTheRoot) {
    EXPECT_PROBLEM("/objects/car/children/a~1b/transform", "inverted",
                   (s.nodes.push_back({"a/b", math::Affine::scaling({0, 0, 0}), {}, {}, {}, true}), s.nodes[0].children.push_back(NodeId{1})));
}

TEST(Validate, NothingToSee) {
    EXPECT_PROBLEM("/objects", "nothing", s.nodes[0].visible = false);
    EXPECT_PROBLEM("/objects", "nothing", s.roots.clear());
    EXPECT_PROBLEM("/objects", "nothing", s.nodes[0].shape = ShapeId{});
}

// 60 nodes that each show the next twice: 2^60 appearances in a file of a few lines.
TEST(Validate, ExplodingInstances) {
    EXPECT_PROBLEM("/objects", "that can be held", {
        for (std::uint32_t i = 1; i < 60; ++i) {
            s.nodes.push_back({"", {}, {}, {}, {}, true});
            s.nodes[i - 1].children = {NodeId{i}, NodeId{i}};
        }
        s.nodes.back().shape = ShapeId{0};
        s.nodes[0].shape = ShapeId{};
    });
}

// The same without a shape at the end: nothing is seen of them, but walking through them would take forever.
TEST(Validate, ExplodingEmptyGroups) {
    EXPECT_PROBLEM("/objects", "that can be walked through", {
        for (std::uint32_t i = 1; i < 60; ++i) {
            s.nodes.push_back({"", {}, {}, {}, {}, true});
            s.nodes[i - 1].children = {NodeId{i}, NodeId{i}};
        }
    });
}

TEST(Validate, DeepHierarchy) {
    Scene scene = good_scene();
    constexpr std::uint32_t depth = 1000000;
    scene.nodes.resize(depth);
    for (std::uint32_t i = 0; i + 1 < depth; ++i) scene.nodes[i].children = {NodeId{i + 1}};
    scene.nodes[0].shape = ShapeId{};
    scene.nodes.back().shape = ShapeId{0};
    EXPECT_TRUE(validate(scene, "s").empty());
    scene.nodes.back().transform = math::Affine::scaling({0, 0, 0});
    const Problems problems = validate(scene, "s");
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_TRUE(problems[0].place.starts_with("/objects/.../children/")) << problems[0].place;
}

TEST(Validate, AllProblemsAtOnce) {
    const Problems problems = problems_after([](Scene& s) {
        s.settings.width = -1;
        s.camera->up = {};
        s.lights[0].intensity = -1;
        s.shapes[0].shape = geometry::Sphere{-1};
        s.nodes[0].transform = math::Affine::scaling({0, 1, 1});
    });
    EXPECT_EQ(problems.size(), 5u);
}
