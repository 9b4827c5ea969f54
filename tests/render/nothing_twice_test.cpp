// Law 2: a level starts from what the level before left; nothing is traced twice. And the rays are as many as are due.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Level;

void expect_equal(const RayCounts& a, const RayCounts& b) {
    EXPECT_EQ(a.camera, b.camera);
    EXPECT_EQ(a.reflected, b.reflected);
    EXPECT_EQ(a.refracted, b.refracted);
    EXPECT_EQ(a.shadow, b.shadow);
}

TEST(NothingTwice, CameraRaysOfOneTileAreItsCorners) {
    scene::Scene scene = still_life();
    scene.settings.tile = 4096;
    scene.settings.level = Level::visible;
    const RayCounts rays = finished(scene).stats().rays;
    EXPECT_EQ(rays.camera, 76u * 54u);
    EXPECT_EQ(rays.total(), rays.camera);
    scene.settings.level = Level::reflections;
    EXPECT_EQ(finished(scene).stats().rays.camera, 76u * 54u);
}

TEST(NothingTwice, TilesRepeatTheirBorderOnly) {
    scene::Scene scene = still_life();  // 75 x 53 in tiles of 32: 32, 32, 11 by 32, 21
    scene.settings.level = Level::visible;
    EXPECT_EQ(finished(scene).stats().rays.camera, (33u + 33u + 12u) * (33u + 22u));
}

// What a level adds in a session of all levels is what a render to that level traces beyond a render to the level below.
TEST(NothingTwice, LevelsAddUp) {
    for (scene::Scene scene : {still_life(), instances()}) {
        const Stats all = finished(scene).stats();
        ASSERT_EQ(all.levels.size(), 4u);
        RayCounts sum;
        std::uint64_t nodes = 0;
        for (std::size_t l = 0; l < 4; ++l) {
            SCOPED_TRACE(l);
            sum += all.levels[l].rays;
            scene.settings.level = static_cast<Level>(l);
            const Stats direct = finished(scene).stats();
            expect_equal(sum, direct.rays);
            EXPECT_GT(direct.nodes, nodes) << (l == 1 ? "" : "a level that grows nothing proves nothing");
            nodes = l == 0 ? direct.nodes - 1 : direct.nodes;
            EXPECT_EQ(direct.nodes, direct.rays.camera + direct.rays.reflected + direct.rays.refracted);
        }
        expect_equal(all.rays, sum);
    }
}

TEST(NothingTwice, OrderAndKeepingTraceTheSame) {
    for (scene::Scene scene : {still_life(), instances(), coincident()}) {
        const RayCounts reference = finished(scene).stats().rays;
        EXPECT_GT(reference.shadow, 0u);
        EXPECT_GT(reference.reflected, 0u);
        scene.settings.order = scene::Order::tiles;
        expect_equal(finished(scene).stats().rays, reference);
        scene.settings.keep = false;
        expect_equal(finished(scene).stats().rays, reference);
        scene.settings.threads = 3;
        expect_equal(finished(scene).stats().rays, reference);
        scene.settings.accelerator = scene::AcceleratorKind::kay_kajiya;
        expect_equal(finished(scene).stats().rays, reference);
    }
}

TEST(NothingTwice, DoneIsDone) {
    Session session = finished(still_life());
    const RayCounts rays = session.stats().rays;
    EXPECT_TRUE(session.advance(Deadline::never()).done);
    session.picture(true);
    session.describe(10, 10);
    expect_equal(session.stats().rays, rays);
}

// The rays that the Standard Procedural Databases' own notes count for 513 x 513 corner rays, to 1 % (Haines 1987, "A Proposal for
// Standard Graphics Environments", and the notes of the package).
struct Published {
    const char* name;
    double reflected, refracted, shadow;
};
class SpdCounts : public ::testing::TestWithParam<Published> {};
TEST_P(SpdCounts, AsPublished) {
    const Published& p = GetParam();
    if (!std::filesystem::exists(spd_file(p.name))) GTEST_SKIP() << spd_file(p.name) << " is not here";
    auto loaded = io::read_scene(spd_file(p.name));
    ASSERT_TRUE(loaded) << loaded.error().text();
    scene::Settings& s = loaded->scene.settings;
    s.width = s.height = 512, s.tile = 512, s.depth = 4, s.threshold = 0, s.level = Level::reflections, s.threads = 1;
    const RayCounts rays = finished(loaded->scene).stats().rays;
    EXPECT_EQ(rays.camera, 513u * 513u);
    EXPECT_NEAR(double(rays.reflected), p.reflected, p.reflected / 100);
    EXPECT_NEAR(double(rays.refracted), p.refracted, p.refracted / 100);
    EXPECT_NEAR(double(rays.shadow), p.shadow, p.shadow / 100);
}
INSTANTIATE_TEST_SUITE_P(Files, SpdCounts,
                         ::testing::Values(Published{"balls4", 175'095, 0, 954'368}, Published{"mount6", 354'769, 354'769, 412'922},
                                           Published{"teapot12", 225'248, 0, 407'656}, Published{"tetra6", 0, 0, 46'112}),
                         [](const auto& row) { return std::string(row.param.name); });

}  // namespace
}  // namespace crescente::render::testing
