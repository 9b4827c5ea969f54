// Laws 6 and 7: the first picture is whole, it only gets better, and a stop waits for one quantum of work at most.
#include <atomic>
#include <thread>

#include "render/level.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

// A lamp around everything: no ray finds darkness.
scene::Scene bright_room() {
    Build s(150, 90);
    s.settings().supersampling = 1, s.settings().depth = 3, s.settings().tile = 32;
    ClassicMaterial wall = glow({0.4f, 0.3f, 0.2f});
    wall.reflection = {0.2f, 0.2f, 0.2f};
    s.place(box({-9, -9, -9}, {9, 9, 9}), s.material(wall));
    ClassicMaterial ball = glow({0.1f, 0.2f, 0.5f});
    ball.diffuse = {0.5f, 0.5f, 0.5f}, ball.transmission = {0.3f, 0.3f, 0.3f}, ball.ior = 1.4;
    const MaterialId id = s.material(ball);
    for (int i = 0; i < 9; ++i) s.place(sphere(0.4), id, at({i % 3 - 1.0, i / 3 - 1.0, 0}));
    s.steady_light({3, 5, 6}, {0.4f, 0.4f, 0.4f});
    return s.scene;
}

TEST(FirstPicture, IsWholeAndOnlyGetsBetter) {
    for (int variant = 0; variant < 12; ++variant) {
        SCOPED_TRACE(variant);
        scene::Scene scene = bright_room();
        scene.settings.threads = 1 + variant % 2;
        scene.settings.order = variant & 2 ? scene::Order::tiles : scene::Order::even;
        if (variant >= 4) scene.settings.keep = false;
        if (variant >= 8) scene.settings.memory = 400'000;
        Session session = opened(scene);
        Random random(static_cast<std::uint64_t>(variant));
        double fraction = 0;
        bool first = false;
        Progress progress;
        int pictures = 0;
        for (int calls = 0; !progress.done; ++calls) {
            ASSERT_LT(calls, 100'000) << "no progress";
            progress = session.advance(Deadline::in(std::chrono::microseconds(first ? random.below(400) : 20)));
            ASSERT_GE(progress.fraction, fraction);
            ASSERT_LE(progress.fraction, 1);
            ASSERT_TRUE(progress.first_picture || !first) << "a whole picture stays whole";
            fraction = progress.fraction, first = progress.first_picture;
            if (calls % 5 && !(first && pictures == 0)) continue;
            const scene::Image picture = session.picture(pictures % 4 == 3);
            for (const float v : picture.layers[0].values) {
                ASSERT_TRUE(std::isfinite(v));
                ASSERT_TRUE(!first || v > 0.09f) << "a hole";
            }
            pictures += first;
        }
        EXPECT_EQ(progress.fraction, 1);
        EXPECT_TRUE(progress.first_picture);
        EXPECT_GT(pictures, 1);
    }
}

TEST(Stop, SetBeforeNothingIsTraced) {
    for (const int threads : {1, 2}) {
        scene::Scene scene = bright_room();
        scene.settings.threads = threads;
        Session session = opened(scene);
        const std::atomic<bool> stop = true;
        Deadline deadline;
        deadline.stop = &stop;
        const Progress progress = session.advance(deadline);
        EXPECT_FALSE(progress.done);
        EXPECT_EQ(session.stats().rays.total(), 0u);
        EXPECT_EQ(session.advance(Deadline::in(std::chrono::seconds(-1))).fraction, 0);
        EXPECT_EQ(session.stats().rays.total(), 0u);
        EXPECT_TRUE(session.advance(Deadline::never()).done);
    }
}

// Every level, told to stop from the start, comes back after one chunk, and goes on from there to the very same trees.
void expect_small_quanta(const scene::Scene& scene, std::uint64_t most) {
    auto world = world_of(scene);
    ASSERT_TRUE(world);
    Tile stopped, straight;
    for (Tile* t : {&stopped, &straight}) t->width = 48, t->height = 40;
    const std::atomic<bool> stop = true;
    Deadline now;
    now.stop = &stop;
    Growth a(**world, stopped, false), b(**world, straight, false);
    for (const LevelKind& kind : levels()) {
        for (const Stage& stage : kind.stages(scene.settings)) {
            SCOPED_TRACE(std::string(kind.name) + " " + std::to_string(stage.parameter));
            std::uint64_t most_seen = 0, before = stopped.rays.total();
            int calls = 0;
            for (bool done = false; !done; ++calls) {
                ASSERT_LT(calls, 100'000) << "no progress";
                done = kind.advance(a, stage, now);
                most_seen = std::max(most_seen, stopped.rays.total() - before);
                before = stopped.rays.total();
            }
            EXPECT_LE(most_seen, most);
            EXPECT_TRUE(kind.advance(b, stage, Deadline::never()));
            for (Tile* t : {&stopped, &straight}) t->cursor = 0, ++t->stage;
            ASSERT_EQ(stopped.nodes.size(), straight.nodes.size());
            const std::vector<Rgb> x = radiances(stopped), y = radiances(straight);
            EXPECT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(Rgb)), 0);
        }
    }
    EXPECT_GT(stopped.rays.total(), 4 * most) << "too little work to tell";
}

TEST(Stop, WaitsForOneChunk) {
    scene::Scene scene = still_life();
    scene.settings.width = 48, scene.settings.height = 40;
    // A chunk is 256 rays (320 where pixels are split), each with a shadow ray for each light.
    expect_small_quanta(scene, 320 * (1 + scene.lights.size()));
}

TEST(Stop, WaitsForOneChunkInAHallOfMirrors) {
    Build s(48, 40);
    s.settings().supersampling = 2, s.settings().threshold = 0, s.settings().depth = 7;
    ClassicMaterial crystal = glow({0.2f, 0.1f, 0.3f});
    crystal.reflection = {0.5f, 0.5f, 0.5f}, crystal.transmission = {0.5f, 0.5f, 0.5f}, crystal.ior = 1.1;
    const MaterialId id = s.material(crystal);
    for (int i = 0; i < 12; ++i) s.place(box({-0.4, -0.4, -0.4}, {0.4, 0.4, 0.4}), id, at({i % 3 - 1.0, i / 3 % 2 - 0.5, i / 6 * -1.0}) * Affine::rotation({1, 1, 0}, i));
    s.steady_light({3, 3, 5});
    expect_small_quanta(s.scene, 320 * 2);
}

TEST(Stop, FromAnotherThread) {
    scene::Scene scene = bright_room();
    const scene::Image reference = picture_of(scene);
    scene.settings.threads = 2;
    Session session = opened(scene);
    bool done = false;
    for (int i = 0; i < 1000 && !done; ++i) {
        std::atomic<bool> stop = false;
        Deadline deadline;
        deadline.stop = &stop;
        std::thread other([&] { stop = true; });
        done = session.advance(deadline).done;
        other.join();
    }
    session.advance(Deadline::never());
    EXPECT_TRUE(same_picture(reference, session.picture()));
}

}  // namespace
}  // namespace crescente::render::testing
