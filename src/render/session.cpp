#include "render/session.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>
#include <numeric>
#include <utility>

#include "parallel/pool.h"
#include "render/checkpoint.h"
#include "render/describe.h"
#include "render/film.h"
#include "render/level.h"
#include "render/level_visible.h"
#include "render/preview.h"
#include "render/reprojection.h"
#include "render/revision.h"
#include "render/scheduler.h"
#include "scene/hierarchy.h"

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
    std::vector<SeenPoint> seen;                 // by pixel, from the last camera whose picture had all its corners; until the present one's has
    Area attended;                               // where the user looks
    RayCounts past_rays;                         // of tiles that were given up when the picture's size changed
    TestCounts past_tests;

    int tiles_across() const { return (width() + tile_size() - 1) / tile_size(); }
    int width() const { return world->scene.settings.width; }
    int height() const { return world->scene.settings.height; }
    int tile_size() const { return world->scene.settings.tile; }

    void plan_stages();
    void cut_tiles();
    void move_camera(const World& before);  // the tiles begin anew; until there is more they show the old picture as the camera now sees it
    bool revise(Tile& tile, bool watched);    // whether there was an edit that it did not know
    bool catch_up(const Deadline& deadline);  // all tiles; whether there was time for it
    bool advance_tile(Tile& tile, int until, const Deadline& deadline) const;
    const Tile* tile_at(int x, int y) const;  // null: outside the picture
    Tile regrown(const Tile& tile) const;
    static std::vector<Node> drop(Tile& tile);  // gives the memory of its nodes
    void take_spare(Tile& tile);
    void drop_finished(Tile& tile);
    std::vector<TileState> tile_states() const;
    Progress progress(const std::vector<TileState>& states) const;
};

namespace {

const LevelKind& kind_of(scene::Level level) { return levels()[static_cast<std::size_t>(level)]; }

// In pixels; 0 if they overlap, or the area is empty.
double distance(const Tile& tile, const Area& area) {
    if (area.width <= 0 || area.height <= 0) return 0;
    const int dx = std::max({0, area.x - (tile.x0 + tile.width), tile.x0 - (area.x + area.width)});
    const int dy = std::max({0, area.y - (tile.y0 + tile.height), tile.y0 - (area.y + area.height)});
    return std::hypot(dx, dy);
}

}  // namespace

void Session::State::plan_stages() {
    stages = stages_of(world->scene.settings);
    level_of_stage.clear();
    for (const Stage& stage : stages) level_of_stage.push_back(stage.level);
    level_seconds.resize(levels().size());
    level_rays.resize(levels().size());
}

bool Session::State::revise(Tile& tile, bool watched) {
    if (tile.revision == edits) return false;
    for (std::size_t i = steps.size() - static_cast<std::size_t>(edits - tile.revision); i < steps.size(); ++i) {
        render::revise(tile, *steps[i].before, i + 1 < steps.size() ? *steps[i + 1].before : *world, steps[i].change, watched);
    }
    if (tile.unsettled || tile.nodes.empty()) ++revised, tile.changed = clock;
    tile.revision = edits;
    return true;
}

bool Session::State::catch_up(const Deadline& deadline) {
    ++clock;
    if (settled) return true;
    std::vector<std::uint32_t> order(tiles.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return distance(tiles[a], attended) < distance(tiles[b], attended); });
    const auto for_all = [&](auto&& work) {
        std::atomic<bool> all = true;
        pool.for_each(tiles.size(), [&](std::size_t i) {
            if (deadline.passed()) all = false;
            else work(tiles[order[i]]);
        });
        return all.load();
    };
    const auto settle = [&](Tile& tile) {
        if (tile.unsettled) tile.changed = clock;
        render::settle(tile, *world, level_of_stage);
    };
    const bool watched = !deadline.is_never();
    const bool known = for_all([&](Tile& tile) {
        if (revise(tile, watched) && watched) preview(tile, *world, level_of_stage);
        if (!watched) settle(tile);
    });
    if (known) steps.clear();
    settled = known && (!watched || for_all(settle));
    return settled;
}

void Session::State::cut_tiles() {
    for (const Tile& tile : tiles) past_rays += tile.rays, past_tests += tile.tests;
    tiles.clear();
    ++clock;
    for (int y = 0; y < height(); y += tile_size()) {
        for (int x = 0; x < width(); x += tile_size()) {
            Tile& tile = tiles.emplace_back();
            tile.x0 = x, tile.y0 = y;
            tile.width = std::min(tile_size(), width() - x), tile.height = std::min(tile_size(), height() - y);
            tile.revision = edits;
            tile.changed = clock;
        }
    }
}

void Session::State::move_camera(const World& before) {
    const auto shadows = std::find(level_of_stage.begin(), level_of_stage.end(), scene::Level::shadows) - level_of_stage.begin();
    const int complete = static_cast<int>(visible_stages(world->scene.settings).size());
    const auto has_corners = [&](const Tile& tile) { return tile.stage >= complete; };
    if (seen.empty() || std::all_of(tiles.begin(), tiles.end(), has_corners)) {
        seen.assign(static_cast<std::size_t>(width()) * static_cast<std::size_t>(height()), {});
        pool.for_each(tiles.size(), [&](std::size_t i) { take_points(tiles[i], before.environment.backdrop, width(), seen); });
    }
    const Reprojected picture = reproject(seen, world->camera, width(), height(), pool);
    const bool reuse = world->scene.settings.memory == 0;
    ++clock;
    pool.for_each(tiles.size(), [&](std::size_t i) {
        Tile& tile = tiles[i];
        Tile fresh = blank_tile(tile);
        fresh.rays = tile.rays, fresh.tests = tile.tests;
        fresh.revision = edits, fresh.changed = clock;
        std::size_t holes = 0;
        for (int y = tile.y0; y < tile.y0 + tile.height; ++y) {
            const auto first = static_cast<std::ptrdiff_t>(y) * width() + tile.x0;
            fresh.pixels.insert(fresh.pixels.end(), picture.pixels.begin() + first, picture.pixels.begin() + first + tile.width);
            holes += static_cast<std::size_t>(std::count(picture.seen.begin() + first, picture.seen.begin() + first + tile.width, 0));
        }
        constexpr std::size_t few = 4;  // with more of it guessed the coarse picture is the better one
        if (holes * few < fresh.pixels.size()) {
            fresh.previewed_until = std::min(static_cast<int>(shadows) + 1, static_cast<int>(level_of_stage.size()));
            fresh.kept = no_node;
        }
        if (reuse) {  // the memory
            tile.nodes.clear(), tile.shares.clear();
            fresh.nodes = std::move(tile.nodes), fresh.shares = std::move(tile.shares);
        }
        tile = std::move(fresh);
    });
    steps.clear();
    settled = true;
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
        if (++tile.stage == 1 && !tile.shows_pixels() && tile.previewed_until == 0) tile.pixels = {};  // of before an edit that left no tree
        if (tile.stage < until && deadline.passed()) return false;
    }
    return true;
}

const Tile* Session::State::tile_at(int x, int y) const {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return nullptr;
    return &tiles[static_cast<std::size_t>(y / tile_size()) * tiles_across() + x / tile_size()];
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
        TileState& state = states.emplace_back(TileState{tile.stage, tile.shown_stage(), tile.bytes(), tile.going_on, distance(tile, attended)});
        if (tile.revision != edits || tile.unsettled) state.stage = std::min(state.stage, last), state.shown_stage = std::clamp(state.shown_stage, 0, last);  // never done
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

Expected<Session> Session::resume(scene::Scene scene, const std::filesystem::path& file) {
    auto session = open(std::move(scene));
    if (!session) return session;
    if (auto restored = session->restore(file); !restored) return tl::unexpected(std::move(restored.error()));
    return session;
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
            tile.changed = s.clock;
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
    const int corners = static_cast<int>(visible_stages(s.world->scene.settings).size());
    if (std::all_of(states.begin(), states.end(), [&](const TileState& state) { return state.shown_stage >= corners; })) s.seen = {};
    s.render_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    return s.progress(states);
}

Expected<EditReport> Session::edit(std::vector<scene::Edit> edits, const std::string& file) {
    State& s = *state_;
    const auto start = Clock::now();
    std::vector<scene::ShapeId> reshaped;  // what trees know of the old form would not fit the new one
    for (const scene::Edit& edit : edits) {
        if (const auto* shape = std::get_if<scene::SetShape>(&edit)) reshaped.push_back(shape->shape);
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
    if (auto given = give_accelerator(*now, before, change.same_geometry && same_accelerator(settings, now->scene.settings)); !given) {
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
        s.settled = true;
        s.cut_tiles();
    } else if (s.world->camera != old->camera) {
        ++s.edits;
        s.move_camera(*old);
    } else if (change.touches_trees()) {
        ++s.edits;
        s.settled = false;
        old->accelerator.reset();
        s.steps.push_back({std::move(old), std::move(change)});
    }
    report.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return report;
}

Expected<std::uint64_t> Session::save(const std::filesystem::path& file, const std::string& note) {
    State& s = *state_;
    s.catch_up(Deadline::never());
    const SessionCounts counts{s.level_seconds, s.level_rays,    s.past_rays,     s.past_tests, s.render_seconds,
                               s.peak_bytes,    s.drops,         s.dropped_bytes, s.dropped_nodes, s.revised};
    return write_checkpoint(file, *s.world, note, counts, s.tiles);
}

Expected<void> Session::restore(const std::filesystem::path& file) {
    State& s = *state_;
    auto checkpoint = read_checkpoint(file, *s.world);
    if (!checkpoint) return tl::unexpected(std::move(checkpoint.error()));
    // The trees come with the settings by which they grew; those of the session are an edit of them.
    const scene::Settings settings = s.world->scene.settings;
    scene::Settings grown_by = settings;
    copy_tree_settings(checkpoint->head.settings, grown_by);
    if (grown_by != settings) {
        if (auto set = edit({scene::SetSettings{grown_by}}); !set) return tl::unexpected(std::move(set.error()));
    }
    s.steps.clear();
    s.settled = true;
    s.seen = {};
    s.tiles = std::move(checkpoint->tiles);
    ++s.clock;
    for (Tile& tile : s.tiles) tile.revision = s.edits, tile.changed = s.clock;
    SessionCounts& counts = checkpoint->head.counts;
    s.level_seconds = std::move(counts.level_seconds), s.level_rays = std::move(counts.level_rays);
    s.past_rays = counts.past_rays, s.past_tests = counts.past_tests, s.render_seconds = counts.render_seconds;
    s.peak_bytes = counts.peak_bytes, s.drops = counts.drops, s.dropped_bytes = counts.dropped_bytes, s.dropped_nodes = counts.dropped_nodes;
    s.revised = counts.revised;
    if (grown_by == settings) return {};
    return edit({scene::SetSettings{settings}}).map([](const EditReport&) {});
}

scene::Image Session::picture(bool all_layers) const {
    State& s = *state_;
    if (!all_layers) {
        Frame frame;
        refresh(frame);
        return std::move(frame.image);
    }
    s.catch_up(Deadline::never());  // layers speak of the scene as it is
    scene::Image image = blank_image(s.width(), s.height(), true);
    s.pool.for_each(s.tiles.size(), [&](std::size_t i) {
        const Tile& tile = s.tiles[i];
        expose(tile.shows_pixels() ? s.regrown(tile) : tile, *s.world, s.level_of_stage, image);
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

std::vector<Area> Session::refresh(Frame& frame) const {
    const State& s = *state_;
    scene::Image& image = frame.image;
    if (image.width != s.width() || image.height != s.height() || image.layers.size() != 1) frame = {blank_image(s.width(), s.height(), false), 0};
    std::vector<const Tile*> changed;
    std::vector<Area> areas;
    for (const Tile& tile : s.tiles) {
        if (tile.changed <= frame.time) continue;
        changed.push_back(&tile);
        areas.push_back({tile.x0, tile.y0, tile.width, tile.height});
    }
    s.pool.for_each(changed.size(), [&](std::size_t i) { expose(*changed[i], *s.world, s.level_of_stage, image); });
    frame.time = s.clock;
    return areas;
}

void Session::look_at(const Area& area) { state_->attended = area; }

const scene::Scene& Session::scene() const { return state_->world->scene; }

std::string Session::describe(int x, int y) {
    State& s = *state_;
    s.catch_up(Deadline::never());
    const Tile* tile = s.tile_at(x, y);
    if (!tile) return {};
    return describe_pixel(tile->shows_pixels() ? s.regrown(*tile) : *tile, *s.world, x - tile->x0, y - tile->y0);
}

std::optional<Pick> Session::pick(int x, int y) {
    State& s = *state_;
    s.catch_up(Deadline::never());
    const Tile* tile = s.tile_at(x, y);
    if (!tile) return {};
    const Tile regrown = tile->shows_pixels() ? s.regrown(*tile) : Tile{};
    const Tile& trees = tile->shows_pixels() ? regrown : *tile;
    const std::uint32_t root = root_near(trees, x - tile->x0, y - tile->y0);
    if (root == no_node || trees.nodes[root].left_scene()) return {};
    const Node& node = trees.nodes[root];
    const bool named = node.material < s.world->scene.materials.size();
    return Pick{scene::path_to(s.world->scene, s.world->identity[node.instance]), node.primitive, named ? scene::MaterialId{node.material} : scene::MaterialId{},
                node.position, {node.normal[0], node.normal[1], node.normal[2]}};
}

}  // namespace crescente::render
