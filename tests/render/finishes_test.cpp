// Finishes that are not the same all over: grain, flakes, coats with normals of their own, cloth, light that glass spreads by its colour; and the library's textures.
#include "geometry/mesh_tangents.h"
#include "render/grain.h"
#include "render/scatter.h"
#include "render/scenes.h"
#include "render/texture_procedures.h"
#include "render/textured_material.h"
#include "scene/material_library.h"

namespace crescente::render::testing {
namespace {

using scene::Grain;
using scene::Texture;
using scene::TextureKind;
using scene::TextureProjection;

// A point of a ball of radius 1 m, seen from outside, straight on.
struct OnBall {
    geometry::Shape shape = sphere(1);
    accel::Instance instance{shape, Affine{}, true};
    Bounds bounds = geometry::bounds(shape);
    TexturePoint at(Vec3 direction, double width = 1e-6) const {
        const Vec3 n = normalize(direction);
        return {&instance, &bounds, 0, n, n, normalize(n + perpendicular(n) * 0.3), width, false};
    }
};

Texture flakes(double size, double slopes) {
    Texture t;
    t.kind = TextureKind::flakes, t.projection = TextureProjection::solid, t.size = size, t.strength = slopes;
    return t;
}

TEST(Finishes, GrainRunsAlongOrAboutItsAxis) {
    const OnBall ball;
    PhysicalMaterial m;
    m.anisotropy = 0.5, m.grain_axis = {0, 0, 3};
    for (const Vec3 n : {Vec3{1, 0, 0}, Vec3{1, 2, 0.3}, Vec3{-1, 0.2, -0.4}}) {
        const TexturePoint point = ball.at(n);
        const Vec3 along = normalize(grain_direction(m, {}, point));
        EXPECT_NEAR(dot(along, point.geometric), 0, 1e-9);
        EXPECT_NEAR(dot(along, normalize(cross(point.geometric, Vec3{0, 0, 1}))), 0, 1e-9);
        PhysicalMaterial turned = m;
        turned.grain = Grain::around;
        const Vec3 about = normalize(grain_direction(turned, {}, point));
        EXPECT_NEAR(about.z, 0, 1e-9);
        EXPECT_NEAR(dot(about, along), 0, 1e-9);
        turned.anisotropy_rotation = pi / 2;
        EXPECT_NEAR(std::abs(dot(normalize(grain_direction(turned, {}, point)), along)), 1, 1e-9) << "turned by a right angle";
    }
    EXPECT_GT(length(grain_direction(m, {}, ball.at({0, 0, 1}))), 0.5) << "where the axis stands upright, another";
    m.grain = Grain::surface;  // (u, v) of a sphere: u goes around
    EXPECT_GT(length(grain_direction(m, {}, ball.at({1, 0.3, 0.2}))), 0.5);
}

// Two triangles with their coordinates turned by 30 degrees: tangents point where u grows. Mirrored ones do not share them.
TEST(Finishes, MeshesGetTangents) {
    const double c = std::cos(0.5), s = std::sin(0.5);
    geometry::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
    mesh.normals.assign(4, {0, 0, 1});
    for (const Vec3& p : mesh.positions) mesh.coordinates[0].push_back({static_cast<float>(c * p.x + s * p.y), static_cast<float>(-(c * p.y - s * p.x))});
    geometry::Mesh other = mesh;
    geometry::add_tangents(mesh);
    ASSERT_EQ(mesh.tangents.size(), 4u);
    for (const auto& t : mesh.tangents) {
        EXPECT_NEAR(t[0], c, 1e-6);
        EXPECT_NEAR(t[1], s, 1e-6);
        EXPECT_EQ(t[3], 1);
    }
    other.coordinates[0] = {{0, 0}, {1, 0}, {0, -1}, {0, 0}};  // the second triangle mirrors the first about its long side
    geometry::add_tangents(other);
    EXPECT_EQ(other.positions.size(), 7u) << "two are doubled, and one is there so that normals are not as many as corners";
    EXPECT_EQ(other.normals.size(), other.positions.size());
    EXPECT_EQ(other.tangents[other.triangles[0][1]][3], 1);
    EXPECT_EQ(other.tangents[other.triangles[1][1]][3], -1);
    EXPECT_EQ(other.positions[other.triangles[1][1]], (Vec3{1, 0, 0}));
}

// What the slopes of flakes lose of their variance when they are seen together, the roughness gains.
TEST(Finishes, FlakesSeenTogetherAreARougherSurface) {
    const Texture t = flakes(1e-3, 0.2);
    for (const double width : {0.0, 0.7, 0.9, 3.0}) {
        TexturePlace p;
        p.axes[0] = {width, 0, 0}, p.axes[1] = {0, width, 0};
        Random random(5);
        double sum = 0;
        Vec3 mean;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) {
            p.at = random.in_cube(1000);
            const Vec3 slope = flake_slope(t, p);
            sum += (slope.x * slope.x + slope.y * slope.y + slope.z * slope.z) / 3, mean += slope / n;
        }
        EXPECT_NEAR(2 * sum / n + hidden_slopes(t, p), 2 * 0.2 * 0.2, 0.003) << width;
        EXPECT_LT(length(mean), 0.01);
    }
}

TEST(Finishes, CoatsDoNotFollowTheFlakesBelow) {
    const OnBall ball;
    PhysicalMaterial m;
    m.metallic = 1, m.roughness = 0.2, m.clearcoat = 1;
    const TexturedMaterial paint(scene::Material{"", m, {{"normal", flakes(0.01, 0.3)}}});
    EXPECT_TRUE(paint.has_own_coat());
    Random random(6);
    double bent = 0;
    for (int i = 0; i < 50; ++i) {
        const TexturePoint point = ball.at(random.direction());
        const Lobes lobes = paint.lobes_at(point);
        EXPECT_LT(length(lobes.coat_normal - point.geometric), 1e-6);
        EXPECT_EQ(lobes.alpha, compile(scene::Material{"", m, {}}).alpha) << "seen from near";
        const Vec3 normal = paint.normal_at(point, point.geometric);
        bent = std::max(bent, length(normal - point.geometric));
        const Vec3 v = normalize(point.geometric + perpendicular(point.geometric) * 0.5);
        const Facing facing{normal, point.geometric, false};
        for (int k = 0; k < 50; ++k) {
            const auto s = sample_scatter(lobes, facing, v, {random.uniform(), random.uniform(), random.uniform()}, true);
            if (!s || !s->delta) continue;
            EXPECT_NEAR(dot(s->direction + v, point.geometric), length(s->direction + v), 1e-6);  // mirrored by the coat's normal
        }
        const Lobes afar = paint.lobes_at(ball.at(point.geometric, 0.1));
        EXPECT_GT(afar.alpha, 0.3f) << "seen from afar: the root of twice the variance of the slopes";
    }
    EXPECT_GT(bent, 0.2);
}

// The library in a furnace, where its textures are looked at too.
TEST(Finishes, TheLibrarysTexturesAddNoLight) {
    const OnBall ball;
    int textured = 0;
    for (const scene::LibraryMaterial& m : scene::material_library()) {
        const scene::Material material{m.name, m.material, m.textures};
        if (!TexturedMaterial::varies(material)) continue;
        ++textured;
        const TexturedMaterial made(material);
        Random random(7);
        for (int i = 0; i < 12; ++i) {
            const TexturePoint point = ball.at(random.direction(), i % 3 == 0 ? 1e-2 : 1e-5);
            const Lobes lobes = made.lobes_at(point);
            const Vec3 normal = made.normal_at(point, point.geometric);
            const Facing facing{normal, point.geometric, false};
            double sum = 0;
            constexpr int n = 3000;
            for (int k = 1; k <= n; ++k) {
                const std::array<double, 3> u{std::fmod(k * 0.8191725133961645, 1), std::fmod(k * 0.6710436067037893, 1), std::fmod(k * 0.5497004779019703, 1)};
                if (const auto s = sample_scatter(lobes, facing, point.to_viewer, u, true)) sum += max_component(s->value.diffuse + s->value.glossy) / s->value.pdf / n;
            }
            EXPECT_LE(sum, 1.02) << m.name;
            EXPECT_GT(sum, 0.005) << m.name;
        }
    }
    EXPECT_GE(textured, 20);
}

TEST(Finishes, ColoursAreBentByTheirIndex) {
    PhysicalMaterial m;
    m.base_color = {1, 1, 1}, m.roughness = 0, m.transmission = 1, m.ior = 1.5, m.dispersion = 20 / 30.0;
    const Lobes lobes = compile({"", m});
    EXPECT_TRUE(disperses(lobes));
    EXPECT_FALSE(smooth_lobes(lobes).refracts);
    EXPECT_NEAR(in_band(lobes, 2).ior - in_band(lobes, 0).ior, 0.5 / 30, 1e-6) << "Abbe's number";
    EXPECT_EQ(in_band(lobes, 1).ior, 1.5);
    const Facing facing{{0, 0, 1}, {0, 0, 1}, false};
    const Vec3 v = normalize(Vec3{1, 0, 1});
    for (int band = 0; band < 3; ++band) {
        const auto s = sample_scatter(in_band(lobes, band), facing, v, {0.5, 0.5, 0.5}, false);
        ASSERT_TRUE(s && s->delta && s->crosses);
        EXPECT_NEAR(-s->direction.x, v.x / in_band(lobes, band).ior, 1e-9);
    }
    m.dispersion = 0;
    EXPECT_FALSE(sample_scatter(compile({"", m}), facing, v, {0.5, 0.5, 0.5}, false));
}

// A bright bar behind a ball of glass: with dispersion its image has coloured edges.
TEST(Finishes, LevelsThatSampleShowDispersion) {
    const auto seen_through = [](double dispersion) {
        Build b(24, 24);
        b.camera().position = {0, 0, 4}, b.camera().field_of_view = 0.5;
        PhysicalMaterial ball;
        ball.base_color = {1, 1, 1}, ball.roughness = 0, ball.transmission = 1, ball.ior = 1.6, ball.dispersion = dispersion;
        b.place(sphere(0.8), b.material(ball));
        b.place(box({-0.1, -5, -3.1}, {0.1, 5, -3}), b.material(glow({1, 1, 1})));
        b.settings().level = scene::Level::soft, b.settings().samples = 64, b.settings().noise = 0.0001;
        return picture_of(std::move(b.scene));
    };
    const auto apart = [](const scene::Image& image) {  // red and blue, over all pixels
        double sum = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) sum += std::abs(pixel(image, x, y).r - pixel(image, x, y).b);
        }
        return sum;
    };
    EXPECT_LT(apart(seen_through(0)), 1e-3);
    EXPECT_GT(apart(seen_through(3)), 1);
}

}  // namespace
}  // namespace crescente::render::testing
