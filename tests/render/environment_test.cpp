// Pictures that surround a scene: where they are seen, how they are sampled, and what they light without samples.
#include "render/environment.h"

#include "io/openimageio.h"
#include "io/panorama_file.h"
#include "render/chi_square.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

scene::Environment around(std::shared_ptr<const scene::Panorama> panorama, double rotation = 0) {
    scene::Environment e;
    e.panorama = std::move(panorama), e.rotation = rotation;
    return e;
}

std::shared_ptr<const scene::Panorama> painted(int width, int height, const std::function<Rgb(int x, int y)>& color) {
    std::vector<Rgb> pixels;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) pixels.push_back(color(x, y));
    }
    return std::make_shared<const scene::Panorama>(width, height, std::move(pixels));
}

// Dim noise, black parts, and a small sun.
std::shared_ptr<const scene::Panorama> sky() {
    Random random(9);
    return painted(64, 32, [&](int x, int y) {
        if (x == 20 && y == 7) return Rgb{900, 800, 600};
        return x > 40 && y > 20 ? Rgb{} : Rgb{float(random.uniform()), float(random.uniform()), float(y) / 32};
    });
}

TEST(Panorama, IsSeenAsDocumented) {
    const auto axes = painted(8, 4, [](int x, int y) { return Rgb{float(x), float(y), 1}; });
    const Environment e(around(axes));
    // The middle of the picture is between columns 3 and 4, and rows 1 and 2.
    EXPECT_EQ(e.radiance({1, 0, 0}), (Rgb{3.5f, 1.5f, 1}));
    EXPECT_NEAR(e.radiance({0, 0, 1}).r, 5.5f, 1e-5);
    EXPECT_NEAR(e.radiance({0, 0, -1}).r, 1.5f, 1e-5);
    EXPECT_EQ(e.radiance({0, 1, 0}).g, 0);
    EXPECT_EQ(e.radiance({0, -1, 0}).g, 3);
    EXPECT_NEAR(e.radiance({-1, 0, 0}).r, 3.5f, 1e-5) << "between the last column and the first";
    // Counter-clockwise seen from above: what was at +x is at -z.
    EXPECT_NEAR(Environment(around(axes, pi / 2)).radiance({0, 0, -1}).r, 3.5f, 1e-5);
}

TEST(Panorama, IntensityIsSeenAndLights) {
    scene::Environment e = around(painted(8, 4, [](int, int) { return Rgb{1, 2, 3}; }));
    e.intensity = 2, e.strength = 0;
    const Environment made(e);
    EXPECT_EQ(environment_radiance(made, {0, 0, 1}), (Rgb{2, 4, 6}));
    EXPECT_EQ(made.radiance({0, 0, 1}), (Rgb{1, 2, 3}));
    EXPECT_EQ(made.strength(), 2);
    scene::Environment dimmed = e;
    dimmed.intensity = 0.1;
    EXPECT_TRUE(made.same_radiance(Environment(dimmed)));
    dimmed.rotation = 1;
    EXPECT_FALSE(made.same_radiance(Environment(dimmed)));
    EXPECT_FALSE(made.same_radiance(Environment(scene::Environment{})));
}

TEST(Panorama, IsSampledWithItsDensity) {
    const Environment e(around(sky(), 0.7));
    // Cells that are about a picture's pixel, in places where one shows the sun and its neighbours do not.
    expect_density({{0, 1, 0}, -1.0, 48, 48}, [&](Random& random) { const double u = random.uniform(); return std::optional(e.sample(u, random.uniform()).direction); },
                   [&](Vec3 d) { return e.pdf(d); });
}

TEST(Panorama, SampleAndDensityAgree) {
    // Wider than there are cells; black for the most part.
    const auto wide = painted(4100, 30, [](int x, int y) { return x > 4090 || (x == 7 && y == 12) ? Rgb{1, 0.5f, float(y)} : Rgb{}; });
    for (const auto& panorama : {sky(), wide}) {
        const Environment e(around(panorama, -2));
        Random random(4);
        int differ = 0;
        for (int i = 0; i < 20000; ++i) {
            const double u = random.uniform();
            const Environment::Sample s = e.sample(u, random.uniform());
            EXPECT_NEAR(length(s.direction), 1, 1e-12);
            EXPECT_GT(s.pdf, 0);
            differ += std::abs(e.pdf(s.direction) - s.pdf) > 1e-9 * s.pdf;  // at a border of cells rounding decides
            const Vec3 anywhere = random.direction();
            EXPECT_TRUE(is_black(e.radiance(anywhere)) || e.pdf(anywhere) > 0);
        }
        EXPECT_LE(differ, 2);
    }
}

// Over pi: by samples, and by what the pixels add up to.
Rgb sampled_irradiance(const Environment& e, Vec3 normal) {
    constexpr int n = 500;
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < n * n; ++i) {
        const Environment::Sample s = e.sample((i % n + 0.5) / n, (i / n + 0.5) / n);
        const Rgb radiance = e.radiance(s.direction);
        for (int k = 0; k < 3; ++k) sum[k] += std::max(0.0, dot(s.direction, normal)) / s.pdf * static_cast<double>(radiance[k]) / (pi * n * n);
    }
    return {float(sum[0]), float(sum[1]), float(sum[2])};
}
Rgb summed_irradiance(const scene::Panorama& p, Vec3 normal) {
    double sum[3] = {0, 0, 0};
    for (int y = 0; y < p.height(); ++y) {
        const double top = std::cos(pi * y / p.height()), bottom = std::cos(pi * (y + 1) / p.height());
        for (int x = 0; x < p.width(); ++x) {
            const double azimuth = 2 * pi * ((x + 0.5) / p.width() - 0.5), height = std::cos(pi * (y + 0.5) / p.height()), level = std::sqrt(1 - height * height);
            const double cosine = std::max(0.0, dot(Vec3{level * std::cos(azimuth), height, level * std::sin(azimuth)}, normal));
            const Rgb pixel = p.pixels()[static_cast<std::size_t>(y) * static_cast<std::size_t>(p.width()) + static_cast<std::size_t>(x)];
            for (int k = 0; k < 3; ++k) sum[k] += cosine * (top - bottom) * 2 * pi / p.width() / pi * static_cast<double>(pixel[k]);
        }
    }
    return {float(sum[0]), float(sum[1]), float(sum[2])};
}

TEST(Panorama, IrradianceBySamplesIsThatOfItsPixels) {
    std::vector<std::shared_ptr<const scene::Panorama>> pictures{sky()};
    for (const char* name : {"venice_sunset_1k.hdr", "studio_512_dwab.exr"}) {
        const auto file = std::filesystem::path(CRESCENTE_SHARED) / "assets/hdri" / name;
        if (!io::has_openimageio() || !std::filesystem::exists(file)) continue;
        const auto read = io::read_panorama(file);
        ASSERT_TRUE(read) << read.error().text();
        pictures.push_back(read->panorama);
    }
    for (const auto& picture : pictures) {
        const Environment e(around(picture));
        for (const Vec3 normal : {Vec3{0, 1, 0}, normalize({1, -1, 0.5}), Vec3{0, 0, -1}}) {
            const Rgb sampled = sampled_irradiance(e, normal), summed = summed_irradiance(*picture, normal);
            for (int k = 0; k < 3; ++k) EXPECT_NEAR(sampled[k], summed[k], 0.01 * summed[k] + 1e-3) << picture->width();
        }
    }
}

TEST(Panorama, HarmonicsGiveTheIrradianceOfSmoothSurroundings) {
    const auto even = painted(64, 32, [](int, int) { return Rgb{0.5f, 1, 2}; });
    // Brightness linear in a direction: within the first bands, so that nothing is lost.
    const Vec3 axis = normalize({1, 2, -1});
    const auto slope = painted(256, 128, [&](int x, int y) {
        const double azimuth = 2 * pi * ((x + 0.5) / 256 - 0.5), height = std::cos(pi * (y + 0.5) / 128), level = std::sqrt(1 - height * height);
        return gray(static_cast<float>(1 + dot(axis, Vec3{level * std::cos(azimuth), height, level * std::sin(azimuth)})));
    });
    const auto sunny = sky();
    Random random(2);
    for (int i = 0; i < 20; ++i) {
        const Vec3 normal = random.direction();
        EXPECT_NEAR(even->irradiance(normal).r, 0.5, 1e-3);
        EXPECT_NEAR(even->irradiance(normal).b, 2, 4e-3);
        EXPECT_NEAR(slope->irradiance(normal).g, 1 + 2.0 / 3 * dot(axis, normal), 2e-3);
        const Rgb summed = summed_irradiance(*sunny, normal);
        EXPECT_NEAR(sunny->irradiance(normal).r, summed.r, 0.3 * summed.r + 0.5) << "a sun is too sharp for nine coefficients, but not lost";
    }
}

TEST(Panorama, BlurGoesFromTheMirrorToTheHalfSphere) {
    const auto even = painted(32, 16, [](int, int) { return Rgb{0.5f, 1, 2}; });
    const auto half = painted(64, 32, [](int, int y) { return gray(y < 16 ? 1 : 0); });
    Random random(2);
    for (int i = 0; i < 50; ++i) {
        const Vec3 d = random.direction();
        EXPECT_NEAR(even->blurred(d, random.uniform()).g, 1, 1e-5);
        EXPECT_EQ(half->blurred(d, 0), half->radiance(d));
    }
    float before = 1;
    for (const double roughness : {0.1, 0.25, 0.4, 0.7, 1.0}) {  // from just above the horizon more and more of the dark half is seen
        const float now = half->blurred(normalize({1, 0.2, 0.3}), roughness).r;
        EXPECT_LT(now, before + 1e-6f);
        before = now;
    }
    EXPECT_NEAR(before, 0.6, 0.1);
    EXPECT_GT(half->blurred({0, 1, 0}, 1).r, 0.97f);
}

// A matt and a mirroring ball below the level of samples.
TEST(Panorama, LightsAtEveryLevel) {
    const auto even = painted(32, 16, [](int, int) { return Rgb{0.5f, 1, 0.25f}; });
    Build s(16, 16);
    s.camera().projection = scene::Projection::orthographic;
    PhysicalMaterial white;
    white.base_color = gray(1), white.roughness = 1, white.metallic = 1;
    s.place(box({-20, -20, -1}, {20, 20, 0}), s.material(white));
    s.scene.environment = around(even);
    s.scene.environment->intensity = 2;
    const scene::Image picture = picture_of(s.scene);
    const Rgb got = pixel(picture, 8, 8);
    EXPECT_NEAR(got.r / got.g, 0.5, 1e-4);
    EXPECT_GT(got.g, 0.5f);
    EXPECT_LT(got.g, 2.001f);
}

}  // namespace
}  // namespace crescente::render::testing
