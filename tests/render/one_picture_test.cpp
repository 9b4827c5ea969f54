// Law 1: for given scene, settings and level there is one picture, to the bit.
#include <atomic>
#include <thread>

#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Settings;

struct Variation {
    const char* name;
    std::function<void(Settings&)> change;
};

// What must never change a pixel.
const Variation variations[] = {
    {"two threads", [](Settings& s) { s.threads = 2; }},
    {"three threads", [](Settings& s) { s.threads = 3; }},
    {"tile after tile", [](Settings& s) { s.order = scene::Order::tiles; }},
    {"tile after tile, two threads", [](Settings& s) { s.order = scene::Order::tiles, s.threads = 2; }},
    {"trees not kept", [](Settings& s) { s.keep = false; }},
    {"trees not kept, tile after tile", [](Settings& s) { s.keep = false, s.order = scene::Order::tiles, s.threads = 2; }},
    {"one byte of memory", [](Settings& s) { s.memory = 1; }},
    {"one byte of memory, tile after tile", [](Settings& s) { s.memory = 1, s.order = scene::Order::tiles; }},
    {"300 kB of memory", [](Settings& s) { s.memory = 300'000; }},
    {"300 kB of memory, small tiles", [](Settings& s) { s.memory = 300'000, s.tile = 16, s.threads = 2; }},
    {"100 MB of memory", [](Settings& s) { s.memory = 100'000'000; }},
    {"tiles of 16", [](Settings& s) { s.tile = 16; }},
    {"tiles of 17", [](Settings& s) { s.tile = 17; }},
    {"tiles of 64", [](Settings& s) { s.tile = 64; }},
    {"one tile", [](Settings& s) { s.tile = 4096; }},
    {"brute force", [](Settings& s) { s.accelerator = scene::AcceleratorKind::linear; }},
    {"Kay-Kajiya", [](Settings& s) { s.accelerator = scene::AcceleratorKind::kay_kajiya; }},
    {"Kay-Kajiya, bare", [](Settings& s) { s.accelerator = scene::AcceleratorKind::kay_kajiya, s.octant_rejection = s.priority_queue = false; }},
    {"the other shadow cache", [](Settings& s) { s.shadow_cache = !s.shadow_cache; }},
    {"shadow cache, two threads", [](Settings& s) { s.shadow_cache = true, s.threads = 2; }},
    {"shadow cache, Kay-Kajiya", [](Settings& s) { s.shadow_cache = true, s.accelerator = scene::AcceleratorKind::kay_kajiya; }},
    {"shadow cache, brute force, one tile", [](Settings& s) { s.shadow_cache = true, s.accelerator = scene::AcceleratorKind::linear, s.tile = 4096; }},
    {"sub-pixel shortcut", [](Settings& s) { s.subpixel_shortcut = scene::SubpixelShortcut::exact; }},
    {"sub-pixel shortcut, Kay-Kajiya", [](Settings& s) { s.subpixel_shortcut = scene::SubpixelShortcut::exact, s.accelerator = scene::AcceleratorKind::kay_kajiya; }},
};

void expect_one_picture(const scene::Scene& scene) {
    const scene::Image reference = finished(scene).picture(true);
    float low = 1e9f, high = -1e9f;
    for (const float v : reference.layers[0].values) low = std::min(low, v), high = std::max(high, v);
    ASSERT_GT(high, low + 0.05f) << "an empty picture proves nothing";
    for (const Variation& v : variations) {
        SCOPED_TRACE(v.name);
        scene::Scene other = scene;
        v.change(other.settings);
        EXPECT_TRUE(same_picture(reference, finished(other).picture(true)));
    }
}

// Nodes of a small scene through a lens, some of them moving.
TEST(OnePicture, ThroughALens) {
    scene::Scene scene = instances();
    scene.settings.width = 40, scene.settings.height = 30, scene.settings.tile = 24;
    scene.settings.level = scene::Level::soft, scene.settings.samples = 20, scene.settings.noise = 0.2;
    scene.camera->aperture = 0.3, scene.camera->travel = {0.1, 0, 0};
    scene.nodes[0].motion = at({0, 0.4, 0});
    expect_one_picture(scene);
    PhysicalMaterial catcher;
    catcher.catcher = true, catcher.roughness = 0.3;
    scene.materials[0].model = catcher;
    if (!scene.environment) scene.environment.emplace();
    scene.environment->transparent = true;
    expect_one_picture(scene);
}

TEST(OnePicture, StillLife) { expect_one_picture(still_life()); }
TEST(OnePicture, Instances) { expect_one_picture(instances()); }
TEST(OnePicture, SurfacesInOneAnother) { expect_one_picture(coincident()); }

// Three children of a node, a camera in a medium, surfaces with one side.
TEST(OnePicture, CoverageMediaAndSides) {
    scene::Scene scene = still_life();
    scene.settings.width = 45, scene.settings.height = 34, scene.settings.tile = 20;
    for (scene::Material& material : scene.materials) {
        auto* m = std::get_if<PhysicalMaterial>(&material.model);
        if (!m) continue;
        m->double_sided = false;
        if (m->metallic == 0) m->transmission = 0.7, m->attenuation = {0.8f, 0.2f, 0.4f};
    }
    ClassicMaterial fog = glass({1, 1, 1}, 1);
    fog.attenuation = {0.02f, 0.03f, 0.01f};
    scene.materials.push_back({"fog", fog});
    scene.shapes.push_back({"fog", sphere(30)});
    scene.nodes.push_back({"fog", {}, {static_cast<std::uint32_t>(scene.shapes.size() - 1)}, {{static_cast<std::uint32_t>(scene.materials.size() - 1)}}, {}, true});
    scene.roots.push_back({static_cast<std::uint32_t>(scene.nodes.size() - 1)});
    expect_one_picture(scene);
}

TEST(OnePicture, EveryLevel) {
    for (const scene::Level level : {scene::Level::visible, scene::Level::shadows, scene::Level::reflections}) {
        scene::Scene scene = still_life();
        scene.settings.level = level;
        expect_one_picture(scene);
    }
}

// Light with extent, samples that do not suffice, and what is shown of them.
TEST(OnePicture, Samples) {
    scene::Scene scene = still_life();
    scene.settings.width = 45, scene.settings.height = 34, scene.settings.tile = 20, scene.settings.supersampling = 1;
    scene.settings.level = scene::Level::indirect, scene.settings.samples = 5;
    scene::Light lamp;
    lamp.kind = scene::LightKind::rectangle, lamp.position = {-2, 4, 3}, lamp.direction = {0.4, -1, -0.5}, lamp.intensity = 15;
    scene.lights.push_back(lamp);
    expect_one_picture(scene);
}

class OnePictureOfFile : public ::testing::TestWithParam<const char*> {};
TEST_P(OnePictureOfFile, Same) {
    if (!std::filesystem::exists(spd_file(GetParam()))) GTEST_SKIP() << spd_file(GetParam()) << " is not here";
    auto loaded = io::read_scene(spd_file(GetParam()));
    ASSERT_TRUE(loaded) << loaded.error().text();
    scene::Settings& s = loaded->scene.settings;
    s.width = s.height = 72, s.tile = 32, s.depth = 4, s.threads = 1, s.supersampling = 1;
    const scene::Image reference = finished(loaded->scene).picture();
    for (const Variation& v : variations) {
        scene::Scene other = loaded->scene;
        v.change(other.settings);
        if (other.settings.accelerator == scene::AcceleratorKind::linear) continue;  // too many parts for brute force
        SCOPED_TRACE(v.name);
        EXPECT_TRUE(same_picture(reference, finished(other).picture()));
    }
}
INSTANTIATE_TEST_SUITE_P(Spd, OnePictureOfFile, ::testing::Values("balls4", "mount6", "teapot12", "tetra6"));

// Stopped again and again, by the clock and by another thread, with a look at the picture in between.
void interrupt(Session& session, std::uint64_t seed) {
    Random random(seed);
    Progress progress;
    for (int calls = 0; !progress.done; ++calls) {
        ASSERT_LT(calls, 200'000) << "no progress";
        if (random.chance(0.2)) {
            std::atomic<bool> stop = false;
            Deadline deadline;
            deadline.stop = &stop;
            std::thread stopper([&] { stop = true; });
            progress = session.advance(deadline);
            stopper.join();
        } else {
            progress = session.advance(Deadline::in(std::chrono::microseconds(random.below(201))));
        }
        if (random.chance(0.05)) session.picture(random.chance(0.3));
        if (random.chance(0.02)) session.describe(3, 3);
    }
}

TEST(OnePicture, HoweverOftenInterrupted) {
    for (const auto& scene : {still_life(), instances(), coincident()}) {
        const scene::Image reference = finished(scene).picture(true);
        const RayCounts rays = finished(scene).stats().rays;
        for (std::uint64_t seed = 0; seed < 8; ++seed) {
            SCOPED_TRACE(seed);
            scene::Scene other = scene;
            other.settings.threads = 1 + static_cast<int>(seed % 3);
            other.settings.order = seed & 1 ? scene::Order::tiles : scene::Order::even;
            other.settings.keep = !(seed & 2);
            if (seed & 4) other.settings.subpixel_shortcut = scene::SubpixelShortcut::exact;
            Session session = opened(other);
            interrupt(session, seed);
            EXPECT_TRUE(same_picture(reference, session.picture(true)));
            EXPECT_EQ(session.stats().rays.camera, rays.camera);
            EXPECT_EQ(session.stats().rays.reflected, rays.reflected);
            EXPECT_EQ(session.stats().rays.refracted, rays.refracted);
            EXPECT_EQ(session.stats().rays.shadow, rays.shadow);
        }
    }
}

// With a ceiling that a single tile breaks, and quanta far shorter than a tile takes, the work still ends.
TEST(OnePicture, HoweverOftenInterruptedWithLittleMemory) {
    for (const auto& scene : {still_life(), instances()}) {
        const scene::Image reference = finished(scene).picture(true);
        for (std::uint64_t seed = 0; seed < 8; ++seed) {
            SCOPED_TRACE(seed);
            scene::Scene other = scene;
            other.settings.threads = 1 + static_cast<int>(seed % 2);
            other.settings.order = seed & 2 ? scene::Order::tiles : scene::Order::even;
            other.settings.memory = seed & 1 ? 1 : 400'000;
            other.settings.keep = !(seed & 4);
            Session session = opened(other);
            interrupt(session, seed);
            EXPECT_TRUE(same_picture(reference, session.picture(true)));
        }
    }
}

}  // namespace
}  // namespace crescente::render::testing
