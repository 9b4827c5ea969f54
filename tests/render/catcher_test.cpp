// Surfaces of which the camera sees only shadows and reflections, and pictures with alpha.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Scene;

PhysicalMaterial lambert(float albedo) {
    PhysicalMaterial m;
    m.base_color = gray(albedo), m.roughness = 1, m.ior = 1;
    return m;
}

enum class Kind { ordinary, catcher, ordinary_alone };

// A ball on level ground, from above at an angle, under a lamp or a lamp with extent and an even sky.
Scene still(Kind kind, scene::Level level, PhysicalMaterial ground = lambert(0.8f)) {
    Build b(32, 24);
    ground.catcher = kind == Kind::catcher;
    b.place(geometry::Plane{}, b.material(ground));
    if (kind != Kind::ordinary_alone) b.place(sphere(0.5), b.material(lambert(0.4f)), at({0, 0.5, 0}));
    b.camera().position = {0, 3, 4}, b.camera().target = {0.2, 0.2, 0}, b.camera().field_of_view = 0.6;
    scene::Light& light = b.light();
    light.position = {-2, 4, 1}, light.intensity = 25;
    if (level > scene::Level::edges) light.kind = scene::LightKind::sphere, light.radius = 0.6, light.visible = false;
    b.uniform_environment(gray(0.5f), 0.3);
    b.scene.environment->transparent = kind == Kind::catcher;
    b.settings().level = level, b.settings().samples = 64, b.settings().noise = 0.002;
    return b.scene;
}

float alpha(const scene::Image& image, int x, int y) { return image.layers[0].values[4 * (static_cast<std::size_t>(y) * image.width + x) + 3]; }
Rgb color(const scene::Image& image, int x, int y) {
    const std::size_t channels = image.layers[0].channels.size();
    const float* v = &image.layers[0].values[channels * (static_cast<std::size_t>(y) * image.width + x)];
    return {v[0], v[1], v[2]};
}

// Laid over a picture of the ground alone, the picture that only catches is that of ball and ground.
void expect_composed(scene::Level level, double mean_tolerance, double largest_tolerance) {
    const scene::Image caught = picture_of(still(Kind::catcher, level)), whole = picture_of(still(Kind::ordinary, level)), ground = picture_of(still(Kind::ordinary_alone, level));
    ASSERT_EQ(caught.layers[0].channels.size(), 4u);
    ASSERT_EQ(whole.layers[0].channels.size(), 3u);
    double sum = 0, largest = 0, shadow = 0;
    for (int y = 0; y < whole.height; ++y) {
        for (int x = 0; x < whole.width; ++x) {
            const Rgb composed = color(caught, x, y) + color(ground, x, y) * (1 - alpha(caught, x, y));
            const double off = std::abs(luminance(composed) - luminance(color(whole, x, y))) / luminance(color(ground, x, y));
            sum += off, largest = std::max(largest, off);
            if (luminance(color(caught, x, y)) < 0.02) shadow = std::max(shadow, double(alpha(caught, x, y)));
        }
    }
    EXPECT_LT(sum / (whole.width * whole.height), mean_tolerance);
    EXPECT_LT(largest, largest_tolerance);
    EXPECT_GT(shadow, 0.5) << "some ground is in shadow";
}

TEST(Catcher, LaidOverTheGroundAloneIsThePicture) { expect_composed(scene::Level::reflections, 5e-4, 0.02); }
TEST(Catcher, TheSameBySamples) { expect_composed(scene::Level::soft, 4e-3, 0.06); }
TEST(Catcher, TheSameWithLightBetweenSurfaces) { expect_composed(scene::Level::indirect, 8e-3, 0.1); }

TEST(Catcher, WithoutAlphaItShowsWhatIsBehind) {
    for (const scene::Level level : {scene::Level::reflections, scene::Level::soft}) {
        Scene s = still(Kind::catcher, level);
        const scene::Image apart = picture_of(s);
        s.environment->transparent = false, s.environment->backdrop = true;
        s.environment->backdrop_top = {0.2f, 0.4f, 0.9f}, s.environment->backdrop_bottom = {0.9f, 0.5f, 0.1f};
        const scene::Image laid = picture_of(s);
        for (int y = 0; y < laid.height; ++y) {
            const float up = 1 - (y + 0.5f) / laid.height;
            const Rgb behind = mix(s.environment->backdrop_bottom, s.environment->backdrop_top, up);
            for (int x = 0; x < laid.width; ++x) {
                const Rgb expected = color(apart, x, y) + behind * (1 - alpha(apart, x, y));
                for (int k = 0; k < 3; ++k) ASSERT_NEAR(pixel(laid, x, y)[k], expected[k], 1e-2) << x << "," << y;
            }
        }
    }
}

TEST(Catcher, MirrorsObjectsAndNothingElse) {
    for (const double roughness : {0.0, 0.3}) {
        PhysicalMaterial steel;
        steel.metallic = 1, steel.roughness = roughness, steel.base_color = gray(0.9f);
        const scene::Image image = picture_of(still(Kind::catcher, scene::Level::soft, steel));
        int mirrored = 0, clear = 0;
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) {
                mirrored += alpha(image, x, y) < 0.9 && luminance(color(image, x, y)) > 0.02;
                clear += alpha(image, x, y) < 0.1 && luminance(color(image, x, y)) == 0;
            }
        }
        EXPECT_GT(mirrored, 10);
        if (roughness == 0) {
            EXPECT_GT(clear, 100);
        }
    }
}

TEST(Alpha, ThroughCoverageAndEdges) {
    Build b(16, 16);
    PhysicalMaterial veil = lambert(0.5f);
    veil.opacity = 0.25;
    b.place(box({-10, -10, -1}, {0, 10, -0.9}), b.material(veil));  // the left half, crossed twice
    b.steady_light({0, 0, 5});
    b.uniform_environment(gray(0.7f), 0);
    b.scene.environment->transparent = true;
    b.camera().projection = scene::Projection::orthographic, b.camera().height = 2;
    for (const scene::Level level : {scene::Level::reflections, scene::Level::edges, scene::Level::soft}) {
        b.settings().level = level, b.settings().supersampling = 2, b.settings().samples = 4;
        const scene::Image image = picture_of(b.scene);
        EXPECT_NEAR(alpha(image, 3, 8), 1 - 0.75 * 0.75, 1e-4);
        EXPECT_EQ(alpha(image, 12, 8), 0);
        EXPECT_EQ(luminance(color(image, 12, 8)), 0);
    }
}

}  // namespace
}  // namespace crescente::render::testing
