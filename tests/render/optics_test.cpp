// Furnaces, refraction, absorption, and the growth of trees by influence, against closed forms.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

constexpr int n = 24;

void expect_uniform(const scene::Scene& scene, Rgb radiance) {
    const scene::Image picture = picture_of(scene);
    for (int y = 0; y < scene.settings.height; ++y) {
        for (int x = 0; x < scene.settings.width; ++x) ASSERT_EQ(pixel(picture, x, y), radiance) << x << "," << y;
    }
}

Build furnace() {
    Build s(n, n);
    s.camera().field_of_view = 0.5;
    s.uniform_environment({1, 0.5f, 0.25f}, 1);
    return s;
}

TEST(Furnace, WhiteBodyIsInvisible) {
    Build s = furnace();
    s.place(sphere(1), s.material(matte({1, 1, 1})));
    const scene::Image picture = picture_of(s.scene);
    for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) expect_near(pixel(picture, x, y), {1, 0.5f, 0.25f}, 1e-6);
    }
}

TEST(Furnace, MirrorIsInvisible) {
    Build s = furnace();
    const MaterialId m = s.material(mirror({1, 1, 1}));
    s.place(sphere(0.7), m);
    s.place(smooth_sphere_mesh(5, 7), m, at({0.9, 0.9, 0}) * Affine::scaling({0.3, 0.5, 0.3}));
    s.settings().depth = 200, s.settings().threshold = 0;  // between two bodies rays bounce long, but not for ever
    expect_uniform(s.scene, {1, 0.5f, 0.25f});
}

TEST(Furnace, ClearGlassIsInvisible) {
    for (const double ior : {1.0, 1.5, 0.8}) {
        Build s = furnace();
        s.place(sphere(1), s.material(glass({1, 1, 1}, ior)));
        expect_uniform(s.scene, {1, 0.5f, 0.25f});
    }
}

TEST(Furnace, GlassWithFresnelIsInvisibleUpToWhatIsCutOff) {
    for (const bool physical : {false, true}) {
        Build s = furnace();
        PhysicalMaterial clear;
        clear.base_color = {1, 1, 1}, clear.transmission = 1, clear.roughness = 0;
        s.place(sphere(1), physical ? s.material(clear) : s.material(glass({1, 1, 1}, 1.5, true)));
        s.settings().threshold = 1e-5, s.settings().depth = 60;
        const scene::Image picture = picture_of(s.scene);
        for (int y = 0; y < n; ++y) {
            for (int x = 0; x < n; ++x) {
                EXPECT_LE(pixel(picture, x, y).r, 1 + 1e-5);
                EXPECT_GE(pixel(picture, x, y).r, 1 - 1e-3) << x << "," << y;
            }
        }
    }
}

TEST(Furnace, InsideAGlassBall) {
    Build s = furnace();
    s.camera().position = {0.2, 0.1, 0.3}, s.camera().target = {1, 0, 0};
    s.place(sphere(1), s.material(glass({1, 1, 1}, 1.5)));
    expect_uniform(s.scene, {1, 0.5f, 0.25f});
}

// Camera, slab of thickness `thick` between z = 0 and z = -thick, wall of light at z = -3; seen along (sin a, 0, -cos a).
constexpr double thick = 0.8, slant = 0.7;
Build slab(const ClassicMaterial& material) {
    Build s(4, 4);
    s.camera().projection = scene::Projection::orthographic;
    s.camera().height = 0.5;
    s.camera().position = Vec3{-std::sin(slant), 0, std::cos(slant)} * 3;
    s.place(box({-20, -20, -thick}, {20, 20, 0}), s.material(material));
    s.place(box({-20, -20, -4}, {20, 20, -3}), s.material(glow({1, 1, 1})));
    return s;
}

// The places that a description of a pixel names, in order.
std::vector<Vec3> places(const std::string& text) {
    std::vector<Vec3> found;
    for (std::size_t i = text.find("at ("); i != std::string::npos; i = text.find("at (", i + 1)) {
        Vec3 p;
        if (std::sscanf(text.c_str() + i, "at (%lf %lf %lf)", &p.x, &p.y, &p.z) == 3) found.push_back(p);
    }
    return found;
}

TEST(Refraction, ASlabShiftsARayAsSnellSays) {
    for (const double ior : {1.0, 1.33, 1.5, 2.4, 0.9}) {
        Session session = finished(slab(glass({1, 1, 1}, ior)).scene);
        for (int pixel = 0; pixel < 4; ++pixel) {
            const std::vector<Vec3> path = places(session.describe(pixel, 3 - pixel));
            ASSERT_EQ(path.size(), 12u);  // four corners: into the slab, out of it, the wall
            for (std::size_t corner = 0; corner < 4; ++corner) {
                const Vec3 *hit = &path[3 * corner], in = hit[0], out = hit[1], wall = hit[2];
                const double inside = std::asin(std::sin(slant) / ior);
                EXPECT_NEAR(in.z, 0, 1e-12);
                EXPECT_NEAR(out.z, -thick, 1e-12);
                EXPECT_NEAR(out.x - in.x, thick * std::tan(inside), 1e-6);
                EXPECT_NEAR(wall.x - out.x, (3 - thick) * std::tan(slant), 1e-6);
                EXPECT_NEAR(wall.y, in.y, 1e-6);
            }
        }
    }
}

TEST(Absorption, BeerAndLambert) {
    ClassicMaterial m = glass({0.9f, 0.8f, 1}, 1);
    m.attenuation = {0.5f, 1, 2};
    const double path = thick / std::cos(slant);
    const scene::Image picture = picture_of(slab(m).scene);
    const Rgb expected{float(0.81 * std::exp(-0.5 * path)), float(0.64 * std::exp(-path)), float(std::exp(-2 * path))};
    for (int i = 0; i < 4; ++i) expect_near(pixel(picture, i, 3 - i), expected, 1e-5);
}

TEST(Refraction, TotalReflectionLosesNothing) {
    // A ray that enters a block by its front and meets its side beyond the critical angle: the light behind the side is not seen.
    Build s(4, 4);
    s.camera().projection = scene::Projection::orthographic;
    s.camera().height = 0.1;
    s.camera().position = Vec3{-std::sin(0.6), 0, std::cos(0.6)} * 3;
    s.place(box({-0.3, -5, -9}, {0.3, 5, 0}), s.material(glass({1, 1, 1}, 1.5)));
    s.place(box({1, -9, -9}, {2, 9, 9}), s.material(glow({1, 0, 0})));
    s.place(box({-2, -9, -9}, {-1, 9, 0}), s.material(glow({1, 0, 0})));
    s.place(box({-20, -20, -11}, {20, 20, -10}), s.material(glow({0, 1, 0})));
    s.settings().depth = 40;
    const scene::Image picture = picture_of(s.scene);
    for (int i = 0; i < 16; ++i) expect_near(pixel(picture, i % 4, i / 4), {0, 1, 0}, 1e-5);
}

// A mirror room that glows: each bounce adds half of what the one before gave, as long as the influence exceeds the threshold.
TEST(Influence, TheSeriesEndsAtTheThreshold) {
    for (const int depth : {0, 1, 3, 50}) {
        for (const double threshold : {0.9, 0.5, 0.26, 0.25, 0.1, 1.0 / 256}) {
            Build s(6, 6);
            s.settings().depth = depth, s.settings().threshold = threshold;
            ClassicMaterial m = glow({1, 1, 1});
            m.reflection = {0.25f, 0.5f, 0.125f};  // growth goes on for the greatest component
            s.place(sphere(3), s.material(m));
            s.camera().position = {0.3, 0.2, 0.5};
            Rgb expected{1, 1, 1}, influence = m.reflection;
            std::uint64_t bounces = 0;
            for (; influence.g > threshold && bounces < static_cast<std::uint64_t>(depth); ++bounces, influence *= m.reflection) expected += influence;
            Session session = finished(s.scene);
            const scene::Image picture = session.picture();
            for (int i = 0; i < 36; ++i) expect_near(pixel(picture, i % 6, i / 6), expected, 1e-6);
            EXPECT_EQ(session.stats().rays.reflected, 49 * bounces);
        }
    }
}

// Numbers that follow a word in a text, three by three in brackets.
std::vector<Rgb> triples_after(const std::string& text, const std::string& word) {
    std::vector<Rgb> found;
    for (std::size_t i = text.find(word); i != std::string::npos; i = text.find(word, i + 1)) {
        Rgb c;
        if (std::sscanf(text.c_str() + i + word.size(), " (%f %f %f)", &c.r, &c.g, &c.b) == 3) found.push_back(c);
    }
    return found;
}

TEST(Influence, NothingBelowTheThresholdIsTraced) {
    scene::Scene scene = still_life();
    scene.settings.level = scene::Level::reflections, scene.settings.depth = 30;
    std::uint64_t rays_before = ~0ull;
    scene.settings.threshold = 1.0 / 4096;
    const scene::Image fine = picture_of(scene);
    double last = 0;
    for (const double threshold : {1.0 / 1024, 1.0 / 256, 1.0 / 64, 1.0 / 16, 1.0 / 4, 1.0}) {
        SCOPED_TRACE(threshold);
        scene.settings.threshold = threshold;
        Session session = finished(scene);
        const RayCounts rays = session.stats().rays;
        EXPECT_LT(rays.total(), rays_before);
        rays_before = rays.total();
        std::size_t grown = 0;
        for (int y = 0; y < 53; y += 3) {
            for (int x = 0; x < 75; x += 3) {
                const std::string text = session.describe(x, y);
                for (const Rgb& influence : triples_after(text, "ed ray, influence")) {
                    ++grown;
                    // What the medium absorbs on the way is known only when the ray has been traced.
                    EXPECT_TRUE(max_component(influence) > threshold * 0.999 || text.find("from inside") != std::string::npos);
                }
                for (std::size_t i = text.find("not grown: influence "); i != std::string::npos; i = text.find("not grown: influence ", i + 1)) {
                    EXPECT_LE(std::stod(text.substr(i + 21)), threshold * 1.001);
                }
            }
        }
        EXPECT_EQ(grown > 0, threshold < 1);
        const scene::Image coarse = picture_of(scene);
        double difference = 0;
        for (std::size_t i = 0; i < fine.layers[0].values.size(); ++i) difference += std::abs(fine.layers[0].values[i] - coarse.layers[0].values[i]);
        difference /= static_cast<double>(fine.layers[0].values.size());
        EXPECT_GE(difference, last * 0.999) << "the coarser, the farther";
        EXPECT_LE(difference, 4 * threshold);
        last = difference;
    }
}

}  // namespace
}  // namespace crescente::render::testing
