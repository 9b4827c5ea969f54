#include "render/session.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <utility>

#include "parallel/pool.h"
#include "render/describe.h"
#include "render/film.h"
#include "render/level.h"
#include "render/revision.h"
#include "render/scheduler.h"

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
    std::atomic<std::uint64_t> revised = 0;      // times that an edit touched a tile
    RayCounts past_rays;                         // of tiles that were given up when the picture's size changed
    TestCounts past_tests;

    int tiles_across() const { return (width() + tile_size() - 1) / tile_size(); }
    int width() const { return world->scene.settings.width; }
    int height() const { return world->scene.settings.height; }
    int tile_size() const { return world->scene.settings.tile; }

    void plan_stages();
    void cut_tiles();
    void catch_up(Tile& tile);
    bool catch_up(const Deadline& deadline);  // all tiles; whether there was time for it
    bool advance_tile(Tile& tile, int until, const Deadline& deadline) const;
    Tile regrown(const Tile& tile) const;
    static std::vector<Node> drop(Tile& tile);  // gives the memory of its nodes
    void take_spare(Tile& tile);
    void drop_finished(Tile& tile);
    std::vector<TileState> tile_states() const;
    Progress progress(const std::vector<TileState>& states) const;
};

namespace {

const LevelKind& kind_of(scene::Level level) { return levels()[static_cast<std::size_t>(level)]; }

}  // namespace

void Session::State::plan_stages() {
    const scene::Settings& settings = world->scene.settings;
    stages.clear();
    level_of_stage.clear();
    for (const LevelKind& kind : levels()) {
        if (kind.level > settings.level) break;
        for (const Stage& stage : kind.stages(settings)) {
            stages.push_back(stage);
            level_of_stage.push_back(kind.level);
        }
    }
    level_seconds.resize(levels().size());
    level_rays.resize(levels().size());
}

void Session::State::catch_up(Tile& tile) {
    if (tile.revision == edits) return;
    for (std::size_t i = steps.size() - static_cast<std::size_t>(edits - tile.revision); i < steps.size(); ++i) {
        revise(tile, *steps[i].before, i + 1 < steps.size() ? *steps[i + 1].before : *world, steps[i].change);
    }
    revised += tile.unsettled || tile.nodes.empty();
    settle(tile, *world, level_of_stage);
    tile.revision = edits;
}

bool Session::State::catch_up(const Deadline& deadline) {
    if (steps.empty()) return true;
    std::atomic<bool> all = true;
    pool.for_each(tiles.size(), [&](std::size_t i) {
        if (tiles[i].revision == edits) return;
        if (deadline.passed()) all = false;
        else catch_up(tiles[i]);
    });
    if (all) steps.clear();
    return all;
}

void Session::State::cut_tiles() {
    for (const Tile& tile : tiles) past_rays += tile.rays, past_tests += tile.tests;
    tiles.clear();
    for (int y = 0; y < height(); y += tile_size()) {
        for (int x = 0; x < width(); x += tile_size()) {
            Tile& tile = tiles.emplace_back();
            tile.x0 = x, tile.y0 = y;
            tile.width = std::min(tile_size(), width() - x), tile.height = std::min(tile_size(), height() - y);
            tile.revision = edits;
        }
    }
}

bool Session::State::advance_tile(Tile& tile, int until, const Deadline& deadline) const {
    const bool unseen = until > tile.stage + 1 && level_of_stage[static_cast<std::size_t>(until - 1)] > scene::Level::visible;
    if (unseen && tile.stage > 0 && !tile.shows_pixels()) {
        tile.pixels = develop(tile);
        tile.pixels_stage = tile.stage;
    }
    Growth growth(*world, tile, unseen);
    while (tile.stage < until) {
        const Stage& stage = stages[static_cast<std::size_t>(tile.stage)];
        if (!kind_of(stage.level).advance(growth, stage, deadline)) return false;
        tile.cursor = 0;
        if (++tile.stage == 1 && !tile.shows_pixels()) tile.pixels = {};  // of before an edit that left no tree
        if (tile.stage < until && deadline.passed()) return false;
    }
    return true;
}

// The tile with its trees as they were when they were dropped.
Tile Session::State::regrown(const Tile& tile) const {
    Tile copy = blank_tile(tile);
    advance_tile(copy, tile.shown_stage(), Deadline::never());
    return copy;
}

std::vector<Node> Session::State::drop(Tile& tile) {
    Tile rest = without_trees(tile);
    rest.pixels_stage = tile.shown_stage();
    std::vector<Node> nodes = std::move(tile.nodes);
    tile = std::move(rest);
    return nodes;
}

// The first picture's few nodes move to memory that has room for all of the tile's.
void Session::State::take_spare(Tile& tile) {
    if (tile.stage != 1 || tile.nodes.capacity() >= tile.corners.size()) return;
    std::vector<Node> spare;
    {
        const std::lock_guard lock(spare_mutex);
        if (spare_nodes.empty()) return;
        spare = std::move(spare_nodes.back());
        spare_nodes.pop_back();
    }
    spare.assign(tile.nodes.begin(), tile.nodes.end());
    tile.nodes = std::move(spare);
}

void Session::State::drop_finished(Tile& tile) {
    dropped_bytes += tile.filled_bytes();
    dropped_nodes += tile.nodes.size();
    std::vector<Node> nodes = drop(tile);
    nodes.clear();
    const std::lock_guard lock(spare_mutex);
    spare_nodes.push_back(std::move(nodes));
}

std::vector<TileState> Session::State::tile_states() const {
    std::vector<TileState> states;
    states.reserve(tiles.size());
    const int last = static_cast<int>(stages.size()) - 1;
    for (const Tile& tile : tiles) {
        TileState& state = states.emplace_back(TileState{tile.stage, tile.shown_stage(), tile.bytes(), tile.going_on});
        if (tile.revision != edits) state.stage = std::min(state.stage, last), state.shown_stage = std::clamp(state.shown_stage, 0, last);  // never done
    }
    return states;
}

Progress Session::State::progress(const std::vector<TileState>& states) const {
    Progress progress{true, "", 0, true};
    double total = 0, done = 0;
    std::vector<double> cost_until{0};
    for (const Stage& stage : stages) cost_until.push_back(total += stage.cost);
    int lowest = static_cast<int>(stages.size());
    for (const TileState& state : states) {
        lowest = std::min(lowest, state.shown_stage);
        done += cost_until[static_cast<std::size_t>(state.shown_stage)];
    }
    progress.first_picture = lowest > 0;
    progress.done = lowest == static_cast<int>(stages.size());
    progress.fraction = progress.done ? 1 : done / (total * static_cast<double>(states.size()));
    progress.level = kind_of(stages[static_cast<std::size_t>(std::min<int>(lowest, static_cast<int>(stages.size()) - 1))].level).name;
    return progress;
}

Expected<Session> Session::open(scene::Scene scene) {
    const auto start = Clock::now();
    const int threads = scene.settings.threads;
    auto world = world_of(std::move(scene));
    if (!world) return tl::unexpected(world.error());
    auto state = std::make_unique<State>(std::move(*world), threads);
    state->plan_stages();
    state->cut_tiles();
    state->build_seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return Session(std::move(state));
}

Session::Session(std::unique_ptr<State> state) : state_(std::move(state)) {}
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;
Session::~Session() = default;

Progress Session::advance(const Deadline& deadline) {
    State& s = *state_;
    const auto start = Clock::now();
    const auto ceiling = static_cast<std::uint64_t>(s.world->scene.settings.memory);
    const int stages = static_cast<int>(s.stages.size());
    const bool keep = s.world->scene.settings.keep;
    const Plan plan{stages, s.world->scene.settings.order != scene::Order::tiles, ceiling ? 4 * static_cast<std::size_t>(s.pool.threads()) : 0,
                    static_cast<std::size_t>(s.pool.threads())};
    const bool known = s.catch_up(deadline);
    std::vector<TileState> states = s.tile_states();
    while (known) {
        const std::vector<Work> work = next_work(states, plan);
        if (work.empty()) break;
        const auto round = Clock::now();
        const auto rays_of = [&] {
            RayCounts sum;
            for (const Work& w : work) sum += s.tiles[w.tile].rays;
            return sum;
        };
        const RayCounts before = rays_of();
        const auto level = static_cast<std::size_t>(s.stages[static_cast<std::size_t>(work[0].until - 1)].level);
        s.pool.for_each(work.size(), [&](std::size_t i) {
            if (deadline.passed()) return;
            Tile& tile = s.tiles[work[i].tile];
            tile.going_on = ceiling > 0 && work[i].until == stages;
            if (!keep && work[i].until == stages) s.take_spare(tile);
            if (!s.advance_tile(tile, work[i].until, deadline) || tile.stage < stages) return;
            tile.going_on = false;
            if (keep) {
                tile.pixels = {};
                tile.pixels_stage = -1;
                return tile.trim();
            }
            s.drop_finished(tile);
        });
        const RayCounts after = rays_of();
        RayCounts& rays = s.level_rays[level];
        rays.camera += after.camera - before.camera, rays.reflected += after.reflected - before.reflected;
        rays.refracted += after.refracted - before.refracted, rays.shadow += after.shadow - before.shadow;
        s.level_seconds[level] += std::chrono::duration<double>(Clock::now() - round).count();

        states = s.tile_states();
        std::uint64_t bytes = 0;
        for (const TileState& state : states) bytes += state.bytes;
        s.peak_bytes = std::max(s.peak_bytes, bytes);
        if (ceiling > 0 && bytes > ceiling) {
            for (const Work& w : work) states[w.tile].under_way = states[w.tile].shown_stage < w.until;
            const auto floor = sizeof(Rgb) * static_cast<std::uint64_t>(s.tile_size()) * static_cast<std::uint64_t>(s.tile_size());
            const auto victims = tiles_to_drop(states, stages, ceiling, floor);
            s.pool.for_each(victims.size(), [&](std::size_t i) { State::drop(s.tiles[victims[i]]); });
            s.drops += victims.size();
            states = s.tile_states();
        }
        if (deadline.passed()) break;
    }
    s.render_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    return s.progress(states);
}

Expected<EditReport> Session::edit(std::vector<scene::Edit> edits, const std::string& file) {
    State& s = *state_;
    const auto start = Clock::now();
    std::vector<const geometry::Shape*> reshaped;  // what trees know of the old form would not fit the new one
    for (const scene::Edit& edit : edits) {
        const auto* e = std::get_if<scene::SetShape>(&edit);
        if (e && e->shape.value < s.world->scene.shapes.size()) reshaped.push_back(&s.world->scene.shapes[e->shape.value].shape);
    }
    if (!reshaped.empty()) s.catch_up(Deadline::never());
    const scene::Settings settings = s.world->scene.settings;
    auto undo = scene::apply(std::move(edits), s.world->scene, file);
    if (!undo) return tl::unexpected(undo.error());

    EditReport report{std::move(*undo)};
    World& before = *s.world;
    auto now = world_without_accelerator(std::move(before.scene));
    Change change = change_between(before, settings, *now, reshaped);
    const accel::Accelerator* accelerator = before.accelerator.get();
    if (auto given = give_accelerator(*now, before, change.same_geometry && same_accelerator(settings, now->scene.settings), reshaped); !given) {
        before.scene = std::move(now->scene);
        (void)scene::apply(std::move(report.undo), before.scene);
        return tl::unexpected(given.error());
    }
    std::unique_ptr<World> old = std::exchange(s.world, std::move(now));
    report.accelerator_kept = s.world->accelerator.get() == accelerator;
    if (settings.threads != s.world->scene.settings.threads) s.pool = parallel::Pool(s.world->scene.settings.threads);
    if (change.stages) s.plan_stages();
    report.began_anew = change.anew;
    if (settings.width != s.width() || settings.height != s.height() || settings.tile != s.tile_size()) {
        s.steps.clear();
        s.cut_tiles();
    } else if (change.touches_trees()) {
        ++s.edits;
        old->accelerator.reset();
        s.steps.push_back({std::move(old), std::move(change)});
    }
    report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return report;
}

scene::Image Session::picture(bool all_layers) const {
    State& s = *state_;
    if (all_layers) s.catch_up(Deadline::never());  // layers speak of the scene as it is
    scene::Image image = blank_image(s.width(), s.height(), all_layers);
    s.pool.for_each(s.tiles.size(), [&](std::size_t i) {
        const Tile& tile = s.tiles[i];
        if (all_layers && tile.shows_pixels()) {
            expose(s.regrown(tile), *s.world, s.level_of_stage, image);
        } else {
            expose(tile, *s.world, s.level_of_stage, image);
        }
    });
    return image;
}

Stats Session::stats() const {
    const State& s = *state_;
    Stats stats;
    stats.rays = s.past_rays;
    stats.tests = s.past_tests;
    for (const Tile& tile : s.tiles) {
        stats.rays += tile.rays;
        stats.tests += tile.tests;
        stats.nodes += tile.nodes.size();
        stats.forest_bytes += tile.bytes();
    }
    for (const LevelKind& kind : levels()) {
        if (kind.level > s.world->scene.settings.level) break;
        const auto i = static_cast<std::size_t>(kind.level);
        stats.levels.push_back({kind.name, s.level_seconds[i], s.level_rays[i]});
    }
    stats.peak_forest_bytes = std::max(s.peak_bytes, stats.forest_bytes);
    stats.accelerator_bytes = s.world->accelerator->bytes();
    stats.dropped_tiles = s.drops;
    stats.nodes += s.dropped_nodes;
    stats.bytes_per_pixel = static_cast<double>(s.dropped_bytes + std::max(s.peak_bytes, stats.forest_bytes)) / (double(s.width()) * s.height());
    stats.render_seconds = s.render_seconds;
    stats.build_seconds = s.build_seconds;
    stats.threads = s.pool.threads();
    stats.revised_tiles = s.revised;
    return stats;
}

const scene::Scene& Session::scene() const { return state_->world->scene; }

std::string Session::describe(int x, int y) {
    State& s = *state_;
    s.catch_up(Deadline::never());
    if (x < 0 || y < 0 || x >= s.width() || y >= s.height()) return {};
    const Tile& tile = s.tiles[static_cast<std::size_t>(y / s.tile_size()) * s.tiles_across() + x / s.tile_size()];
    if (tile.shows_pixels()) return describe_pixel(s.regrown(tile), *s.world, x - tile.x0, y - tile.y0);
    return describe_pixel(tile, *s.world, x - tile.x0, y - tile.y0);
}

}  // namespace crescente::render
