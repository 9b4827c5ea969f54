// What a session holds, and how its tiles are brought forward; render/session.h is its face.
#pragma once

#include <atomic>
#include <chrono>
#include <deque>
#include <mutex>
#include <optional>

#include "parallel/pool.h"
#include "render/change.h"
#include "render/forest.h"
#include "render/level.h"
#include "render/reprojection.h"
#include "render/scheduler.h"
#include "render/session.h"

namespace crescente::render {

using Clock = std::chrono::steady_clock;

struct Session::State {
    State(std::unique_ptr<World> made, int threads) : world(std::move(made)), pool(threads) {}

    std::unique_ptr<World> world;
    mutable parallel::Pool pool;
    std::vector<Stage> stages;
    std::vector<scene::Level> level_of_stage;
    std::vector<Tile> tiles;
    std::vector<double> level_seconds;     // by level
    std::vector<RayCounts> level_rays;     // by level
    double build_seconds = 0, render_seconds = 0;
    std::uint64_t peak_bytes = 0, drops = 0;
    std::atomic<std::uint64_t> dropped_bytes = 0, dropped_nodes = 0;  // of finished tiles that were not kept
    std::mutex spare_mutex;
    std::vector<std::vector<Node>> spare_nodes;  // memory of dropped tiles, for the next ones
    // Edits that some tiles do not know yet: the world before each, and what it changed. The first is edit number `edits - steps.size()`.
    struct Step {
        std::unique_ptr<World> before;
        Change change;
    };
    std::deque<Step> steps;
    std::uint64_t edits = 0;
    bool settled = true;                         // no tile waits for revision or settling
    std::atomic<std::uint64_t> revised = 0;      // times that an edit touched a tile
    std::uint64_t clock = 0;                     // ticks when tiles may change
    bool is_finished = false;                    // the picture, at the end of the last advance()
    std::uint64_t finished = 0;                  // when it last became so
    struct Displayed {  // a tile's pixels as they were last shown; empty, if they are what its trees say and memory is scarce
        std::vector<Rgb> pixels;
        std::uint64_t time = 0;  // of the clock
    };
    std::vector<Displayed> displayed;            // beside tiles: edits go on from what the user saw
    std::vector<SeenPoint> seen;                 // by pixel, from the last camera whose picture had all its corners; until the present one's has
    Area attended;                               // where the user looks
    RayCounts past_rays;                         // of tiles that were given up when the picture's size changed
    TestCounts past_tests;

    int tiles_across() const { return (width() + tile_size() - 1) / tile_size(); }
    bool keeps_alpha() const { return world->environment.source().transparent; }
    int width() const { return world->scene.settings.width; }
    int height() const { return world->scene.settings.height; }
    int tile_size() const { return world->scene.settings.tile; }

    void plan_stages();
    void cut_tiles();
    std::optional<Reprojected> seen_anew(const World& before);  // the old picture as the camera now sees it; nothing: memory is too scarce for that
    void begin_anew(const Reprojected& picture);                // the trees; until there is more the tiles show the picture
    std::span<const Rgb> displayed_by(std::size_t tile) const;  // empty: nothing, or it has changed since
    bool revise(Tile& tile, bool watched);    // whether there was an edit that it did not know
    bool catch_up(const Deadline& deadline);  // all tiles; whether there was time for it
    bool advance_tile(Tile& tile, int until, const Deadline& deadline) const;
    const Tile* tile_at(int x, int y) const;  // null: outside the picture
    Tile regrown(const Tile& tile) const;
    static std::vector<Node> drop(Tile& tile);  // gives the memory of its nodes
    void take_spare(Tile& tile);
    void drop_finished(Tile& tile);
    void show(scene::Image& image, const std::vector<bool>& which, bool regrow);  // these tiles, as they are or, where they were dropped, grown anew
    void remember(std::size_t tile, const scene::Image& image, bool pixels);
    bool is_known(const Tile& tile) const { return tile.revision == edits && !tile.unsettled; }  // to the trees, what the scene is
    bool denoises() const;                                                                // some tile may show what has too few samples
    std::vector<bool> with_neighbours(const std::vector<bool>& which) const;              // those too by which the filter finds what these show
    std::vector<TileState> tile_states() const;
    Progress progress(const std::vector<TileState>& states) const;
};

}  // namespace crescente::render
