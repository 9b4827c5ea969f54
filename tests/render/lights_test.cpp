// Light that reaches a wall, pixel by pixel, against closed forms.
#include "render/light.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

constexpr int n = 12;
constexpr double eye_distance = 5;

// A wall in the plane z = 0, seen along -z: corner (i, j) of the picture sees the point (2 i / n - 1, 1 - 2 j / n, 0).
template <class M>
Build wall(const M& material, scene::Projection projection = scene::Projection::orthographic) {
    Build s(n, n);
    s.camera().projection = projection;
    s.camera().field_of_view = 2 * std::atan(1 / eye_distance);
    s.place(box({-20, -20, -1}, {20, 20, 0}), s.material(material));
    return s;
}

// Each pixel is the mean of its corners.
void expect_wall(const scene::Scene& scene, const std::function<Rgb(Vec3)>& radiance, double tolerance = 1e-5) {
    const scene::Image picture = picture_of(scene);
    double largest = 0;
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
            Rgb expected;
            for (int k = 0; k < 4; ++k) expected += radiance({2.0 * (x + (k & 1)) / n - 1, 1 - 2.0 * (y + (k >> 1)) / n, 0}) * 0.25f;
            largest = std::max(largest, double(max_component(expected)));
            const Rgb got = pixel(picture, x, y);
            for (int k = 0; k < 3; ++k) ASSERT_NEAR(got[k], expected[k], tolerance * (1 + max_component(expected))) << x << "," << y << " channel " << k;
        }
    }
    EXPECT_GT(largest, 0.01) << "a dark wall proves nothing";
}

const Rgb albedo{0.8f, 0.5f, 0.25f}, color{1, 0.9f, 0.5f};

struct Way {
    Vec3 to_light;
    double distance, cosine;
};
Way way(Vec3 point, Vec3 light) {
    const Vec3 path = light - point;
    return {normalize(path), length(path), normalize(path).z};
}

TEST(Lambert, PhysicalPointLight) {
    PhysicalMaterial m;
    m.base_color = albedo, m.roughness = 1, m.ior = 1;  // no layer over it
    Build s = wall(m);
    scene::Light& light = s.light();
    light.position = {0.3, -0.2, 1.7}, light.intensity = 30, light.color = color, light.highlights = false;
    expect_wall(s.scene, [&](Vec3 p) {
        const Way w = way(p, light.position);
        return albedo * color * static_cast<float>(30 / pi / (w.distance * w.distance) * w.cosine);
    });
}

TEST(Lambert, ClassicPointLight) {
    Build s = wall(matte(albedo));
    s.steady_light({-0.6, 0.4, 0.8}, color).intensity = 1.5;
    expect_wall(s.scene, [&](Vec3 p) { return albedo * color * static_cast<float>(1.5 * way(p, {-0.6, 0.4, 0.8}).cosine); });
}

TEST(Lambert, DirectionalLight) {
    Build s = wall(matte(albedo));
    scene::Light& sun = s.light();
    sun.kind = scene::LightKind::directional, sun.direction = {3, 4, -12}, sun.intensity = 2;
    sun.outer_angle = 0.1;  // a cone says nothing to light from a direction
    expect_wall(s.scene, [&](Vec3) { return albedo * (2 * 12 / 13.0f); });
}

TEST(Lambert, LightsAdd) {
    Build s = wall(matte(albedo));
    s.steady_light({0, 0, 2}, {0.5f, 0, 0});
    s.steady_light({1, 0, 2}, {0, 0.5f, 0.25f});
    s.steady_light({0, 0, -3}, {9, 9, 9});  // behind the wall
    expect_wall(s.scene, [&](Vec3 p) {
        return albedo * (Rgb{0.5f, 0, 0} * float(way(p, {0, 0, 2}).cosine) + Rgb{0, 0.5f, 0.25f} * float(way(p, {1, 0, 2}).cosine));
    });
}

TEST(Lambert, AmbientAndEmissionNeedNoLight) {
    ClassicMaterial m = matte(albedo);
    m.ambient = {0.1f, 0.2f, 0.05f}, m.emission = {0.3f, 0, 0.1f};
    expect_wall(wall(m).scene, [&](Vec3) { return Rgb{0.4f, 0.2f, 0.15f}; });
}

// Below the level that samples them they act at their centre: flat ones by the cosine, whatever their size.
TEST(Extent, ActsAtItsCenter) {
    for (const auto kind : {scene::LightKind::rectangle, scene::LightKind::disk, scene::LightKind::sphere}) {
        for (const bool two_sided : {false, true}) {
            SCOPED_TRACE(static_cast<int>(kind) * 2 + two_sided);
            const bool flat = kind != scene::LightKind::sphere;
            Build s = wall(matte(albedo));
            scene::Light& light = s.light();
            light.kind = kind, light.position = {0.3, -0.2, 1.7}, light.direction = {1, 0.5, -1}, light.intensity = 3, light.color = color;
            light.width = 4, light.radius = 0.01, light.two_sided = two_sided;
            if (two_sided) light.direction = -light.direction;
            const Vec3 axis = normalize(light.direction);
            expect_wall(s.scene, [&](Vec3 p) {
                const Way w = way(p, light.position);
                const double along = -dot(w.to_light, axis), emitted = !flat ? 1 : two_sided ? std::abs(along) : std::max(0.0, along);
                return albedo * color * static_cast<float>(3 * emitted * w.cosine / (w.distance * w.distance));
            });
            if (!flat || two_sided) continue;
            light.direction = -light.direction;
            EXPECT_EQ(pixel(picture_of(s.scene), n / 2, n / 2), Rgb{}) << "it shines to the front only";
        }
    }
}

// Candela by direction: about the light's axis from its upward side.
TEST(Profile, IsTheLampsOwnDistribution) {
    Build s = wall(matte(albedo));
    scene::Light& light = s.light();
    light.position = {0.2, 0.1, 1.2}, light.direction = {0.3, -0.2, -1}, light.up = {0.1, 1, 0.2}, light.intensity = 0.5;
    light.profile = "lamp.ies";
    light.measured = std::make_shared<const scene::LightProfile>(std::vector{0.0, 0.6, pi / 2}, std::vector{0.0, pi / 2, pi, 1.5 * pi, 2 * pi},
                                                                 std::vector<double>{9, 5, 1, 9, 6, 2, 9, 7, 3, 9, 8, 4, 9, 5, 1});
    const Vec3 axis = normalize(light.direction), up = scene::upward_of(light), aside = cross(up, axis);  // counter-clockwise as seen from behind the lamp
    int turned = 0;
    expect_wall(s.scene, [&](Vec3 p) {
        const Way w = way(p, light.position);
        const Vec3 away = -w.to_light;
        const double about = std::atan2(dot(away, aside), dot(away, up));
        turned += about < 0;
        const double candela = light.measured->intensity(std::acos(dot(away, axis)), about);
        return albedo * static_cast<float>(0.5 * candela * w.cosine / (w.distance * w.distance));
    });
    EXPECT_GT(turned, n);
    // Of a lamp that hangs from the ceiling, up being north, west is at 90 degrees.
    light.position = {}, light.direction = {0, -1, 0}, light.up = {0, 0, -1};
    const Light hanging(light);
    EXPECT_NEAR(hanging.at({-std::sin(0.6), -std::cos(0.6), 0}).strength.r, 0.5 * 6, 1e-6);
    EXPECT_NEAR(hanging.at({std::sin(0.6), -std::cos(0.6), 0}).strength.r, 0.5 * 8, 1e-6);
}

TEST(Falloff, ClassicNeverAmplifies) {
    Build s = wall(matte(albedo));
    scene::Light& light = s.light();
    light.position = {0, 0, 0.9}, light.falloff = scene::Falloff::classic, light.constant = 0.2, light.linear = 0.5, light.quadratic = 0.3;
    expect_wall(s.scene, [&](Vec3 p) {
        const Way w = way(p, light.position);
        const double d = 0.2 + 0.5 * w.distance + 0.3 * w.distance * w.distance;
        return albedo * static_cast<float>(w.cosine * std::min(1.0, 1 / d));
    });
}

TEST(Falloff, RangeFadesAsInGltf) {
    Build s = wall(matte(albedo));
    scene::Light& light = s.light();
    light.position = {0, 0, 0.9}, light.range = 1.2, light.intensity = 2;
    expect_wall(s.scene, [&](Vec3 p) {
        const Way w = way(p, light.position);
        const double fade = std::clamp(1 - std::pow(w.distance / 1.2, 4), 0.0, 1.0);
        return albedo * static_cast<float>(2 * fade * w.cosine / (w.distance * w.distance));
    });
}

TEST(Cone, EveryGradient) {
    for (const scene::Gradient gradient : {scene::Gradient::smooth, scene::Gradient::linear, scene::Gradient::power}) {
        SCOPED_TRACE(static_cast<int>(gradient));
        Build s = wall(matte({1, 1, 1}));
        scene::Light& light = s.steady_light({0.1, 0, 1.5});
        light.direction = {0.2, 0.1, -2}, light.inner_angle = 0.2, light.outer_angle = 0.5, light.gradient = gradient, light.exponent = 6;
        const Vec3 axis = normalize(light.direction);
        int full = 0, partial = 0, dark = 0;
        expect_wall(s.scene, [&](Vec3 p) {
            const Way w = way(p, light.position);
            const double c = -dot(w.to_light, axis), angle = std::acos(c);
            double share = 0;
            if (angle < 0.5) {
                if (gradient == scene::Gradient::smooth) share = std::pow(std::clamp((c - std::cos(0.5)) / (std::cos(0.2) - std::cos(0.5)), 0.0, 1.0), 2);
                if (gradient == scene::Gradient::linear) share = std::clamp((0.5 - angle) / 0.3, 0.0, 1.0);
                if (gradient == scene::Gradient::power) share = std::pow(c, 6);
            }
            ++(share == 0 ? dark : share == 1 ? full : partial);
            return gray(static_cast<float>(share * w.cosine));
        });
        EXPECT_GT(dark, n);
        EXPECT_GT(partial, n);
        EXPECT_TRUE(gradient == scene::Gradient::power || full > n);
    }
}

TEST(Cone, InnerAndOuterMayBeOne) {
    Build s = wall(matte({1, 1, 1}));
    scene::Light& light = s.steady_light({0, 0, 1});
    light.direction = {0, 0, -1}, light.inner_angle = light.outer_angle = 0.6, light.gradient = scene::Gradient::linear;
    expect_wall(s.scene, [&](Vec3 p) {
        const Way w = way(p, light.position);
        return gray(static_cast<float>(std::acos(w.cosine) < 0.6 ? w.cosine : 0));
    });
}

TEST(Highlight, PhongAndBlinnOnTheWall) {
    for (const auto highlight : {scene::Highlight::phong, scene::Highlight::blinn}) {
        for (const auto projection : {scene::Projection::orthographic, scene::Projection::perspective}) {
            ClassicMaterial m = matte({0.2f, 0.2f, 0.3f});
            m.specular = {0.9f, 0.6f, 0.3f}, m.shininess = 30, m.highlight = highlight;
            Build s = wall(m, projection);
            s.steady_light({0.5, 0.3, 2});
            expect_wall(s.scene, [&](Vec3 p) {
                const Way w = way(p, {0.5, 0.3, 2});
                const Vec3 viewer = projection == scene::Projection::orthographic ? Vec3{0, 0, 1} : normalize(Vec3{0, 0, eye_distance} - p);
                const Vec3 mirrored = Vec3{0, 0, 2 * w.cosine} - w.to_light;
                const double c = highlight == scene::Highlight::phong ? dot(mirrored, viewer) : normalize(w.to_light + viewer).z;
                return m.diffuse * float(w.cosine) + m.specular * float(std::pow(std::max(0.0, c), 30));
            });
            s.scene.lights[0].highlights = false;
            expect_wall(s.scene, [&](Vec3 p) { return m.diffuse * float(way(p, {0.5, 0.3, 2}).cosine); });
        }
    }
}

// ---- shadows ----

const Vec3 lamp{0.2, 0.1, 4};

// The wall lit by one lamp, seen from right before it, with things between the two.
Build shaded_wall() {
    Build s = wall(matte(albedo));
    s.camera().position = {0, 0, 0.5};
    s.steady_light(lamp).intensity = 8;
    return s;
}
Rgb lit(Vec3 p) { return albedo * static_cast<float>(8 * way(p, lamp).cosine); }

const Rgb red{0.9f, 0.3f, 0.2f}, blue{0.15f, 0.4f, 0.8f}, green{0.3f, 0.7f, 0.35f};
geometry::Box pane(double z) { return box({-9, -9, z}, {9, 9, z + 0.1}); }

TEST(ColouredShadow, APaneIsCrossedTwice) {
    Build s = shaded_wall();
    s.place(pane(1), s.material(glass(red, 1.5)));
    expect_wall(s.scene, [](Vec3 p) { return lit(p) * red * red; });
}

TEST(ColouredShadow, APaneAbsorbsOnTheWayThrough) {
    Build s = shaded_wall();
    ClassicMaterial tinted = glass(red, 1.5), smoked = glass(blue, 1);
    tinted.attenuation = {2, 0.5f, 7}, smoked.attenuation = {0.3f, 3, 0};
    s.place(pane(1), s.material(tinted));
    s.place(box({-9, -9, 0.95}, {9, 9, 1.02}), s.material(smoked));  // the two overlap
    expect_wall(s.scene, [&](Vec3 p) {
        const double c = way(p, lamp).cosine;
        Rgb expected = lit(p) * red * red * blue * blue;
        for (const auto& [a, thickness] : {std::pair{tinted.attenuation, 0.1}, {smoked.attenuation, 0.07}}) {
            expected *= Rgb{float(std::exp(-a.r * thickness / c)), float(std::exp(-a.g * thickness / c)), float(std::exp(-a.b * thickness / c))};
        }
        return expected;
    });
}

TEST(ColouredShadow, PanesMultiplyInAnyOrder) {
    const std::pair<double, Rgb> panes[] = {{1, red}, {2, blue}, {3, green}};
    std::vector<int> order{0, 1, 2};
    scene::Image first;
    do {
        Build s = shaded_wall();
        for (const int i : order) s.place(pane(panes[i].first), s.material(glass(panes[i].second, 1)));
        expect_wall(s.scene, [](Vec3 p) { return lit(p) * red * red * blue * blue * green * green; });
        const scene::Image picture = picture_of(s.scene);
        if (first.width == 0) first = picture;
        EXPECT_TRUE(same_picture(first, picture));
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(ColouredShadow, OpaqueThingsEndTheWay) {
    for (const double z : {1.5, 2.5}) {  // behind and before the pane
        Build s = shaded_wall();
        s.place(pane(2), s.material(glass(red, 1)));
        s.place(box({-9, -9, z}, {0.1, 9, z + 0.1}), s.material(matte({1, 1, 1})));
        const double edge = 0.1;
        expect_wall(s.scene, [&](Vec3 p) {
            const auto blocked = [&](double height) { return p.x + (lamp.x - p.x) * height / lamp.z < edge; };
            return blocked(z) || blocked(z + 0.1) ? Rgb{} : lit(p) * red * red;
        });
    }
}

TEST(ColouredShadow, LightsWithoutShadowsPassEverything) {
    Build s = shaded_wall();
    s.place(pane(1), s.material(matte({1, 1, 1})));
    s.scene.lights[0].shadows = false;
    expect_wall(s.scene, lit);
}

TEST(ColouredShadow, WhatStandsBehindTheLampDoesNotShade) {
    Build s = shaded_wall();
    s.place(pane(4.05), s.material(matte({1, 1, 1})));
    expect_wall(s.scene, lit);
}

// Every shadow ray of a picture corner meets the sheet at a vertex or an edge, where up to six triangles meet: one crossing.
TEST(ColouredShadow, ASheetIsCrossedOnceAlsoAtItsEdges) {
    Build s = wall(matte({1, 1, 1}));
    s.camera().position = {0, 0, 0.5};
    scene::Light& sun = s.light();
    sun.kind = scene::LightKind::directional, sun.direction = {0, 0, -1};
    const MaterialId tint = s.material(glass(red, 1));
    s.place(grid_mesh(2 * n, 1), tint, Affine::scaling({2, 2, 1}));
    expect_wall(s.scene, [](Vec3) { return red; });
    s.place(grid_mesh(3 * n, 2), tint, Affine::scaling({1.5, 1.5, 1}));
    expect_wall(s.scene, [](Vec3) { return red * red; });
}

// Modellers leave faces twice in a mesh, also turned round: eye and light cross such a sheet once.
TEST(ColouredShadow, ASheetWithDoubledFacesIsCrossedOnce) {
    for (const bool turned : {false, true}) {
        Build s = wall(matte({1, 1, 1}));
        s.camera().position = {0, 0, 3};
        scene::Light& sun = s.light();
        sun.kind = scene::LightKind::directional, sun.direction = {1, -2, -7};
        geometry::Mesh sheet = grid_mesh(5, 1);
        for (std::size_t i = 0, count = sheet.triangles.size(); i < count; ++i) {
            const auto [a, b, c] = sheet.triangles[i];
            turned ? sheet.triangles.push_back({a, c, b}) : sheet.triangles.push_back({b, c, a});
        }
        s.place(sheet, s.material(glass(red, 1)), Affine::scaling({3, 3, 1}) * Affine::rotation({0, 0, 1}, 0.3));
        const auto cosine = static_cast<float>(7 / std::sqrt(54.0));
        expect_wall(s.scene, [=](Vec3) { return red * red * cosine; });
        s.camera().position = {0, 0, 0.5};
        expect_wall(s.scene, [=](Vec3) { return red * cosine; });
    }
}

// A lamp that lies in a surface, as one in a ceiling does, is not shaded by it.
TEST(Shadow, ALampInTheCeilingShines) {
    Build s = wall(matte(albedo));
    s.camera().position = {0, 0, 0.5};
    const Vec3 spot{0.2, 0.1, 1.3};
    s.place(box({-9, -9, spot.z}, {9, 9, 2}), s.material(matte({1, 1, 1})));
    s.steady_light(spot);
    expect_wall(s.scene, [&](Vec3 p) { return albedo * static_cast<float>(way(p, spot).cosine); });
    // What stands right before it does.
    s.place(geometry::Disk{}, s.material(matte({1, 1, 1})), at(spot - Vec3{0, 0, 1e-6}) * Affine::rotation({1, 0, 0}, 0.5 * pi));
    const scene::Image picture = picture_of(s.scene);
    EXPECT_TRUE(is_black(pixel(picture, n / 2, n / 2)));
}

}  // namespace
}  // namespace crescente::render::testing
