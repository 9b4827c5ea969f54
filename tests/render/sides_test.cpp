// Surfaces with one side (glTF's doubleSided = false): no ray meets their back.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

PhysicalMaterial paint(Rgb emissive, bool double_sided) {
    PhysicalMaterial m;
    m.base_color = {0, 0, 0}, m.emissive = emissive, m.ior = 1, m.roughness = 1, m.double_sided = double_sided;
    return m;
}

// A sheet in the plane z = 0 whose front looks to +z, or to -z when turned round. Behind it, at z = -2, a wall that glows green.
Build sheet(const PhysicalMaterial& m, const Affine& place, double eye) {
    Build s(8, 8);
    s.camera().projection = scene::Projection::orthographic, s.camera().height = 1;
    s.camera().position = {0, 0, eye}, s.camera().target = {0, 0, eye - 1};
    s.place(grid_mesh(4, 0), s.material(m), place);
    s.place(box({-5, -5, -3}, {5, 5, -2}), s.material(glow({0, 1, 0})));
    return s;
}

Rgb middle(const scene::Scene& scene) { return pixel(picture_of(scene), 4, 3); }

TEST(Sides, TheBackIsNotSeen) {
    const Affine round = Affine::rotation({1, 0, 0}, pi), mirrored = Affine::scaling({-1, 1, 1}), through = Affine::scaling({1, 1, -1});
    for (const bool double_sided : {false, true}) {
        const PhysicalMaterial red = paint({1, 0, 0}, double_sided);
        const Rgb back = double_sided ? Rgb{1, 0, 0} : Rgb{0, 1, 0};
        EXPECT_EQ(middle(sheet(red, {}, 3).scene), (Rgb{1, 0, 0}));
        EXPECT_EQ(middle(sheet(red, round, 3).scene), back);
        // A mirrored body's outside stays outside: the winding follows the sign of the determinant (glTF 2.0, 3.7.4).
        EXPECT_EQ(middle(sheet(red, mirrored, 3).scene), (Rgb{1, 0, 0}));
        EXPECT_EQ(middle(sheet(red, through, 3).scene), back);
    }
}

TEST(Sides, TheBackThrowsNoShadowAndIsNotMirrored) {
    const Affine round = Affine::rotation({1, 0, 0}, pi);
    for (const bool double_sided : {false, true}) {
        for (const bool turned : {false, true}) {
            // Between sheet and wall, towards the wall; the sun shines from behind the camera.
            Build s = sheet(paint({1, 0, 0}, double_sided), turned ? round : Affine{}, -0.5);
            s.scene.materials[1] = {"", matte({0, 1, 0})};
            scene::Light& sun = s.light();
            sun.kind = scene::LightKind::directional, sun.direction = {0, 0, -1};
            EXPECT_EQ(middle(s.scene), turned && !double_sided ? (Rgb{0, 1, 0}) : Rgb{});
            s.scene.materials[1] = {"", mirror({1, 1, 1})};
            s.scene.lights.clear();
            s.uniform_environment({0, 0, 1}, 0);
            EXPECT_EQ(middle(s.scene), turned || double_sided ? (Rgb{1, 0, 0}) : (Rgb{0, 0, 1}));
        }
    }
}

TEST(Sides, EachMaterialOfAMeshHasItsOwn) {
    Build s = sheet(paint({1, 0, 0}, false), Affine::rotation({1, 0, 0}, pi), 3);
    auto& mesh = std::get<geometry::Mesh>(s.scene.shapes[0].shape);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) mesh.slots.push_back(mesh.positions[mesh.triangles[i][0]].x + mesh.positions[mesh.triangles[i][1]].x + mesh.positions[mesh.triangles[i][2]].x > 0);
    s.scene.nodes[0].materials.push_back(s.material(paint({0, 0, 1}, true)));
    const scene::Image picture = picture_of(s.scene);
    int through = 0, blue = 0;
    for (int x = 0; x < 8; ++x) through += pixel(picture, x, 3) == Rgb{0, 1, 0}, blue += pixel(picture, x, 3) == Rgb{0, 0, 1};
    EXPECT_GE(through, 3);  // a pixel between the two may show both
    EXPECT_GE(blue, 3);
    EXPECT_GE(through + blue, 7);
}

TEST(Sides, FromInsideABodyOneLooksOut) {
    for (const geometry::Shape& shape : {geometry::Shape{sphere(1)}, geometry::Shape{box({-1, -1, -1}, {1, 1, 1})}, geometry::Shape{sphere_mesh(8, 12)}, geometry::Shape{geometry::Torus{}}}) {
        Build s(8, 8);
        s.camera().position = {std::holds_alternative<geometry::Torus>(shape) ? 1.0 : 0.0, 0, 0}, s.camera().target = {1, 0, -1};
        s.uniform_environment({0, 0, 1}, 0);
        s.place(shape, s.material(paint({1, 0, 0}, false)));
        const scene::Image picture = picture_of(s.scene);
        int out = 0, front = 0;
        for (int i = 0; i < 64; ++i) out += pixel(picture, i % 8, i / 8) == Rgb{0, 0, 1}, front += pixel(picture, i % 8, i / 8).r > 0;
        EXPECT_GT(out, 0);
        EXPECT_TRUE(out == 64 || std::holds_alternative<geometry::Torus>(shape));  // through a torus its other side's front is seen
        EXPECT_EQ(out + front, 64);
    }
}

// Closed bodies that the camera is not in look the same, to the bit; so do those that let light in, which have both sides always.
TEST(Sides, ClosedBodiesLookTheSame) {
    for (const double transmission : {0.0, 1.0}) {
        scene::Scene scenes[2];
        for (const bool double_sided : {false, true}) {
            scene::Scene& scene = scenes[double_sided] = still_life();
            for (scene::Material& material : scene.materials) {
                if (const auto* m = std::get_if<ClassicMaterial>(&material.model); m && !is_black(m->transmission)) continue;
                PhysicalMaterial p;
                p.base_color = {0.7f, 0.5f, 0.4f}, p.roughness = 0.2, p.transmission = transmission, p.double_sided = double_sided;
                material.model = p;
            }
            scene.settings.depth = 4;
        }
        EXPECT_TRUE(same_picture(picture_of(scenes[0]), picture_of(scenes[1])));
    }
}

}  // namespace
}  // namespace crescente::render::testing
