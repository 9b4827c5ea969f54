// Corners of parts of pixels that wait for their samples.
#include <algorithm>
#include <cmath>

#include "render/film.h"
#include "render/level.h"
#include "render/scenes.h"
#include "render/stand_ins.h"

namespace crescente::render::testing {
namespace {

// A pixel of four parts, whose left half is of one surface and right half of another, with samples of its own corners alone.
Tile split_pixel() {
    Tile tile;
    tile.width = tile.height = 1;
    tile.nodes.resize(9);
    for (std::uint32_t i = 0; i < 9; ++i) {  // corners, then middles: top, left, centre, right, bottom
        Node& node = tile.nodes[i];
        const bool right = i == 1 || i == 3 || i == 7;
        node.instance = right ? 1 : 0;
        node.normal = {0, 0, 1};
        node.local = i < 4 ? gray(right ? 10 : static_cast<float>(1 + i)) : gray(100);
        node.sampled = i < 4;
        tile.samples.push_back(i < 4 ? 1 : 0);
    }
    tile.corners = {0, 1, 2, 3};
    tile.quads = {{{0, 1, 2, 3}, 1}, {{0, 4, 5, 6}, no_node}, {{4, 1, 6, 7}, no_node}, {{5, 6, 2, 8}, no_node}, {{6, 7, 8, 3}, no_node}};
    return tile;
}

TEST(StandIns, AreOfTheSameSurface) {
    // The left corners say 1 and 3, the right ones 10: the middle column, and that of the left, are 2. Each root counts by how many parts it is a corner of.
    EXPECT_FLOAT_EQ(develop(split_pixel())[0].g, (1 + 10 + 3 + 10 + 2 * (2 + 2 + 10 + 2) + 4 * 2) / 16.0f);
}

TEST(StandIns, SayWhatIsBrighterAtTheRoot) {
    Tile tile = split_pixel();
    tile.unsampled.assign(9, gray(1));
    tile.unsampled[6] = gray(2), tile.unsampled[7] = gray(1000);  // the centre is twice as bright; four times is the most that is believed
    EXPECT_FLOAT_EQ(develop(tile)[0].g, (1 + 10 + 3 + 10 + 2 * (2 + 2 + 40 + 2) + 4 * 4) / 16.0f);
}

TEST(StandIns, HaveSamplesThemselves) {
    Tile tile = split_pixel();
    tile.nodes[1].sampled = tile.nodes[3].sampled = false;  // in a round that goes on
    EXPECT_FLOAT_EQ(develop(tile)[0].g, (1 + 10 + 3 + 10 + 2 * (2 + 2 + 100 + 2) + 4 * 2) / 16.0f);
}

TEST(StandIns, MirrorTheSame) {
    Tile tile = split_pixel();
    tile.nodes.resize(12);
    for (std::uint32_t i = 9; i < 12; ++i) tile.nodes[i].instance = 5, tile.nodes[i].normal = {0, 1, 0};
    const auto mirrors = [&](std::uint32_t root, std::uint32_t child) { tile.nodes[root].reflected = child, tile.nodes[child].parent = root; };
    mirrors(0, 9), mirrors(2, 10), mirrors(6, 11);
    const auto ways = [&](std::uint32_t i) { return Smooth{!tile.nodes[i].samples_reflection, true}; };
    EXPECT_TRUE(see_the_same(tile, 6, 0, ways));
    EXPECT_FALSE(see_the_same(tile, 4, 0, ways));  // nothing is mirrored at the top
    tile.nodes[11].instance = 6;
    EXPECT_FALSE(see_the_same(tile, 6, 0, ways));
    tile.nodes[0].samples_reflection = true;  // its ray stands for a rough lobe
    EXPECT_TRUE(see_the_same(tile, 6, 0, ways));
}

double error_of(const std::vector<Rgb>& picture, const std::vector<Rgb>& wanted) {
    double sum = 0;
    for (std::size_t i = 0; i < picture.size(); ++i) {
        const Rgb d = picture[i] - wanted[i];
        sum += double(d.r) * d.r + double(d.g) * d.g + double(d.b) * d.b;
    }
    return std::sqrt(sum);
}

// Round by round: early ones leave corners out, whose pixels are the better for what stands in; the last leaves none out.
TEST(StandIns, UntilAllHaveSamples) {
    scene::Scene scene = still_life();
    scene.settings.level = scene::Level::soft, scene.settings.samples = 64, scene.settings.noise = 0.0001;
    scene.settings.tile = 75;
    scene.lights.resize(1);
    scene.lights[0] = {};
    scene.lights[0].kind = scene::LightKind::sphere, scene.lights[0].position = {2, 5, 4}, scene.lights[0].radius = 1.5, scene.lights[0].intensity = 40;
    const auto world = world_of(std::move(scene)).value();
    Tile tile;
    tile.width = world->scene.settings.width, tile.height = world->scene.settings.height;
    struct Round {
        std::size_t waiting;
        std::vector<Rgb> picture, without;
    };
    std::vector<Round> rounds;
    Growth growth(*world, tile, false);
    for (const Stage& stage : stages_of(world->scene.settings)) {
        ASSERT_TRUE(std::find_if(levels().begin(), levels().end(), [&](const LevelKind& kind) { return kind.level == stage.level; })->advance(growth, stage, Deadline::never()));
        tile.cursor = 0, ++tile.stage;
        if (stage.level != scene::Level::soft) continue;
        std::vector<std::uint32_t> roots;
        for (const Quad& quad : tile.quads) roots.insert(roots.end(), quad.corners.begin(), quad.corners.end());
        std::sort(roots.begin(), roots.end());
        roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
        const auto waits = [&](std::uint32_t root) { return !tile.nodes[root].left_scene() && tile.samples[root] == 0; };
        Tile without = tile;
        without.samples.clear();
        rounds.push_back({static_cast<std::size_t>(std::count_if(roots.begin(), roots.end(), waits)), develop(tile), develop(without)});
    }
    ASSERT_GE(rounds.size(), 4u);
    const std::vector<Rgb>& wanted = rounds.back().picture;
    EXPECT_GT(rounds[0].waiting, 1000u);
    EXPECT_LT(error_of(rounds[0].picture, wanted), 0.9 * error_of(rounds[0].without, wanted));
    EXPECT_LT(rounds[1].waiting, rounds[0].waiting);
    EXPECT_LT(error_of(rounds[1].picture, wanted), 0.9 * error_of(rounds[1].without, wanted));
    EXPECT_EQ(rounds.back().waiting, 0u);
    EXPECT_EQ(rounds.back().picture, rounds.back().without);
    EXPECT_TRUE(tile.unsampled.empty());
}

}  // namespace
}  // namespace crescente::render::testing
