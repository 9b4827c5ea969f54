// Furnaces, refraction, absorption, and the growth of trees by influence, against closed forms.
#include "render/lobes.h"
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

// Nothing that a physical material does adds light, at any angle; what does not absorb gives back all.
TEST(Furnace, PhysicalMaterialsAddNoLight) {
    for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
        for (const double metallic : {0.0, 0.4, 1.0}) {
            for (const double transmission : {0.0, 0.5, 1.0}) {
                for (const double opacity : {0.0, 0.3, 1.0}) {
                    Build s = furnace();
                    s.camera().field_of_view = 0.36;  // to the silhouette
                    PhysicalMaterial m;
                    m.base_color = {1, 1, 1}, m.roughness = roughness, m.metallic = metallic, m.transmission = transmission, m.opacity = opacity;
                    s.place(sphere(1), s.material(m));
                    s.settings().threshold = 1e-4, s.settings().depth = 60;
                    const scene::Image picture = picture_of(s.scene);
                    SCOPED_TRACE(::testing::Message() << "roughness " << roughness << " metallic " << metallic << " transmission " << transmission << " opacity " << opacity);
                    for (int i = 0; i < n * n; ++i) {
                        const Rgb got = pixel(picture, i % n, i / n);
                        for (int k = 0; k < 3; ++k) {
                            const double expected = Rgb{1, 0.5f, 0.25f}[k];
                            ASSERT_LE(got[k], expected * (1 + 1e-5)) << i % n << "," << i / n;
                            ASSERT_GE(got[k], expected * (1 - 0.01)) << i % n << "," << i / n;
                        }
                    }
                }
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

// Coverage over glass: each surface lets through its refracted share, and straight on what it does not cover.
TEST(Coverage, TheStraightShareIsKeptBesideTheRefractedOne) {
    PhysicalMaterial m;
    m.base_color = {0.5f, 0.25f, 1}, m.transmission = 1, m.opacity = 0.6, m.ior = 1, m.roughness = 0;
    const Rgb once{0.5f * 0.6f + 0.4f, 0.25f * 0.6f + 0.4f, 1};
    Build s(4, 4);
    s.camera().projection = scene::Projection::orthographic, s.camera().height = 0.5;
    s.place(box({-20, -20, -1}, {20, 20, 0}), s.material(m));
    s.place(box({-20, -20, -4}, {20, 20, -3}), s.material(glow({1, 1, 1})));
    for (int i = 0; i < 16; ++i) expect_near(pixel(picture_of(s.scene), i % 4, i / 4), once * once, 1e-5);
    // Light takes the same ways.
    Build lit = s;
    lit.scene.materials[1] = {"", matte({1, 1, 1})};
    scene::Light& sun = lit.light();
    sun.kind = scene::LightKind::directional, sun.direction = {0, 0, -1};
    for (int i = 0; i < 16; ++i) expect_near(pixel(picture_of(lit.scene), i % 4, i / 4), once * once * once * once, 1e-5);
    // Bent and unbent rays meet different places.
    m.base_color = {1, 1, 1}, m.opacity = 0.5, m.ior = 1.5;
    Build prism(2, 2);
    prism.camera().projection = scene::Projection::orthographic, prism.camera().height = 0.01;
    prism.camera().position = Vec3{-std::sin(slant), 0, std::cos(slant)} * 3;
    prism.place(box({-20, -20, -2}, {20, 20, 0}), prism.material(m));
    const double straight = 2 * std::tan(slant), bent = 2 * std::tan(std::asin(std::sin(slant) / 1.5)), split = 0.5 * (straight + bent);
    prism.place(box({split, -20, -2.2}, {20, 20, -2.1}), prism.material(glow({1, 0, 0})));
    prism.place(box({-20, -20, -2.2}, {split, 20, -2.1}), prism.material(glow({0, 1, 0})));
    prism.settings().depth = 2;
    // What comes straight to the far surface leaves it straight on or bent once; what comes bent, straight on or bent back.
    const double entering = 0.5 * (1 - fresnel_dielectric(std::cos(slant), 1.5)), leaving = 0.5 * (1 - fresnel_dielectric(std::cos(slant), 1 / 1.5));
    const Rgb got = pixel(picture_of(prism.scene), 0, 0);
    EXPECT_NEAR(got.r, 0.5 * (0.5 + leaving), 1e-4);
    EXPECT_NEAR(got.g, entering * (0.5 + entering), 1e-4);  // out as in: Fresnel's equations hold both ways
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
