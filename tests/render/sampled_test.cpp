// Levels that sample, against what is known in closed form.
#include <cmath>

#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Light;
using scene::Scene;

PhysicalMaterial lambert(float albedo) {
    PhysicalMaterial m;
    m.base_color = gray(albedo), m.roughness = 1, m.ior = 1;
    return m;
}

// A picture of `scene` at a level, small and without splits.
Scene sampled(Scene scene, scene::Level level, int samples) {
    scene.settings.level = level;
    scene.settings.width = scene.settings.height = 16;
    scene.settings.supersampling = 0;
    scene.settings.samples = samples, scene.settings.noise = 0.0001, scene.settings.denoise = scene::Denoise::off;
    return scene;
}

// Mean over the picture, and the standard deviation of that mean if pixels were independent (neighbours share corners: about half of them are).
struct Mean {
    double value, deviation;
};
Mean mean_of(const scene::Image& image) {
    double sum = 0, squares = 0;
    const int count = image.width * image.height;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            const double v = pixel(image, x, y).g;
            sum += v, squares += v * v;
        }
    }
    const double mean = sum / count;
    return {mean, 2 * std::sqrt(std::max(0.0, squares / count - mean * mean) / count)};
}

// What a camera close above a level floor sees of it.
Build floor_scene(const PhysicalMaterial& material) {
    Build b(16, 16);
    b.place(geometry::Plane{}, b.material(material));
    b.scene.camera->position = {0, 0.02, 0}, b.scene.camera->target = {0, 0, 0}, b.scene.camera->up = {0, 0, -1};
    b.scene.camera->field_of_view = 0.2;
    return b;
}

// Irradiance from a sphere of radiance L at height d over the floor: pi L (r / d)^2 (Nusselt's analog).
TEST(Sampled, SphereOverFloor) {
    constexpr double albedo = 0.6, radius = 0.5, height = 2;
    Build b = floor_scene(lambert(albedo));
    Light light;
    light.kind = scene::LightKind::sphere, light.position = {0, height, 0}, light.radius = radius, light.intensity = 3;
    b.scene.lights.push_back(light);
    const double radiance = light.intensity / (math::pi * radius * radius);
    const double expected = albedo / math::pi * math::pi * radiance * radius * radius / (height * height);
    const Mean mean = mean_of(picture_of(sampled(b.scene, scene::Level::soft, 64)));
    EXPECT_NEAR(mean.value, expected, 4 * mean.deviation + 2e-3 * expected);
}

// Irradiance from a disk that faces the floor: pi L r^2 / (r^2 + d^2).
TEST(Sampled, DiskOverFloor) {
    constexpr double albedo = 0.6, radius = 1.5, height = 1;
    Build b = floor_scene(lambert(albedo));
    Light light;
    light.kind = scene::LightKind::disk, light.position = {0, height, 0}, light.radius = radius, light.intensity = 3;
    b.scene.lights.push_back(light);
    const double radiance = light.intensity / (math::pi * radius * radius);
    const double expected = albedo * radiance * radius * radius / (radius * radius + height * height);
    b.scene.camera->near = 0;
    const Mean mean = mean_of(picture_of(sampled(b.scene, scene::Level::soft, 64)));
    EXPECT_NEAR(mean.value, expected, 4 * mean.deviation + 2e-3 * expected);
}

// Between two parallel plates, an emissive disk and the floor: the same as the disk as a light.
TEST(Sampled, EmissiveObjectIsALight) {
    constexpr double albedo = 0.6, radius = 1.5, height = 1;
    Build b = floor_scene(lambert(albedo));
    PhysicalMaterial shining = lambert(0);
    shining.emissive = gray(2);
    geometry::Disk disk;
    disk.radius = radius;
    b.place(disk, b.material(shining), at({0, height, 0}));
    const double expected = albedo * 2 * radius * radius / (radius * radius + height * height);
    for (const scene::Level level : {scene::Level::soft, scene::Level::indirect}) {
        const Mean mean = mean_of(picture_of(sampled(b.scene, level, 64)));
        EXPECT_NEAR(mean.value, expected, 4 * mean.deviation + 2e-3 * expected);
    }
}

// A thin shining sphere, half of which is holes: both its sides are seen from outside, so that it sends as much as a closed one of the same brightness times 1 - 1 / 4.
TEST(Sampled, BothSidesOfAnEmissiveSphere) {
    constexpr double albedo = 0.6, radius = 0.5, height = 2;
    Build b = floor_scene(lambert(albedo));
    PhysicalMaterial veil = lambert(0);
    veil.emissive = gray(4), veil.opacity = 0.5;
    b.place(sphere(radius), b.material(veil), at({0, height, 0}));
    const double expected = albedo * 4 * 0.75 * radius * radius / (height * height);
    const Mean mean = mean_of(picture_of(sampled(b.scene, scene::Level::indirect, 256)));
    EXPECT_NEAR(mean.value, expected, 4 * mean.deviation + 4e-3 * expected);
}

// In a box whose walls shine with e and reflect a share a, after `depth` bounces: a point sees e (1 + a + a^2 + ...), since the last vertex of a path still gets the whole light of what shines on it.
void expect_in_shining_box(int depth, double expected) {
    Build b(16, 16);
    PhysicalMaterial wall = lambert(0.5f);
    wall.emissive = gray(0.5f);
    b.place(box({-1, -1, -1}, {1, 1, 1}), b.material(wall));
    b.scene.camera->position = {0.1, 0.2, 0.3}, b.scene.camera->target = {1, 0.1, 0};
    Scene scene = sampled(b.scene, scene::Level::indirect, 64);
    scene.settings.depth = depth;
    const Mean mean = mean_of(picture_of(scene));
    EXPECT_NEAR(mean.value, expected, 4 * mean.deviation + 3e-3);
}
TEST(Sampled, FurnaceFromInside) { expect_in_shining_box(40, 1); }
TEST(Sampled, FurnaceOfOneBounce) { expect_in_shining_box(1, 0.875); }

// A floor under a sheet and an even sky gets of it what the sheet lets through straight: all directions, not those alone that are drawn for the sky.
TEST(Sampled, SkyThroughASheet) {
    constexpr double albedo = 0.6;
    PhysicalMaterial pane, gauze = lambert(0);
    pane.base_color = gray(1), pane.transmission = 1, pane.roughness = 0;
    gauze.opacity = 0.5;
    const auto floor_under = [&](const PhysicalMaterial& sheet, scene::Level level) {
        Build b = floor_scene(lambert(albedo));
        geometry::Disk disk;
        disk.radius = 1000;
        b.place(disk, b.material(sheet), at({0, 1, 0}));
        b.uniform_environment(gray(1), 1);
        return mean_of(picture_of(sampled(b.scene, level, 64)));
    };
    const double filter = 1 - std::pow((1.5 - 1) / (1.5 + 1), 2);
    const Mean under_pane = floor_under(pane, scene::Level::soft);
    EXPECT_NEAR(under_pane.value, albedo * filter, 4 * under_pane.deviation + 5e-3);
    for (const scene::Level level : {scene::Level::soft, scene::Level::indirect}) {
        const Mean under_gauze = floor_under(gauze, level);
        EXPECT_NEAR(under_gauze.value, albedo / 2, 4 * under_gauze.deviation + 5e-3) << static_cast<int>(level);
    }
}

// Under an even sky everything that absorbs nothing is as bright as the sky.
TEST(Sampled, FurnaceFromOutside) {
    PhysicalMaterial metal, glass;
    metal.base_color = gray(1), metal.metallic = 1;
    glass.base_color = gray(1), glass.transmission = 1, glass.roughness = 0;
    for (const double roughness : {0.0, 0.03, 0.2, 0.5, 1.0}) {
        Build b(16, 16);
        metal.roughness = roughness, metal.clearcoat = roughness == 0.2 ? 1 : 0;
        b.place(sphere(1), b.material(metal), at({-1.1, 0, 0}));
        b.place(sphere(1), b.material(lambert(1)), at({1.1, 0, 0}));
        b.uniform_environment(gray(1), 1);
        b.scene.camera->position = {0, 0, 6};
        Scene scene = sampled(b.scene, scene::Level::indirect, 64);
        scene.settings.depth = 60;
        const scene::Image image = picture_of(scene);
        const Mean mean = mean_of(image);
        EXPECT_NEAR(mean.value, 1, 4 * mean.deviation + 0.01) << roughness;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) EXPECT_NEAR(pixel(image, x, y).g, 1, 0.15) << roughness << " at " << x << " " << y;
        }
    }
}

// Glass under an even sky is not seen at all.
TEST(Sampled, GlassUnderEvenSky) {
    PhysicalMaterial glass;
    glass.base_color = gray(1), glass.transmission = 1;
    for (const double roughness : {0.0, 0.3}) {
        Build b(16, 16);
        glass.roughness = roughness;
        b.place(sphere(1), b.material(glass));
        b.uniform_environment(gray(1), 1);
        b.scene.camera->position = {0, 0, 4};
        Scene scene = sampled(b.scene, scene::Level::soft, 64);
        scene.settings.depth = 60, scene.settings.threshold = 1e-4;
        const Mean mean = mean_of(picture_of(scene));
        EXPECT_NEAR(mean.value, 1, 4 * mean.deviation + 0.02) << roughness;
    }
}

// Light that arrives by way of a lit floor and what hangs over it, where the lamp itself does not.
TEST(Sampled, IndirectIsMoreThanSoft) {
    Build b = floor_scene(lambert(0.5f));
    b.place(box({-1, 1, -1}, {1, 1.1, 1}), b.material(lambert(0.5f)));  // keeps the lamp from what the camera sees
    Light lamp;
    lamp.position = {2, 3, 0}, lamp.intensity = 20;
    b.scene.lights.push_back(lamp);
    EXPECT_LT(mean_of(picture_of(sampled(b.scene, scene::Level::soft, 16))).value, 1e-9);
    EXPECT_GT(mean_of(picture_of(sampled(b.scene, scene::Level::indirect, 16))).value, 0.01);
}

// Strength and colour of a light with extent stand outside of what was sampled.
TEST(Sampled, StrengthAsksForNoRay) {
    Scene scene = sampled(still_life(), scene::Level::indirect, 16);
    scene.lights.clear();
    Light light;
    light.kind = scene::LightKind::rectangle, light.position = {0, 4, 2}, light.intensity = 20;
    scene.lights.push_back(light);
    Session session = finished(scene);
    EXPECT_TRUE(same_picture(picture_of(scene), session.picture()));
    const RayCounts before = session.stats().rays;
    light.intensity = 40, light.color = {1, 0.5f, 0.25f};
    scene.lights[0] = light;
    ASSERT_TRUE(session.edit({scene::SetLight{0, light}}));
    session.advance(Deadline::never());
    const RayCounts asked = session.stats().rays - before;
    EXPECT_EQ(asked.path, 0u);
    EXPECT_EQ(asked.camera, 0u);
    EXPECT_TRUE(same_picture(picture_of(scene), session.picture()));
}

// What a corner needs goes by how little of its pixel it is. Pixels that are whole again, beside those still split, ask nothing of the corners that they had.
TEST(Sampled, PixelsWholeAgainAskForNothing) {
    Scene scene = sampled(still_life(), scene::Level::soft, 256);
    scene.settings.width = 40, scene.settings.height = 30, scene.settings.supersampling = 2, scene.settings.noise = 0.02;
    Light light;
    light.kind = scene::LightKind::sphere, light.position = {0, 4, 2}, light.radius = 1, light.intensity = 20;
    scene.lights = {light};
    Session session = finished(scene);
    scene.lights[0].intensity = 4;
    ASSERT_TRUE(session.edit({scene::SetLight{0, scene.lights[0]}}));
    session.advance(Deadline::never());
    EXPECT_TRUE(same_picture(picture_of(scene), session.picture()));
}

}  // namespace
}  // namespace crescente::render::testing
