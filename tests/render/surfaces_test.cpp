// No surface shades itself, and no ray slips through one: near and far, small and large, stretched and turned.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

struct Body {
    const char* name;
    geometry::Shape shape;
    bool convex;
};
std::vector<Body> bodies() {
    return {{"sphere", sphere(0.8), true},
            {"box", box({-0.5, -0.4, -0.6}, {0.5, 0.4, 0.6}), true},
            {"cylinder", geometry::Cylinder{}, true},
            {"cone", geometry::Cone{}, true},
            {"truncated cone", geometry::Cone{1, 0.4, 0.8, true}, true},
            {"torus", geometry::Torus{}, false},
            {"mesh", sphere_mesh(9, 14), true},
            {"smooth mesh", smooth_sphere_mesh(9, 14), true}};
}

struct Place {
    double offset, scale;
};
const Place places[] = {{0, 1}, {0, 1e-3}, {0, 1e3}, {1e3, 1}, {1e3, 1e-3}, {1e3, 1e3}, {1e6, 1}, {1e6, 1e-2}, {1e6, 1e3}};

// The body, turned and stretched, in the middle of the picture, with light along a direction.
Build scene_with(const Body& body, const Place& where, int pose, const ClassicMaterial& material, Vec3 shines) {
    Build s(40, 40);
    const Vec3 middle = Vec3{1, -0.7, 0.4} * where.offset;
    Random random(static_cast<std::uint64_t>(pose) + 11);
    const double size = where.scale;
    const Vec3 stretch = pose == 0 ? Vec3{1, 1, 1} : pose == 1 ? Vec3{0.4, 1.2, 0.9} : Vec3{1, 0.05, -1.1};
    const Affine turn = Affine::rotation(random.direction(), random.uniform(0, 6));
    s.camera().projection = scene::Projection::orthographic, s.camera().height = 3 * size;
    s.camera().position = middle + Vec3{0.3, 0.5, 4} * size, s.camera().target = middle;
    s.place(body.shape, s.material(material), at(middle) * turn * Affine::scaling(stretch * size));
    scene::Light& sun = s.light();
    sun.kind = scene::LightKind::directional, sun.direction = shines;
    return s;
}

std::string label(const Body& body, const Place& where, int pose) {
    return std::string(body.name) + ", offset " + std::to_string(where.offset) + ", scale " + std::to_string(where.scale) + ", pose " + std::to_string(pose);
}

void expect_no_shadow(Build s) {
    s.settings().level = scene::Level::visible;
    const scene::Image without = picture_of(s.scene);
    s.settings().level = scene::Level::shadows;
    const scene::Image with = picture_of(s.scene);
    int lit = 0, differing = 0;
    double worst = 0;
    for (std::size_t i = 0; i < with.layers[0].values.size(); i += 3) {
        const double a = without.layers[0].values[i], b = with.layers[0].values[i];
        lit += a > 0.1;
        differing += std::abs(a - b) > 2e-4;  // light that grazes to within that angle may count as behind
        worst = std::max(worst, std::abs(a - b));
    }
    EXPECT_GT(lit, 10);
    EXPECT_EQ(differing, 0) << "of " << lit << ", up to " << worst;
}

// Light from where the viewer is: whatever is seen is lit, on any body.
TEST(Surfaces, WhatTheLampSeesItLights) {
    for (const Body& body : bodies()) {
        for (const Place& where : places) {
            for (int pose = 0; pose < 3; ++pose) {
                SCOPED_TRACE(label(body, where, pose));
                expect_no_shadow(scene_with(body, where, pose, matte({1, 1, 1}), {-0.3, -0.5, -4}));
            }
        }
    }
}

// Light from anywhere: a convex body's side that faces it is lit.
TEST(Surfaces, ConvexBodiesDoNotShadeThemselves) {
    for (const Body& body : bodies()) {
        if (!body.convex || std::string(body.name) == "smooth mesh") continue;  // its normals face light that its flat faces do not
        for (const Place& where : places) {
            for (int pose = 0; pose < 3; ++pose) {
                SCOPED_TRACE(label(body, where, pose));
                expect_no_shadow(scene_with(body, where, pose, matte({1, 1, 1}), {-1, -0.8, -0.5}));
            }
        }
    }
}

// A ray through a clear convex body meets it twice, not more, not less: no surface is met again, none is skipped.
TEST(Surfaces, RaysCrossConvexBodiesTwice) {
    for (const Body& body : bodies()) {
        if (!body.convex) continue;
        for (const Place& where : places) {
            for (int pose = 0; pose < 3; ++pose) {
                SCOPED_TRACE(label(body, where, pose));
                Build s = scene_with(body, where, pose, glass({1, 1, 1}, 1), {0, 0, -1});
                s.scene.lights.clear();
                s.settings().depth = 1;
                const std::uint64_t hits = finished(s.scene).stats().rays.refracted;
                EXPECT_GT(hits, 30u);
                s.settings().depth = 9;
                EXPECT_EQ(finished(s.scene).stats().rays.refracted, 2 * hits);
            }
        }
    }
}

// A mirror that is convex sends no ray to itself.
TEST(Surfaces, ConvexMirrorsDoNotSeeThemselves) {
    for (const Body& body : bodies()) {
        if (!body.convex) continue;
        for (const Place& where : places) {
            for (int pose = 0; pose < 3; ++pose) {
                SCOPED_TRACE(label(body, where, pose));
                Build s = scene_with(body, where, pose, mirror({1, 1, 1}), {0, 0, -1});
                s.settings().depth = 1;
                const std::uint64_t hits = finished(s.scene).stats().rays.reflected;
                EXPECT_GT(hits, 30u);
                s.settings().depth = 9;
                EXPECT_EQ(finished(s.scene).stats().rays.reflected, hits);
            }
        }
    }
}

}  // namespace
}  // namespace crescente::render::testing
