// A tile as bytes and back; what is no sound tile is refused. The seeds of fuzzing are such bytes.
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <set>

#include "render/checkpoint_seeds.h"
#include "render/film.h"
#include "render/level.h"
#include "render/scenes.h"
#include "render/tile_archive.h"
#include "render/tile_check.h"

namespace crescente::render::testing {
namespace {

using scene::Scene;

// Every state between two chunks of rays, of every stage: as bytes and back.
TEST(TileArchive, ATileThatWasStoppedAnywhereGoesOnFromItsBytes) {
    for (const bool unseen : {false, true}) {
        Scene scene = still_life();
        scene.settings.width = 32, scene.settings.height = 24;
        const auto world = world_of(scene);
        ASSERT_TRUE(world);
        const std::vector<Stage> stages = stages_of(scene.settings);
        Tile stopped, straight;
        for (Tile* t : {&stopped, &straight}) t->width = 32, t->height = 24;
        const std::atomic<bool> stop = true;
        Deadline now;
        now.stop = &stop;
        std::size_t amid_splitting = 0, with_growing = 0;
        for (const Stage& stage : stages) {
            SCOPED_TRACE(stopped.stage);
            const auto advance = levels()[static_cast<std::size_t>(stage.level)].advance;
            if (unseen && straight.stage == 1) {  // what was seen before nobody looks any more
                for (Tile* t : {&stopped, &straight}) t->pixels = develop(*t), t->pixels_stage = 1;
            }
            for (bool done = false; !done;) {
                Growth growth(**world, stopped, unseen && stopped.stage > 0);
                done = advance(growth, stage, now);
                if (done) stopped.cursor = 0, ++stopped.stage;
                amid_splitting += stage.level == scene::Level::edges && stopped.cursor > 0, with_growing += !stopped.growing.empty();
                std::string bytes;
                append_tile(stopped, bytes);
                auto again = tile_of(bytes, stopped);
                ASSERT_TRUE(again);
                ASSERT_EQ(tile_problem(*again, **world, stages), "");
                stopped = std::move(*again);
            }
            Growth growth(**world, straight, unseen && straight.stage > 0);
            ASSERT_TRUE(advance(growth, stage, Deadline::never()));
            straight.cursor = 0, ++straight.stage;
            ASSERT_EQ(stopped.nodes.size(), straight.nodes.size());
            const std::vector<Rgb> x = radiances(stopped), y = radiances(straight);
            EXPECT_EQ(std::memcmp(x.data(), y.data(), x.size() * sizeof(Rgb)), 0);
        }
        EXPECT_GT(amid_splitting, 10u);
        EXPECT_GT(with_growing, 10u);
        EXPECT_EQ(stopped.rays.total(), straight.rays.total());
    }
}

// --- The seeds of fuzzing

Tile blank_seed_tile() {
    Tile tile;
    tile.width = 8, tile.height = 6;
    return tile;
}

// After each stage, amid the splitting of pixels, with nothing but pixels; and a whole file.
std::map<std::string, std::string> fresh_seeds() {
    std::map<std::string, std::string> seeds;
    const auto keep = [&](const std::string& name, Tile& tile) {
        std::string& bytes = seeds[name] = "t";
        append_tile(tile, bytes);
    };
    const auto world = world_of(seed_scene());
    Tile tile = blank_seed_tile();
    const std::atomic<bool> stop = true;
    Deadline now;
    now.stop = &stop;
    for (const Stage& stage : stages_of(seed_scene().settings)) {
        Growth growth(**world, tile, false);
        while (!levels()[static_cast<std::size_t>(stage.level)].advance(growth, stage, now)) {
            if (stage.level == scene::Level::edges && !tile.subpixel_roots.empty()) keep("tile_amid_edges", tile);
        }
        tile.cursor = 0, ++tile.stage;
        keep("tile_" + std::to_string(tile.stage), tile);
    }
    for (const bool whole : {false, true}) {
        scene::Scene scene = seed_scene();
        if (!whole) scene.settings.memory = 1, scene.settings.keep = false;
        Session session = finished(scene);
        const std::string bytes = saved(session);
        seeds[whole ? "whole" : "tile_dropped"] = whole ? "w" + bytes : "t" + bytes.substr(end_of_head(bytes) + 16);
    }
    return seeds;
}

TEST(CheckpointSeeds, AreAllAccepted) {
    const std::filesystem::path corpus = std::filesystem::path(CRESCENTE_ROOT) / "tests" / "fuzz" / "corpus" / "checkpoint";
    if (std::getenv("CRESCENTE_WRITE_SEEDS")) {
        for (const auto& [name, bytes] : fresh_seeds()) write_bytes(corpus / name, bytes);
    }
    const auto file = std::filesystem::temp_directory_path() / ("crescente-seeds-" + std::to_string(getpid()) + ".checkpoint");
    std::set<std::string> names;
    std::size_t filtered = 0, straight = 0, subpixel_roots = 0, pixels = 0;
    for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
        SCOPED_TRACE(names.emplace(entry.path().filename().string()).first->c_str());
        const std::string seed = bytes_of(entry.path());
        ASSERT_FALSE(seed.empty());
        write_bytes(file, file_of_seed(seed));
        const auto session = Session::resume(seed_scene(), file);
        EXPECT_TRUE(session) << session.error().text();
        if (seed[0] != 't') continue;
        const auto tile = tile_of(std::string_view(seed).substr(1), blank_seed_tile());
        ASSERT_TRUE(tile);
        filtered += tile->filtered.size(), straight += tile->straight.size(), subpixel_roots += tile->subpixel_roots.size(), pixels += tile->pixels.size();
    }
    std::filesystem::remove(file);
    for (const auto& [name, bytes] : fresh_seeds()) EXPECT_TRUE(names.contains(name)) << name;
    EXPECT_GT(std::min({filtered, straight, subpixel_roots, pixels}), 0u) << "a column that no seed has";
}

// --- Tiles that are refused

TEST(TileArchive, KeysOfMapsAscendAndAreWithinTheTile) {
    const std::string whole = fresh_seeds().at("tile_amid_edges").substr(1);
    std::vector<std::size_t> lists;  // where each begins with its length
    std::size_t end = 0;
    for (const std::size_t element : {96, 1, 20, 8, 2, 28, 2, 28, 12, 4, 4, 24, 24, 20, 20, 12}) {  // docs/forest.md
        std::uint64_t length;
        ASSERT_LE(end + sizeof length, whole.size());
        std::memcpy(&length, &whole[end], sizeof length);
        lists.push_back(end);
        end += sizeof length + length * element;
    }
    struct Map {
        std::size_t list, key, entry;
    };
    for (const Map& map : {Map{2, 8, 20}, Map{3, 4, 8}, Map{15, 8, 12}}) {
        SCOPED_TRACE(map.list);
        std::uint64_t length;
        std::memcpy(&length, &whole[lists[map.list]], sizeof length);
        ASSERT_GE(length, 2u);
        const std::size_t first = lists[map.list] + sizeof length, last = first + (length - 1) * map.entry;
        const auto is_refused = [&](std::size_t at, const std::string& key) { return !tile_of(std::string(whole).replace(at, map.key, key), blank_seed_tile()); };
        EXPECT_FALSE(is_refused(first, whole.substr(first, map.key)));
        EXPECT_TRUE(is_refused(first, whole.substr(last, map.key))) << "descending";
        EXPECT_TRUE(is_refused(first, whole.substr(first + map.entry, map.key))) << "twice";
        EXPECT_TRUE(is_refused(last, std::string(map.key, '\x7f'))) << "beyond the tile";
    }
}

TEST(TileCheck, PixelsSeenThroughALens) {
    scene::Scene scene = seed_scene();
    scene.settings.level = scene::Level::soft, scene.settings.samples = 20;
    scene.camera->aperture = 0.1;
    const auto world = world_of(scene);
    const std::vector<Stage> stages = stages_of(scene.settings);
    Tile whole = cut_tiles(scene.settings)[0];
    Growth growth(**world, whole, false);
    for (const Stage& stage : stages) {
        ASSERT_TRUE(levels()[static_cast<std::size_t>(stage.level)].advance(growth, stage, Deadline::never()));
        ++whole.stage, whole.cursor = 0;
    }
    const auto problem = [&](auto&& change) {
        Tile tile = whole;
        change(tile);
        return tile_problem(tile, **world, stages);
    };
    const std::string do_not_fit = "has samples that do not fit its pixels";
    EXPECT_EQ(problem([](Tile&) {}), "");
    EXPECT_EQ(problem([](Tile& t) { t.lens_samples.pop_back(); }), do_not_fit);
    EXPECT_EQ(problem([](Tile& t) { t.lens_estimates.emplace_back(); }), do_not_fit);
    EXPECT_EQ(problem([](Tile& t) { t.lens_pixels[0].g = std::numeric_limits<float>::infinity(); }), do_not_fit);
    EXPECT_EQ(problem([](Tile& t) { t.lens_samples[3] = 0; }), do_not_fit) << "the rounds are said to be complete";
    EXPECT_EQ(problem([](Tile& t) { t.lens_samples[3] = 300, t.lens_piloted = false; }), do_not_fit) << "more than a pilot that is not";
    EXPECT_EQ(problem([](Tile& t) { forget_samples(t); }), do_not_fit);
    const auto unsampled = std::count_if(stages.begin(), stages.end(), [](const Stage& stage) { return stage.level <= scene::Level::edges; });
    EXPECT_EQ(problem([&](Tile& t) { forget_samples(t), t.stage = static_cast<int>(unsampled); }), "");
    EXPECT_EQ(problem([](Tile& t) { t.lens_clear.assign(t.lens_pixels.size(), 0); }), do_not_fit) << "the picture keeps no alpha";
    scene.camera->aperture = 0;
    EXPECT_EQ(tile_problem(whole, **world_of(scene), stages), do_not_fit) << "the world is seen through a pinhole";
    scene.camera->aperture = 0.1;
    if (!scene.environment) scene.environment.emplace();
    scene.environment->transparent = true;
    EXPECT_EQ(tile_problem(whole, **world_of(scene), stages), do_not_fit) << "it keeps alpha";
}

TEST(TileCheck, ATreeIsATreeAndSeesSomething) {
    const auto world = world_of(seed_scene());
    const std::vector<Stage> stages = stages_of(seed_scene().settings);
    const auto whole = tile_of(fresh_seeds().at("tile_amid_edges").substr(1), blank_seed_tile());
    ASSERT_TRUE(whole);
    ASSERT_EQ(tile_problem(*whole, **world, stages), "");
    std::uint32_t glass = 0, sky = 0;  // one with three children, one that met nothing
    while (glass < whole->nodes.size() && (whole->nodes[glass].reflected == no_node || whole->nodes[glass].refracted == no_node || !whole->straight.contains(glass))) ++glass;
    while (sky < whole->nodes.size() && !whole->nodes[sky].left_scene()) ++sky;
    ASSERT_LT(std::max(glass, sky), whole->nodes.size());
    const auto problem = [&](auto&& change) {
        Tile tile = *whole;
        change(tile, tile.nodes[glass]);
        return tile_problem(tile, **world, stages);
    };
    const std::string no_part = "has a node that is no part of a tree, or of nothing in the scene", from_nowhere = "has rays that come from nowhere";
    EXPECT_EQ(problem([](Tile&, Node& n) { n.refracted = n.reflected; }), no_part) << "one child by two ways";
    EXPECT_EQ(problem([&](Tile& t, Node& n) { t.straight[glass] = n.reflected; }), no_part);
    EXPECT_EQ(problem([](Tile&, Node& n) { n.reflected = no_node; }), no_part) << "a child by no way";
    EXPECT_EQ(problem([&](Tile& t, Node&) { t.straight.erase(glass); }), no_part);
    EXPECT_EQ(problem([&](Tile& t, Node& n) { n.reflected = t.corners[0]; }), no_part) << "a root as a child";
    EXPECT_EQ(problem([](Tile&, Node& n) { n.spawned = false; }), no_part) << "children of what sent no ray";
    EXPECT_EQ(problem([&](Tile& t, Node&) { t.pending.push_back({glass, {}, 0, Way::straight}); }), from_nowhere) << "a child that would come again";
    EXPECT_EQ(problem([](Tile& t, Node&) { t.growing.push_back(t.pending.at(0)); }), from_nowhere) << "one that would come twice";
    for (const float scale : {0.0f, 0.99f, 1.01f, std::numeric_limits<float>::quiet_NaN()}) {
        EXPECT_EQ(problem([&](Tile&, Node& n) { n.normal[0] *= scale, n.normal[1] *= scale, n.normal[2] *= scale; }), no_part) << scale;
        EXPECT_EQ(problem([&](Tile& t, Node&) { t.nodes[sky].position = t.nodes[sky].position * double{scale}; }), no_part) << scale;
    }
    EXPECT_EQ(problem([](Tile& t, Node&) { t.corners[1] = t.corners[0]; }), "has a pixel corner without a tree") << "of its own";
    EXPECT_EQ(problem([](Tile&, Node& n) { n.position.x = std::numeric_limits<double>::infinity(); }), no_part);
    EXPECT_EQ(problem([&](Tile&, Node& n) { n.position = (*world)->camera.viewer_of(n.position); }), no_part) << "where the viewer is";
    EXPECT_EQ(problem([](Tile& t, Node& n) { t.nodes[n.refracted].position = n.position; }), no_part) << "where its parent is";
}

}  // namespace
}  // namespace crescente::render::testing
