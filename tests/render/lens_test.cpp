// Through a lens: against the thin lens' equation, a pinhole's picture, and what any lens must keep.
#include <cmath>

#include "math/low_discrepancy.h"
#include "render/blocks.h"
#include "render/lens.h"

namespace crescente::render::testing {
namespace {

using scene::Scene;

// A camera at (0, 0, 4) that looks at the origin, at a level that looks through its lens.
Build lens_scene(int size, int samples) {
    Build b(size, size);
    b.camera().position = {0, 0, 4}, b.camera().target = {0, 0, 0}, b.camera().field_of_view = 0.5;
    b.settings().level = scene::Level::soft, b.settings().samples = samples, b.settings().noise = 0.0001;
    return b;
}

PhysicalMaterial shining(float radiance) {
    PhysicalMaterial m;
    m.base_color = {}, m.emissive = gray(radiance), m.ior = 1;
    return m;
}

// Sum of a picture, its middle in pixels, and the mean square distance from that.
struct Moments {
    double sum = 0, x = 0, y = 0, square = 0;
};
Moments moments_of(const scene::Image& image) {
    Moments m;
    const auto for_all = [&](auto&& visit) {
        for (int y = 0; y < image.height; ++y) {
            for (int x = 0; x < image.width; ++x) visit(x + 0.5, y + 0.5, double(pixel(image, x, y).g));
        }
    };
    for_all([&](double x, double y, double v) { m.sum += v, m.x += v * x, m.y += v * y; });
    m.x /= m.sum, m.y /= m.sum;
    for_all([&](double x, double y, double v) { m.square += v * ((x - m.x) * (x - m.x) + (y - m.y) * (y - m.y)); });
    m.square /= m.sum;
    return m;
}

// A thing at a distance d, seen through a lens of diameter A that is focused at f, is spread over a disk of A |d - f| / d in the plane of focus. A uniform disk of
// diameter D has a mean square of D^2 / 8 about its middle; that of what is spread is added. Nothing of its light is lost.
TEST(Lens, CircleOfConfusion) {
    constexpr int size = 48;
    for (const double distance : {3.0, 6.0}) {  // before and behind the focus
        Build b = lens_scene(size, 512);
        b.camera().focus_distance = 4;
        geometry::Disk disk;
        disk.radius = 0.05 * distance / 4;  // as large in both pictures
        b.place(disk, b.material(shining(1)), at({0, 0, 4 - distance}) * Affine::rotation({1, 0, 0}, pi / 2));
        b.camera().aperture = distance < 4 ? 1.2 : 2.4;
        const Moments spread = moments_of(picture_of(b.scene));
        const double pixels_per_metre = size / (2 * 4 * std::tan(b.camera().field_of_view / 2));  // in the plane of focus
        const double confusion = b.camera().aperture * std::abs(distance - 4) / distance * pixels_per_metre, radius = 0.05 * pixels_per_metre;
        const double square = confusion * confusion / 8 + radius * radius / 2 + 1.0 / 6;  // of the lens, the thing and the pixel
        EXPECT_NEAR(spread.square, square, 0.03 * square) << distance;
        EXPECT_NEAR(spread.sum, pi * radius * radius, 0.03 * pi * radius * radius) << distance;
        EXPECT_NEAR(spread.x, size / 2.0, 0.2);
        EXPECT_NEAR(spread.y, size / 2.0, 0.2);
    }
}

// What lies in the plane of focus is as sharp as a pinhole shows it, however wide the lens.
TEST(Lens, PlaneOfFocusIsSharp) {
    Build b = lens_scene(32, 64);
    b.place(box({-0.5, -0.5, -0.1}, {0.3, 0.6, 0}), b.material(shining(1)));
    const scene::Image sharp = picture_of(b.scene);
    b.camera().aperture = 1;
    const scene::Image through = picture_of(b.scene);
    const double pixels_per_metre = 32 / (2 * 4 * std::tan(b.camera().field_of_view / 2)), area = 0.8 * 1.1 * pixels_per_metre * pixels_per_metre;
    EXPECT_NEAR(moments_of(through).sum, area, 0.01 * area);
    int inner = 0;
    for (int y = 1; y < 31; ++y) {
        for (int x = 1; x < 31; ++x) {
            float low = 1, high = 0;  // pixels at the edge differ in how they are filtered
            for (int k = 0; k < 9; ++k) low = std::min(low, pixel(sharp, x + k % 3 - 1, y + k / 3 - 1).g), high = std::max(high, pixel(sharp, x + k % 3 - 1, y + k / 3 - 1).g);
            if (low != high) continue;
            EXPECT_NEAR(pixel(through, x, y).g, low, 1e-5) << x << " " << y;
            ++inner;
        }
    }
    EXPECT_GT(inner, 500);
    b.camera().focus_distance = 3;
    EXPECT_GT(mean_difference(picture_of(b.scene), through), 0.03);
}

// Through an opening that is as good as a point, pixels get by paths what they get by trees: lamps, mirrors, glass, panes, media, textures, emission, backdrop.
TEST(Lens, PointOpeningShowsThePinholesPicture) {
    for (const scene::Level level : {scene::Level::soft, scene::Level::indirect}) {
        Scene scene = still_life();
        scene.settings.level = level, scene.settings.samples = 32, scene.settings.noise = 0.05, scene.settings.threads = 2;
        scene.settings.width = 40, scene.settings.height = 30;
        scene::Light panel;
        panel.kind = scene::LightKind::rectangle, panel.position = {1, 3, 1}, panel.direction = {-0.2, -1, -0.3}, panel.intensity = 4;
        scene.lights.push_back(panel);
        const scene::Image trees = picture_of(scene);
        scene.camera->aperture = 1e-9;
        const scene::Image paths = picture_of(scene);
        const BlockDifference difference = block_difference(trees, paths, 5);
        EXPECT_LT(std::abs(difference.bias), 0.01 * difference.mean) << static_cast<int>(level);
        EXPECT_LT(difference.absolute, 0.03 * difference.mean) << static_cast<int>(level);
    }
}

// In a box whose walls shine with e and reflect a share a, every point sees e / (1 - a), sharp or not.
TEST(Lens, Furnace) {
    Build b = lens_scene(16, 64);
    PhysicalMaterial wall;
    wall.base_color = gray(0.5f), wall.roughness = 1, wall.ior = 1, wall.emissive = gray(0.5f);
    b.place(box({-5, -5, -5}, {5, 5, 5}), b.material(wall));
    b.settings().level = scene::Level::indirect, b.settings().depth = 40;
    b.camera().aperture = 0.8, b.camera().focus_distance = 2, b.camera().blades = 5;
    EXPECT_NEAR(moments_of(picture_of(b.scene)).sum / 256, 1, 0.01);
}

// Whatever the number of corners: inside of the opening, evenly over its area, turned as asked.
TEST(Lens, Opening) {
    for (const int blades : {0, 3, 4, 5, 6, 9}) {
        scene::Camera camera;
        camera.aperture = 2, camera.blades = blades, camera.blade_rotation = 0.3;
        const int count = 1 << 14;
        double x = 0, y = 0, square = 0, farthest = 0;
        int inner = 0;
        const double half_size = 0.5;
        for (int i = 0; i < count; ++i) {
            const auto u = low_discrepancy(1, static_cast<std::uint32_t>(i));
            const auto [a, b] = point_of_opening(camera, u[0], u[1]);
            x += a, y += b, square += a * a + b * b, farthest = std::max(farthest, std::hypot(a, b));
            // Inside of all sides: distance from the middle along each side's normal.
            double outmost = std::hypot(a, b);
            if (blades > 0) {
                outmost = 0;
                for (int k = 0; k < blades; ++k) {
                    const double angle = pi / 2 + 0.3 + (k + 0.5) * 2 * pi / blades;
                    outmost = std::max(outmost, (a * std::cos(angle) + b * std::sin(angle)) / std::cos(pi / blades));
                }
            }
            EXPECT_LE(outmost, 1 + 1e-12);
            inner += outmost <= half_size;
        }
        // Polar second moment over area of a regular polygon in the unit circle; 1/2 of the circle itself.
        const double expected = blades > 0 ? (2 + std::cos(2 * pi / blades)) / 6 : 0.5;
        EXPECT_NEAR(square / count, expected, 2e-3) << blades;
        EXPECT_NEAR(x / count, 0, 2e-3);
        EXPECT_NEAR(y / count, 0, 2e-3);
        EXPECT_GT(farthest, 0.98);
        EXPECT_NEAR(double(inner) / count, half_size * half_size, 5e-3) << blades;
    }
}

// A point far out of focus takes the form of the opening: three blades, one corner at the top, cover what a triangle does, and no more.
TEST(Lens, HighlightTakesTheFormOfTheOpening) {
    constexpr int size = 40;
    Build b = lens_scene(size, 1024);
    b.camera().aperture = 2, b.camera().focus_distance = 2, b.camera().blades = 3;
    b.place(sphere(0.03), b.material(shining(100)));
    const scene::Image image = picture_of(b.scene);
    // A ray from a point of the lens to what is twice as far as the plane of focus passes that halfway: the opening is seen upright, half as large.
    const double pixels_per_metre = size / (2 * 2 * std::tan(b.camera().field_of_view / 2)), radius = 1 * (4.0 - 2.0) / 4.0 * pixels_per_metre;
    double inside = 0, outside = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            double outmost = -1e9;
            for (int k = 0; k < 3; ++k) {
                const double angle = pi / 2 + (k + 0.5) * 2 * pi / 3;  // of a triangle with a corner at the top, y upwards
                outmost = std::max(outmost, (x + 0.5 - size / 2.0) * std::cos(angle) + (size / 2.0 - y - 0.5) * std::sin(angle));
            }
            (outmost < radius * 0.5 + 1.5 ? inside : outside) += pixel(image, x, y).g;
        }
    }
    EXPECT_GT(inside, 0);
    EXPECT_EQ(outside, 0);
}

// Levels that do not sample know nothing of the lens, and switching it on and off by edits leaves what a fresh picture has.
TEST(Lens, EditsOfTheLens) {
    Scene scene = instances();
    scene.settings.width = 40, scene.settings.height = 30;
    scene.camera->aperture = 0.3;
    Scene pinhole = scene;
    pinhole.camera->aperture = 0;
    EXPECT_TRUE(same_picture(finished(scene).picture(true), finished(pinhole).picture(true)));
    scene.settings.level = scene::Level::soft, scene.settings.samples = 4;
    Session session = finished(scene);
    for (const double aperture : {0.5, 0.0, 0.2}) {
        const RayCounts before = session.stats().rays;
        scene.camera->aperture = aperture;
        ASSERT_TRUE(session.edit({scene::SetCamera{scene.camera}}));
        session.advance(Deadline::never());
        EXPECT_EQ((session.stats().rays - before).camera, 0u) << "the trees are those of the pinhole";
        EXPECT_TRUE(same_picture(finished(scene).picture(true), session.picture(true))) << aperture;
    }
}

// Strength and colour of a light with extent stand outside of what was sampled through a lens, too; so does the exposure.
TEST(Lens, StrengthAsksForNoRay) {
    Build b = lens_scene(16, 16);
    b.place(geometry::Plane{}, b.material(matte(gray(0.5f))), at({0, -0.5, 0}));
    b.camera().aperture = 0.3;
    scene::Light light;
    light.kind = scene::LightKind::rectangle, light.position = {0, 1, 0}, light.direction = {0, -1, -0.2}, light.intensity = 20;
    b.scene.lights.push_back(light);
    Session session = finished(b.scene);
    const RayCounts before = session.stats().rays;
    b.scene.lights[0].intensity = 40, b.scene.lights[0].color = {1, 0.5f, 0.25f};
    ASSERT_TRUE(session.edit({scene::SetLight{0, b.scene.lights[0]}}));
    session.advance(Deadline::never());
    EXPECT_EQ((session.stats().rays - before).path, 0u);
    EXPECT_EQ((session.stats().rays - before).camera, 0u);
    EXPECT_TRUE(same_picture(finished(b.scene).picture(true), session.picture(true)));
}

}  // namespace
}  // namespace crescente::render::testing
