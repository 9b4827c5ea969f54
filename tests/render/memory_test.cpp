// Law 4: memory has a ceiling; what was dropped is recomputed when it is asked for, and nobody can tell.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

scene::Scene small_tiles() {
    scene::Scene scene = still_life();
    scene.settings.tile = 16;
    return scene;
}

TEST(Memory, KeptBytesStayUnderTheCeiling) {
    const Stats unlimited = finished(small_tiles()).stats();
    EXPECT_EQ(unlimited.dropped_tiles, 0u);
    const std::uint64_t pixels = 75 * 53 * 12, tiles = 5 * 4;
    for (const std::uint64_t share : {1u, 2u, 3u, 8u, 1000u}) {
        for (const scene::Order order : {scene::Order::even, scene::Order::tiles}) {
            for (const int threads : {1, 2}) {
                SCOPED_TRACE(share);
                scene::Scene scene = small_tiles();
                const std::uint64_t ceiling = unlimited.forest_bytes * 9 / 10 / share;
                scene.settings.memory = static_cast<std::int64_t>(ceiling), scene.settings.order = order, scene.settings.threads = threads;
                const Stats stats = finished(scene).stats();
                EXPECT_LE(stats.forest_bytes, std::max(ceiling, pixels + 64 * tiles));
                EXPECT_GT(stats.dropped_tiles, 0u);
            }
        }
    }
}

TEST(Memory, AnAmpleCeilingDropsNothing) {
    scene::Scene scene = small_tiles();
    scene.settings.memory = static_cast<std::int64_t>(finished(scene).stats().peak_forest_bytes * 5 / 4);  // rounds under a ceiling are other ones
    EXPECT_EQ(finished(scene).stats().dropped_tiles, 0u);
}

TEST(Memory, DroppedTreesAreDescribedAsKeptOnes) {
    Session kept = finished(small_tiles());
    scene::Scene scene = small_tiles();
    scene.settings.memory = 1;
    Session dropped = finished(scene);
    scene.settings.memory = 0, scene.settings.keep = false, scene.settings.order = scene::Order::tiles;
    Session given_up = finished(scene);
    EXPECT_GT(dropped.stats().dropped_tiles, 0u);
    const RayCounts rays = dropped.stats().rays;
    EXPECT_TRUE(same_picture(kept.picture(true), dropped.picture(true)));
    EXPECT_TRUE(same_picture(kept.picture(true), given_up.picture(true)));
    for (int y = 0; y < 53; y += 4) {
        for (int x = 0; x < 75; x += 3) {
            const std::string text = kept.describe(x, y);
            EXPECT_NE(text.find("bottom right corner"), std::string::npos);
            EXPECT_EQ(text, dropped.describe(x, y));
            EXPECT_EQ(text, given_up.describe(x, y));
        }
    }
    EXPECT_EQ(dropped.stats().rays.total(), rays.total()) << "looking is not rendering";
    EXPECT_EQ(kept.describe(-1, 0), "");
    EXPECT_EQ(kept.describe(0, 53), "");
    EXPECT_EQ(kept.describe(75, 0), "");
}

}  // namespace
}  // namespace crescente::render::testing
