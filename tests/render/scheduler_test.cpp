// The scheduler is pure logic: it is tested without a scene.
#include "render/scheduler.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace crescente::render {
namespace {

TileState kept(int stage, std::uint64_t bytes = 0) { return {stage, stage, bytes}; }
TileState dropped(int shown, std::uint64_t bytes = 0) { return {0, shown, bytes}; }

// Plays an engine that reaches what it was asked, sometimes is interrupted, and sometimes loses trees.
void play(const Plan& plan, std::size_t count, std::uint64_t seed, double interruption, double loss) {
    std::mt19937_64 random(seed);
    const auto chance = [&](double p) { return double(random() >> 11) * 0x1p-53 < p; };
    std::vector<TileState> tiles(count);
    bool whole = false;
    for (int round = 0;; ++round) {
        ASSERT_LT(round, 100'000) << "never ends";
        const std::vector<Work> work = next_work(tiles, plan);
        if (work.empty()) break;
        ASSERT_LE(work.size(), plan.batch ? plan.batch : tiles.size());
        std::set<std::uint32_t> seen;
        int lowest = plan.stages;
        for (const TileState& t : tiles) {
            if (t.stage == t.shown_stage) lowest = std::min(lowest, t.stage);
        }
        for (const Work& w : work) {
            ASSERT_LT(w.tile, tiles.size());
            ASSERT_TRUE(seen.insert(w.tile).second) << "a tile twice in a round";
            const TileState& t = tiles[w.tile];
            ASSERT_LE(w.until, plan.stages);
            ASSERT_LT(t.shown_stage, plan.stages) << "finished tiles are left alone";
            ASSERT_GT(w.until, t.shown_stage) << "work that shows";
            ASSERT_GT(w.until, t.stage);
            if (!whole) {
                ASSERT_EQ(w.until, 1) << "the whole frame comes first";
            } else if (t.stage != t.shown_stage) {
                ASSERT_EQ(lowest, plan.stages) << "dropped tiles come last";
                ASSERT_EQ(w.until, plan.stages);
            } else if (plan.even) {
                ASSERT_EQ(t.stage, lowest);
                ASSERT_EQ(w.until, lowest + 1);
            } else {
                ASSERT_EQ(w.until, plan.stages);
            }
        }
        for (const Work& w : work) {
            TileState& t = tiles[w.tile];
            if (chance(interruption)) continue;
            t.stage = w.until;
            t.shown_stage = std::max(t.shown_stage, t.stage);
        }
        whole = whole || std::all_of(tiles.begin(), tiles.end(), [](const TileState& t) { return t.shown_stage > 0; });
        if (whole) {
            for (TileState& t : tiles) {
                if (chance(loss)) t.stage = 0;
            }
        }
    }
    for (const TileState& t : tiles) ASSERT_EQ(t.shown_stage, plan.stages);
}

TEST(NextWork, EveryTileReachesTheEnd) {
    for (const bool even : {true, false}) {
        for (const std::size_t batch : {0u, 1u, 3u, 100u}) {
            for (const std::size_t count : {1u, 2u, 17u}) {
                for (std::uint64_t seed = 0; seed < 5; ++seed) {
                    play({7, even, batch}, count, seed, 0, 0);
                    play({7, even, batch}, count, seed, 0.5, 0);
                    play({7, even, batch}, count, seed, 0.2, 0.2);
                }
            }
        }
    }
}

TEST(NextWork, NothingToDo) {
    EXPECT_TRUE(next_work({}, {4, true, 0}).empty());
    const std::vector<TileState> done{kept(4), dropped(4), kept(4)};
    EXPECT_TRUE(next_work(done, {4, true, 0}).empty());
    EXPECT_TRUE(next_work(done, {4, false, 2}).empty());
}

TEST(NextWork, EvenTakesAllTilesOfTheLowestStage) {
    const std::vector<TileState> tiles{kept(2), kept(1), kept(3), kept(1), dropped(1)};
    const auto work = next_work(tiles, {5, true, 0});
    ASSERT_EQ(work.size(), 2u);
    EXPECT_EQ(work[0].tile, 1u);
    EXPECT_EQ(work[1].tile, 3u);
    EXPECT_EQ(work[0].until, 2);
}

TEST(NextWork, TilesThatAreLookedAtComeFirst) {
    std::vector<TileState> tiles{kept(2), kept(1), kept(3), kept(1), kept(5)};
    tiles[0].distance = 7, tiles[1].distance = 9, tiles[3].distance = 4;  // 2 and 4 are looked at
    auto work = next_work(tiles, {5, true, 0});
    ASSERT_EQ(work.size(), 1u);
    EXPECT_EQ(work[0].tile, 2u);
    EXPECT_EQ(work[0].until, 4);
    tiles[2] = kept(5);  // done: then as always, the nearest first
    work = next_work(tiles, {5, true, 0});
    ASSERT_EQ(work.size(), 2u);
    EXPECT_EQ(work[0].tile, 3u);
    EXPECT_EQ(work[1].tile, 1u);
    tiles[0] = kept(0), tiles[0].distance = 7;  // the whole frame comes before
    work = next_work(tiles, {5, true, 0});
    ASSERT_EQ(work.size(), 1u);
    EXPECT_EQ(work[0].tile, 0u);
}

std::uint64_t bytes_after(std::vector<TileState> tiles, const std::vector<std::uint32_t>& drop, std::uint64_t floor) {
    for (const std::uint32_t i : drop) tiles[i].bytes = floor;
    std::uint64_t sum = 0;
    for (const TileState& t : tiles) sum += t.bytes;
    return sum;
}

TEST(TilesToDrop, FitUnderTheCeiling) {
    constexpr int stages = 6;
    constexpr std::uint64_t floor = 100;
    for (std::uint64_t seed = 0; seed < 2000; ++seed) {
        std::mt19937_64 random(seed);
        std::vector<TileState> tiles(1 + random() % 20);
        std::uint64_t total = 0, least = 0;
        for (TileState& t : tiles) {
            t.stage = static_cast<int>(random() % (stages + 1));
            t.shown_stage = std::max(t.stage, static_cast<int>(random() % (stages + 1)));
            t.under_way = random() % 8 == 0;
            t.bytes = random() % 3 ? floor + random() % 5000 : random() % 120;
            total += t.bytes;
            least += t.stage > 0 && !t.under_way ? std::min(t.bytes, floor) : t.bytes;
        }
        const std::uint64_t ceiling = random() % (total + 100);
        const auto drop = tiles_to_drop(tiles, stages, ceiling, floor);
        const std::set<std::uint32_t> chosen(drop.begin(), drop.end());
        ASSERT_EQ(chosen.size(), drop.size()) << "a tile twice";
        if (total <= ceiling) {
            ASSERT_TRUE(drop.empty()) << "nothing is given up without need";
            continue;
        }
        ASSERT_LE(bytes_after(tiles, drop, floor), std::max(ceiling, least));
        for (const std::uint32_t i : drop) {
            ASSERT_GT(tiles[i].bytes, floor) << "dropping it gains nothing";
            ASSERT_FALSE(tiles[i].under_way) << "dropping it undoes work";
        }
        if (!drop.empty()) {  // the last one was still needed
            ASSERT_GT(bytes_after(tiles, {drop.begin(), drop.end() - 1}, floor), ceiling);
        }
        // Finished ones go first: nothing unfinished goes while a finished one that would help stays.
        const bool unfinished = std::any_of(drop.begin(), drop.end(), [&](std::uint32_t i) { return tiles[i].stage < stages; });
        for (std::uint32_t i = 0; unfinished && i < tiles.size(); ++i) {
            ASSERT_TRUE(tiles[i].stage < stages || tiles[i].under_way || tiles[i].bytes <= floor || chosen.contains(i));
        }
        // Then those least far.
        for (const std::uint32_t gone : drop) {
            for (std::uint32_t i = 0; tiles[gone].stage < stages && i < tiles.size(); ++i) {
                if (chosen.contains(i) || tiles[i].under_way || tiles[i].stage == 0 || tiles[i].bytes <= floor || tiles[i].stage == stages) continue;
                ASSERT_GE(tiles[i].stage, tiles[gone].stage);
            }
        }
    }
}

}  // namespace
}  // namespace crescente::render
