// Through a lens: surfaces of which the camera sees only shadows and reflections, and pictures with alpha.
#include <cmath>

#include "render/lens.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Scene;

PhysicalMaterial lambert(float albedo) {
    PhysicalMaterial m;
    m.base_color = gray(albedo), m.roughness = 1, m.ior = 1;
    return m;
}

// A ball on ground that catches its shadow, from above at an angle, under a soft light or a lamp without extent, and an even sky.
Scene still(scene::Level level, PhysicalMaterial ground, bool lamp) {
    Build b(30, 20);
    ground.catcher = true;
    b.place(geometry::Plane{}, b.material(ground));
    b.place(sphere(0.5), b.material(lambert(0.4f)), at({0, 0.5, 0}));
    b.camera().position = {0, 3, 4}, b.camera().target = {0.2, 0.2, 0}, b.camera().field_of_view = 0.6;
    scene::Light& light = b.light();
    light.position = {-2, 4, 1}, light.intensity = 25;
    if (!lamp) light.kind = scene::LightKind::sphere, light.radius = 0.6, light.visible = false;
    b.uniform_environment(gray(0.5f), 0.3);
    b.settings().level = level, b.settings().samples = 256, b.settings().noise = 0.002, b.settings().threads = 2, b.settings().supersampling = 1;
    b.settings().denoise = scene::Denoise::off;
    return b.scene;
}

// Means over blocks of 5 x 5 pixels, of every channel: block by block, channel by channel.
std::vector<double> blocks(const scene::Image& image) {
    const std::size_t channels = image.layers[0].channels.size();
    const int across = image.width / 5;
    std::vector<double> means(static_cast<std::size_t>(across * (image.height / 5)) * channels);
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            for (std::size_t c = 0; c < channels; ++c) {
                means[static_cast<std::size_t>(y / 5 * across + x / 5) * channels + c] += image.layers[0].values[channels * (static_cast<std::size_t>(y) * image.width + x) + c] / 25;
            }
        }
    }
    return means;
}
void expect_near(const scene::Image& a, const scene::Image& b, double tolerance) {
    const std::vector<double> x = blocks(a), y = blocks(b);
    ASSERT_EQ(x.size(), y.size());
    for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(x[i], y[i], tolerance) << "value " << i;
}

double alpha(const scene::Image& image, int x, int y) { return image.layers[0].values[4 * (static_cast<std::size_t>(y) * image.width + x) + 3]; }

// An opening that is as good as a point shows what the trees show: color, and alpha where the picture has one.
TEST(LensCatcher, PointOpeningShowsThePinholesPicture) {
    PhysicalMaterial steel = lambert(0.8f), blurred = steel, sheet = lambert(0.8f);
    steel.metallic = 1, steel.roughness = 0;
    blurred.metallic = 1, blurred.roughness = 0.3;
    sheet.opacity = 0.6, sheet.specular = 0.5;
    struct Variant {
        const char* name;
        PhysicalMaterial ground;
        bool lamp;
    };
    const Variant variants[] = {{"soft light", lambert(0.8f), false}, {"lamp", lambert(0.8f), true}, {"mirror", steel, false}, {"blurred mirror", blurred, true}, {"coverage", sheet, false}};
    for (const Variant& v : variants) {
        for (const bool transparent : {true, false}) {
            SCOPED_TRACE(std::string(v.name) + (transparent ? ", alpha" : ", backdrop"));
            Scene scene = still(v.lamp ? scene::Level::indirect : scene::Level::soft, v.ground, v.lamp);
            scene.environment->transparent = transparent, scene.environment->backdrop = !transparent;
            scene.environment->backdrop_top = {0.2f, 0.4f, 0.9f}, scene.environment->backdrop_bottom = {0.9f, 0.5f, 0.1f};
            const scene::Image trees = picture_of(scene);
            scene.camera->aperture = 1e-9;
            const scene::Image paths = picture_of(scene);
            EXPECT_EQ(paths.layers[0].channels.size(), transparent ? 4u : 3u);
            expect_near(trees, paths, 0.015);
        }
    }
}

// What a lens does to a catcher far out of focus does not change how much of the ground's light the ball keeps off in all.
TEST(LensCatcher, ABlurredShadowIsTheSharpOneSpread) {
    Scene scene = still(scene::Level::soft, lambert(0.8f), false);
    scene.nodes[1].transform = at({-3, 3, 0});  // out of the picture, which is of the ground from above
    scene.lights[0].position = {-6, 6, 0}, scene.lights[0].radius = 0.2, scene.lights[0].intensity = 100;
    scene.environment->transparent = true;
    scene.camera->position = {0, 6, 0}, scene.camera->target = {0, 0, 0}, scene.camera->up = {0, 0, -1};
    scene.camera->aperture = 1e-9;
    const scene::Image sharp = picture_of(scene);
    scene.camera->aperture = 0.6, scene.camera->focus_distance = 3;
    const scene::Image spread = picture_of(scene);
    const auto square_about_middle = [](const scene::Image& image, double& sum) {
        double mean_x = 0, mean_y = 0, square = 0;
        for (const bool first : {true, false}) {
            for (int y = 0; y < image.height; ++y) {
                for (int x = 0; x < image.width; ++x) {
                    const double a = alpha(image, x, y);
                    if (first) sum += a, mean_x += a * x, mean_y += a * y;
                    else square += a * ((x - mean_x / sum) * (x - mean_x / sum) + (y - mean_y / sum) * (y - mean_y / sum));
                }
            }
        }
        return square / sum;
    };
    double a = 0, b = 0;
    const double square_a = square_about_middle(sharp, a), square_b = square_about_middle(spread, b);
    EXPECT_GT(a, 8);
    EXPECT_NEAR(a, b, 0.03 * a);
    // Each point of it is spread over a disk of 0.6 (6 - 3) / 6 in the plane of focus, by an eighth of the square of that.
    const double confusion = 0.3 * 20 / (2 * 3 * std::tan(0.3));
    EXPECT_NEAR(square_b - square_a, confusion * confusion / 8, 0.3 * confusion * confusion / 8);
}

// Area of the picture of a ball on the plane at the distance 1 through a pinhole: its outline is the ellipse in which the plane cuts the cone that touches it.
// off: of its middle to the side; at the distance d.
double outline_area(double off, double d, double radius) {
    const double square = off * off + d * d, sine2 = radius * radius / square, cosine2 = d * d / square;
    return pi * std::sqrt(1 - sine2) * sine2 * std::sqrt(cosine2) / std::pow(cosine2 - sine2, 1.5);
}

// The alpha of a ball out of focus is the share of the lens from which it is in the way, fractional about the border; its sum is the mean of the outlines that the lens's points see.
TEST(LensAlpha, OfABallOutOfFocus) {
    constexpr int size = 48;
    for (const double focus : {2.0, 8.0}) {  // before and behind
        Build b(size, size);
        b.camera().position = {0, 0, 4}, b.camera().target = {0, 0, 0}, b.camera().field_of_view = 0.5;
        b.settings().level = scene::Level::soft, b.settings().samples = 256, b.settings().noise = 0.0005, b.settings().threads = 2;
        b.place(sphere(0.3), b.material(lambert(0.5f)));
        b.uniform_environment(gray(0.5f), 1);
        b.scene.environment->transparent = true;
        b.camera().focus_distance = focus, b.camera().aperture = 0.4;
        const scene::Image image = picture_of(b.scene);
        double sum = 0, squares = 0;
        int fractional = 0;
        for (int y = 0; y < size; ++y) {
            for (int x = 0; x < size; ++x) {
                const double a = alpha(image, x, y), dx = x + 0.5 - size / 2.0, dy = y + 0.5 - size / 2.0;
                sum += a, squares += a * (dx * dx + dy * dy);
                fractional += a > 0.02 && a < 0.98;
                EXPECT_GE(a, 0);
                EXPECT_LE(a, 1 + 1e-6);
            }
        }
        const double pixels = size / (2 * std::tan(b.camera().field_of_view / 2));  // of a plane at the distance 1
        double area = 0;
        constexpr int steps = 1000;
        for (int i = 0; i < steps; ++i) area += outline_area(0.2 * std::sqrt((i + 0.5) / steps), 4, 0.3) / steps;
        EXPECT_NEAR(sum, area * pixels * pixels, 0.01 * sum) << focus;
        // A uniform disk of diameter D has a mean square of D^2 / 8 about its middle, a pixel one of 1/6; that of what is spread is added.
        const double confusion = 0.4 * std::abs(4 - focus) / focus / 4 * pixels, radius = std::sqrt(area / pi) * pixels;
        EXPECT_NEAR(squares / sum, confusion * confusion / 8 + radius * radius / 2 + 1.0 / 6, 0.03 * squares / sum) << focus;
        const double ring = pi * 2 * radius * confusion;  // about as many pixels are on the border
        EXPECT_NEAR(fractional, ring, 0.3 * ring) << focus;
        EXPECT_EQ(alpha(image, 0, 0), 0);
        EXPECT_NEAR(alpha(image, size / 2, size / 2), 1, 1e-6);
    }
}

// A ball that moves is in the way for a share of the time.
TEST(LensAlpha, OfABallThatMoves) {
    Build b(40, 20);
    b.camera().projection = scene::Projection::orthographic, b.camera().height = 2, b.camera().position = {0, 0, 4}, b.camera().target = {0, 0, 0};
    b.settings().level = scene::Level::soft, b.settings().samples = 256, b.settings().noise = 0.0005, b.settings().threads = 2;
    const NodeId ball = b.place(sphere(0.5), b.material(lambert(0.5f)), at({-1, 0, 0}));
    b.scene.nodes[ball.value].motion = at({2, 0, 0});
    b.camera().shutter_close = 1;
    b.uniform_environment(gray(0.5f), 1);
    b.scene.environment->transparent = true;
    const scene::Image image = picture_of(b.scene);
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) sum += alpha(image, x, y);
    }
    EXPECT_NEAR(sum, pi * 0.25 * 100, 0.02 * sum) << "none of it is lost";
    EXPECT_NEAR((alpha(image, 19, 9) + alpha(image, 20, 10)) / 2, 0.5, 0.04) << "it takes half the time to pass the middle";
}

// Scales of lights stand outside of what was sampled, shares of shadows included.
TEST(LensCatcher, StrengthAsksForNoRay) {
    Scene scene = still(scene::Level::soft, lambert(0.8f), false);
    scene.settings.samples = 16, scene.environment->transparent = true, scene.camera->aperture = 0.3, scene.settings.noise = 0.0001;
    Session session = finished(scene);
    const RayCounts before = session.stats().rays;
    scene.lights[0].intensity = 5;
    ASSERT_TRUE(session.edit({scene::SetLight{0, scene.lights[0]}}));
    session.advance(Deadline::never());
    EXPECT_EQ((session.stats().rays - before).path, 0u);
    EXPECT_TRUE(same_picture(finished(scene).picture(true), session.picture(true)));
    for (const bool transparent : {false, true}) {
        scene.environment->transparent = transparent;
        ASSERT_TRUE(session.edit({scene::SetEnvironment{scene.environment}}));
        session.advance(Deadline::never());
        EXPECT_TRUE(same_picture(finished(scene).picture(true), session.picture(true))) << transparent;
    }
}

}  // namespace
}  // namespace crescente::render::testing
