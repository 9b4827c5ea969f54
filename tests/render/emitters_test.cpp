// Samplers of what has extent: their densities, what rays meet, and closed forms of irradiance.
#include "render/emitters.h"

#include "render/chi_square.h"
#include "render/scenes.h"
#include "render/world.h"

namespace crescente::render::testing {
namespace {

struct Lit {
    Build build{8, 8};
    std::unique_ptr<World> world;

    scene::Light& light(scene::LightKind kind, Vec3 position, Vec3 direction = {0, -1, 0}) {
        scene::Light& l = build.light();
        l.kind = kind, l.position = position, l.direction = direction;
        return l;
    }
    Emitters emitters() {
        if (build.scene.roots.empty()) build.place(box({-99, -99, -99}, {99, -98, 99}), build.material(matte(gray(0.5f))));
        for (const Problem& p : scene::validate(build.scene, "")) ADD_FAILURE() << p.place << ": " << p.reason;
        auto made = world_of(build.scene);
        EXPECT_TRUE(made);
        world = std::move(*made);
        return Emitters(*world);
    }
};

std::array<double, 3> three(Random& random) { return {random.uniform(), random.uniform(), random.uniform()}; }

// The lights' density of a direction, of all lights on the ray.
double density(const Emitters& e, Vec3 from, Vec3 direction) {
    std::vector<Emitted> met;
    e.lights_on({from, direction}, from, no_instance, [&](const Emitted& light) { met.push_back(light); });
    double sum = 0;
    for (const Emitted& one : met) sum += one.pdf;
    return sum;
}

void expect_lights_density(const Emitters& e, Vec3 from, const DirectionCells& cells) {
    expect_density(
        cells,
        [&](Random& random) -> std::optional<Vec3> {
            const auto s = e.sample(0, from, three(random));
            return s ? std::optional(s->direction) : std::nullopt;
        },
        [&](Vec3 d) { return density(e, from, d); });
}

// Irradiance over the square of samples u, v at the middles of n * n cells.
Rgb irradiance(const Emitters& e, std::size_t group, Vec3 point, Vec3 normal, int n = 256, double choice = 0.5) {
    double sum[3] = {0, 0, 0};
    for (int i = 0; i < n * n; ++i) {
        const auto s = e.sample(group, point, {(i % n + 0.5) / n, (i / n + 0.5) / n, choice});
        if (!s) continue;
        const double weight = std::max(0.0, dot(s->direction, normal)) / s->pdf / (n * n);
        for (int k = 0; k < 3; ++k) sum[k] += weight * s->radiance[k];
    }
    return Rgb{static_cast<float>(sum[0]), static_cast<float>(sum[1]), static_cast<float>(sum[2])} * e.scale(group);
}

TEST(Emitters, RectangleIsSampledWithItsDensity) {
    Lit near;
    scene::Light& l = near.light(scene::LightKind::rectangle, {0, 1, 0}, {0.2, -1, 0.1});
    l.width = 2, l.height = 0.7, l.up = {0.3, 0, 1};
    expect_lights_density(near.emitters(), {0.2, 0, 0.1}, {normalize({0, 1, 0}), 0.3});
    l.position = {30, 80, 0};  // by area
    l.direction = {-3, -8, 0};
    expect_lights_density(near.emitters(), {0, 0, 0}, {normalize({30, 80, 0}), std::cos(0.014)});
}

TEST(Emitters, DiskIsSampledWithItsDensity) {
    Lit s;
    s.light(scene::LightKind::disk, {0, 1, 0}, {0.2, -1, 0.1}).radius = 0.8;
    expect_lights_density(s.emitters(), {0.3, 0, 0.1}, {normalize({-0.3, 1, 0}), 0.5});
}

TEST(Emitters, SphereIsSampledWithItsDensity) {
    Lit s;
    s.light(scene::LightKind::sphere, {1, 2, -1}).radius = 0.8;
    expect_lights_density(s.emitters(), {0, 0, 0}, {normalize({1, 2, -1}), std::sqrt(1 - 0.64 / 6) - 1e-3});
    expect_lights_density(s.emitters(), {1, 1.19, -1}, {{0, 1, 0}, 0.1});  // from just outside of it
}

TEST(Emitters, GroupIsSampledWithItsDensity) {
    Lit s;
    Random random(7);
    for (int i = 0; i < 40; ++i) {
        scene::Light& l = s.light(i % 3 == 0 ? scene::LightKind::rectangle : i % 3 == 1 ? scene::LightKind::disk : scene::LightKind::sphere,
                                  {random.uniform(-3, 3), random.uniform(1, 3), random.uniform(-3, 3)}, random.direction());
        l.width = 0.8, l.height = 0.6, l.radius = 0.3, l.group = "many", l.intensity = random.uniform(0.1, 3), l.two_sided = i % 2;
    }
    const Emitters e = s.emitters();
    ASSERT_EQ(e.groups(), 1u);
    EXPECT_EQ(e.scale(0), gray(1));
    // A chosen member may turn its back, or shine from both sides; what the density leaves is when the sample is nothing.
    const Vec3 from{0.1, 0.2, 0};
    int drawn = 0, all = 20000;
    for (int i = 0; i < all; ++i) drawn += e.sample(0, from, three(random)).has_value();
    EXPECT_GT(drawn, 0.9 * all) << "the hierarchy knows which way its members shine";
    expect_density(
        {{0, 1, 0}, -1.0, 24, 32},
        [&](Random& r) -> std::optional<Vec3> {
            const auto one = e.sample(0, from, three(r));
            return one ? std::optional(one->direction) : std::nullopt;
        },
        [&](Vec3 d) { return density(e, from, d); }, double(drawn) / all);
}

TEST(Emitters, EnvironmentIsSampledWithItsDensity) {
    Lit s;
    s.build.scene.environment.emplace();
    scene::Environment& sky = *s.build.scene.environment;
    sky.zenith = {0.2f, 0.5f, 2}, sky.horizon = {1, 0.2f, 0}, sky.nadir = {0, 0.01f, 0}, sky.strength = 0.5;
    const Emitters e = s.emitters();
    ASSERT_EQ(e.groups(), 1u);
    EXPECT_EQ(e.scale(0), gray(0.5f));
    expect_density({{0, 0, 1}, -1.0}, [&](Random& random) { return std::optional(e.sample(0, {}, three(random))->direction); },
                   [&](Vec3 d) { return e.environment(d)->pdf; });
    sky.horizon = {};  // black in a plane
    const Emitters dark = s.emitters();
    expect_density({{0, 0, 1}, -1.0}, [&](Random& random) { return std::optional(dark.sample(0, {}, three(random))->direction); },
                   [&](Vec3 d) { return dark.environment(d)->pdf; });
}

// What a sample tells is what a ray in its direction meets.
TEST(Emitters, RaysMeetWhatWasSampled) {
    Lit s;
    s.light(scene::LightKind::rectangle, {0, 2, 0}).width = 3;
    s.light(scene::LightKind::disk, {3, 2, 0}, {-1, -1, 0.3}).visible = false;
    s.light(scene::LightKind::sphere, {-3, 2, 0}).radius = 0.7;
    s.light(scene::LightKind::rectangle, {0, -2, 1}, {0, -1, 0}).two_sided = true;
    const Emitters e = s.emitters();
    ASSERT_EQ(e.groups(), 4u);
    Random random(3);
    std::vector<Emitted> met;
    for (int i = 0; i < 20000; ++i) {
        const Vec3 from = random.in_cube(1.5);
        const std::size_t group = random.below(4);
        const auto sample = e.sample(group, from, three(random));
        if (!sample) continue;
        EXPECT_NEAR(length(sample->direction), 1, 1e-12);
        met.clear();
        e.lights_on({from, sample->direction}, from, no_instance, [&](const Emitted& light) { met.push_back(light); });
        const auto one = std::find_if(met.begin(), met.end(), [&](const Emitted& m) { return m.group == group; });
        if (one == met.end()) {  // at the very edge
            met.clear();
            const Vec3 center = s.build.scene.lights[group].position - from;
            e.lights_on({from, normalize(normalize(sample->direction) * (1 - 1e-9) + normalize(center) * 1e-9)}, from, no_instance, [&](const Emitted& light) { met.push_back(light); });
            EXPECT_FALSE(met.empty());
            continue;
        }
        EXPECT_NEAR(one->distance, sample->distance, 1e-6 * sample->distance);
        EXPECT_NEAR(one->pdf, sample->pdf, 1e-6 * sample->pdf);
        EXPECT_EQ(one->radiance, sample->radiance);
        EXPECT_EQ(one->visible, group != 1);
    }
}

TEST(Emitters, LightsShineToTheFrontOnly) {
    Lit s;
    s.light(scene::LightKind::rectangle, {0, 0, 0});
    s.light(scene::LightKind::disk, {0, 0, 0});
    const Emitters e = s.emitters();
    for (std::size_t group = 0; group < 2; ++group) {
        EXPECT_TRUE(e.sample(group, {0, -1, 0}, {0.3, 0.6, 0.5}));
        EXPECT_FALSE(e.sample(group, {0, 1, 0}, {0.3, 0.6, 0.5}));
        EXPECT_FALSE(e.sample(group, {3, 0, 0}, {0.3, 0.6, 0.5})) << "in its plane";
    }
    std::vector<Emitted> met;
    e.lights_on({{0.1, 1, 0.1}, {0, -1, 0}}, {0.1, 1, 0.1}, no_instance, [&](const Emitted& light) { met.push_back(light); });
    EXPECT_TRUE(met.empty());
    e.lights_on({{0.1, -1, 0.1}, {0, 1, 0}}, {0.1, -1, 0.1}, no_instance, [&](const Emitted& light) { met.push_back(light); });
    EXPECT_EQ(met.size(), 2u);
    e.lights_on({{0.1, -1, 0.1}, {0, 1, 0}, 0, 0.9}, {0.1, -1, 0.1}, no_instance, [&](const Emitted& light) { met.push_back(light); });
    EXPECT_EQ(met.size(), 2u) << "out of the ray's bounds";
}

// Lambert's formula for a polygon: the sum over edges of their angle times the height of their plane's normal.
double rectangle_irradiance(const std::array<Vec3, 4>& corners, Vec3 point, Vec3 normal) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec3 a = normalize(corners[i] - point), b = normalize(corners[(i + 1) % 4] - point), n = cross(a, b);
        sum += std::atan2(length(n), dot(a, b)) * dot(n, normal) / length(n);
    }
    return std::abs(sum) / 2;
}

TEST(Irradiance, UnderARectangle) {
    Lit s;
    scene::Light& l = s.light(scene::LightKind::rectangle, {0.5, 1.2, 0});
    l.width = 1.4, l.height = 0.8, l.up = {0, 0, -1}, l.intensity = 5, l.color = {1, 0.5f, 0};
    const Emitters e = s.emitters();
    const std::array<Vec3, 4> corners{Vec3{-0.2, 1.2, -0.4}, Vec3{1.2, 1.2, -0.4}, Vec3{1.2, 1.2, 0.4}, Vec3{-0.2, 1.2, 0.4}};
    for (const Vec3 point : {Vec3{0, 0, 0}, Vec3{0.5, 1.1, 0}, Vec3{1, -2, 3}}) {
        const double expected = rectangle_irradiance(corners, point, {0, 1, 0}) * 5 / (1.4 * 0.8);
        const Rgb got = irradiance(e, 0, point, {0, 1, 0});
        EXPECT_NEAR(got.r, expected, 1e-4 * expected);
        EXPECT_NEAR(got.g, expected / 2, 1e-4 * expected);
        EXPECT_EQ(got.b, 0);
    }
}

TEST(Irradiance, UnderADisk) {
    Lit s;
    scene::Light& l = s.light(scene::LightKind::disk, {0, 1.5, 0});
    l.radius = 0.9, l.intensity = 4;
    // On the axis pi L r^2 / (r^2 + h^2), with L = intensity / (pi r^2).
    EXPECT_NEAR(irradiance(s.emitters(), 0, {}, {0, 1, 0}).r, 4 / (0.81 + 2.25), 1e-4);
    // Beside it, by the form factor from an element to a parallel disk (Howell, A Catalog of Radiation Heat Transfer Configuration Factors).
    const double h = 1.5, a = 0.7, r = 0.9, x = 1 + (h * h - r * r) / (a * a), y = 1 + (h * h + r * r) / (a * a);
    const double factor = 0.5 * (1 - x / std::sqrt(y * y - 4 * r * r / (a * a)));
    EXPECT_NEAR(irradiance(s.emitters(), 0, {a, 0, 0}, {0, 1, 0}).r, factor * 4 / (r * r), 2e-4);
}

TEST(Irradiance, UnderASphere) {
    Lit s;
    scene::Light& l = s.light(scene::LightKind::sphere, {0.5, 2, 0});
    l.intensity = 3;
    for (const double radius : {1e-6, 0.1, 0.9, 1.9}) {
        l.radius = radius;
        const double square = 0.25 + 4;  // as of a point light, while it is wholly above the plane
        EXPECT_NEAR(irradiance(s.emitters(), 0, {}, {0, 1, 0}).r, 3 / square * 2 / std::sqrt(square), 1e-4) << radius;
    }
}

TEST(Irradiance, OfAnEnvironmentIsAsInClosedForm) {
    Lit s;
    s.build.scene.environment.emplace();
    scene::Environment& sky = *s.build.scene.environment;
    sky.strength = 1;
    sky.zenith = sky.horizon = sky.nadir = {0.5f, 1, 2};
    const Rgb even = irradiance(s.emitters(), 0, {}, normalize({1, 2, 3}));
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(even[k], pi * (k == 0 ? 0.5 : k), 1e-3);
    sky.zenith = {0.2f, 0.5f, 2}, sky.nadir = {0, 0.01f, 0};
    const Emitters e = s.emitters();
    for (const Vec3 normal : {Vec3{0, 1, 0}, normalize({1, 2, 3}), Vec3{0, -1, 0}}) {
        const Rgb got = irradiance(e, 0, {}, normal, 1024), expected = s.world->environment.irradiance(normal) * static_cast<float>(pi);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], expected[k], 3e-3 * (1 + expected[k]));
    }
}

// A light that grows keeps its strength, and from afar is its centre.
TEST(Irradiance, FromAfarIsThatOfTheCenter) {
    for (const auto kind : {scene::LightKind::rectangle, scene::LightKind::disk, scene::LightKind::sphere}) {
        Lit s;
        scene::Light& l = s.light(kind, {40, 90, 10}, {-3, -10, -1});
        l.intensity = 1e4;
        const Emitters e = s.emitters();
        const Incident center = s.world->lights[0].at({});
        EXPECT_TRUE(s.world->lights[0].is_sampled());
        const double expected = center.strength.r * dot(center.to_light, {0, 1, 0});
        EXPECT_NEAR(irradiance(e, 0, {}, {0, 1, 0}).r, expected, 2e-4 * expected);
    }
}

TEST(Emitters, ManyLightsAddUp) {
    Lit s;
    Random random(11);
    for (int i = 0; i < 300; ++i) {
        scene::Light& l = s.light(i % 2 ? scene::LightKind::rectangle : scene::LightKind::sphere, random.in_cube(10), random.direction());
        l.width = 0.3, l.height = 0.4, l.radius = 0.2, l.intensity = random.uniform(0, 2), l.color = {1, static_cast<float>(random.uniform()), 0};
    }
    const Emitters e = s.emitters();
    ASSERT_EQ(e.groups(), 1u) << "as many lights are sampled together";
    double sum = 0, square = 0, expected = 0;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
        const auto one = e.sample(0, {}, three(random));
        if (!one) continue;
        const double value = std::max(0.0, one->direction.y) / one->pdf * one->radiance.r;
        sum += value, square += value * value;
    }
    for (const Light& light : s.world->lights) {  // from afar
        const Incident at = light.at({});
        expected += std::max(0.0, at.to_light.y) * at.strength.r;
    }
    const double mean = sum / n, error = std::sqrt((square / n - mean * mean) / n);
    EXPECT_LT(error, 0.01 * mean) << "lights are chosen by what they send";
    EXPECT_NEAR(mean, expected, 4 * error + 0.01 * expected);
}

TEST(Emitters, SamplesDoNotDependOnColorAndIntensity) {
    Lit s;
    s.light(scene::LightKind::rectangle, {0, 2, 0});
    s.light(scene::LightKind::sphere, {0, 2, 0});
    const Emitters before = s.emitters();
    s.build.scene.lights[0].intensity = 9, s.build.scene.lights[1].color = {0, 1, 0}, s.build.scene.lights[1].visible = false;
    Emitters now = s.emitters();
    EXPECT_TRUE(now.same_samples(0, before, 0) && now.same_samples(1, before, 1));
    EXPECT_FALSE(now.same_samples(0, before, 1));
    EXPECT_EQ(now.scale(0), gray(9));
    EXPECT_EQ(now.sample(0, {}, {0.2, 0.4, 0.6})->radiance, before.sample(0, {}, {0.2, 0.4, 0.6})->radiance);
    s.build.scene.lights[0].width = 1.5, s.build.scene.lights[1].shadows = false;
    now = s.emitters();
    EXPECT_FALSE(now.same_samples(0, before, 0));
    EXPECT_FALSE(now.same_samples(1, before, 1));
    EXPECT_FALSE(now.casts_shadows(1));
}

TEST(Emitters, LightsOfOneNameAreOneGroup) {
    Lit s;
    s.light(scene::LightKind::rectangle, {0, 2, 0}).group = "key";
    s.light(scene::LightKind::sphere, {1, 2, 0});
    s.light(scene::LightKind::disk, {2, 2, 0}).group = "key";
    s.light(scene::LightKind::point, {3, 2, 0});
    const Emitters e = s.emitters();
    EXPECT_EQ(e.groups(), 2u);
    s.build.scene.lights[0].shadows = false;
    const Problems problems = scene::validate(s.build.scene, "");
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].place, "/lights/2/shadows");
}

// Of emissive objects: a ray that goes where a sample says meets the object there, with the same density.
TEST(Emitters, ObjectsAreSampledWhereRaysMeetThem) {
    PhysicalMaterial glow;
    glow.emissive = {2, 3, 4};
    const geometry::Polygon quad{{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}}};
    geometry::Disk ring;
    ring.inner_radius = 0.4;
    const std::pair<const char*, geometry::Shape> shapes[] = {{"mesh", sphere_mesh(6, 8, 0.2)}, {"box", box({-1, -0.5, -0.7}, {0.5, 1, 1})},
                                                             {"disk", ring}, {"polygon", quad}, {"sphere", geometry::Sphere{0.8}}};
    for (const auto& [name, shape] : shapes) {
        for (const bool sides : {false, true}) {
            SCOPED_TRACE(std::string(name) + (sides ? " with two sides" : ""));
            glow.double_sided = sides;
            Lit s;
            const bool round = std::string(name) == "sphere";
            const Affine turn = Affine::translation({1, 4, 2}) * Affine::rotation({1, 2, 3}, 0.8);
            s.build.place(shape, s.build.material(glow), turn * (round ? Affine::scaling({1.5, 1.5, 1.5}) : Affine::scaling({1.5, -0.7, 1.1})));
            const Emitters e = s.emitters();
            ASSERT_EQ(e.groups(), 1u);
            EXPECT_EQ(e.scale(0), (Rgb{2, 3, 4}));
            Random random(5);
            int checked = 0, hidden = 0;
            accel::TestCounts counts;
            for (int i = 0; i < 3000; ++i) {
                const Vec3 from = turn.origin + random.direction() * random.uniform(2.5, 5);
                const auto sample = e.sample(0, from, three(random));
                if (!sample) continue;
                const geometry::Ray ray{from, sample->direction};
                accel::Hit hit;
                s.world->accelerator->nearest({&ray, 1}, {&hit, 1}, accel::Coherence::incoherent, counts);
                ASSERT_TRUE(hit.found()) << "nothing where a sample is";
                if (hit.t < sample->distance * (1 - 1e-6)) {  // behind another part of the object
                    ++hidden;
                    continue;
                }
                const auto seen = e.surface(0, hit.primitive, s.world->material(0, 0), ray.at(hit.t), from);
                ASSERT_TRUE(seen);
                EXPECT_NEAR(hit.t, sample->distance, 1e-6 * hit.t);
                EXPECT_NEAR(seen->pdf, sample->pdf, 1e-6 * sample->pdf);
                EXPECT_EQ(seen->radiance, gray(1));
                ++checked;
            }
            EXPECT_GT(checked, sides ? 800 : 500) << hidden << " hidden";
        }
    }
}

TEST(Emitters, ObjectWithoutASamplerIsFoundByRaysOnly) {
    PhysicalMaterial glow;
    glow.emissive = {2, 3, 4};
    Lit s;
    s.build.place(geometry::Torus{}, s.build.material(glow));
    s.build.place(box({-9, -9, -9}, {9, -8, 9}), s.build.material(PhysicalMaterial{}));
    const Emitters e = s.emitters();
    ASSERT_EQ(e.groups(), 1u);
    EXPECT_FALSE(e.sample(0, {0, 5, 0}, {0.5, 0.5, 0.5}));
    const auto seen = e.surface(0, 0, s.world->material(0, 0), {1.25, 0, 0}, {5, 0, 0});
    ASSERT_TRUE(seen);
    EXPECT_EQ(seen->pdf, 0);
    EXPECT_EQ(seen->radiance * e.scale(seen->group), (Rgb{2, 3, 4}));
    EXPECT_FALSE(e.surface(1, 0, s.world->material(1, 0), {0, -8, 0}, {5, 0, 0}));
}

TEST(Emitters, AmbientLightsNothing) {
    ClassicMaterial m = matte(gray(0.5f));
    m.ambient = gray(1);
    Lit s;
    s.build.place(geometry::Sphere{}, s.build.material(m));
    EXPECT_EQ(s.emitters().groups(), 0u);
}

}  // namespace
}  // namespace crescente::render::testing
