#include "render/session.h"

#include <algorithm>
#include <utility>

#include "render/checkpoint.h"
#include "render/describe.h"
#include "render/film.h"
#include "render/level_visible.h"
#include "render/session_state.h"
#include "scene/hierarchy.h"

namespace crescente::render {

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
                forget_picture(tile);
                return tile.trim();
            }
            s.drop_finished(tile);
        });
        s.level_rays[level] += rays_of() - before;
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
    const int corners = stages_to_all_roots(s.world->scene.settings);
    if (std::all_of(states.begin(), states.end(), [&](const TileState& state) { return state.shown_stage >= corners; })) release(s.seen);
    s.render_seconds += std::chrono::duration<double>(Clock::now() - start).count();
    Progress progress = s.progress(states);
    if (progress.done && !s.is_finished) s.finished = s.clock;
    s.is_finished = progress.done;
    return progress;
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

    s.is_finished = false;
    EditReport report{std::move(*undo)};
    World& before = *s.world;
    auto now = world_without_accelerator(std::move(before.scene), &before);
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
        s.settled = true;
        s.cut_tiles();
    } else if (const auto picture = s.world->camera != old->camera ? s.seen_anew(*old) : std::nullopt) {
        ++s.edits;
        s.begin_anew(*picture);
    } else if (change.touches_trees() || !s.steps.empty()) {  // what the steps before changed refers to the worlds on either side
        ++s.edits;
        s.settled = false;
        old->accelerator.reset();
        s.steps.push_back({std::move(old), std::move(change)});
    }
    if (settings.denoise != s.world->scene.settings.denoise) {
        ++s.clock;
        for (Tile& tile : s.tiles) tile.changed = s.clock;
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

void Session::look_at(const Area& area) {
    const auto clip = [](int first, int extent, int whole) {
        const auto from = std::clamp<std::int64_t>(first, 0, whole), to = std::clamp<std::int64_t>(std::int64_t{first} + extent, 0, whole);
        return std::pair(static_cast<int>(from), static_cast<int>(to - from));
    };
    const auto [x, width] = clip(area.x, area.width, state_->width());
    const auto [y, height] = clip(area.y, area.height, state_->height());
    state_->attended = {x, y, width, height};
}

const scene::Scene& Session::scene() const { return state_->world->scene; }

PixelTrees Session::trees(int x, int y) {
    State& s = *state_;
    s.catch_up(Deadline::never());
    const Tile* tile = s.tile_at(x, y);
    if (!tile) return {};
    return trees_of_pixel(tile->shows_pixels() ? s.regrown(*tile) : *tile, *s.world, x - tile->x0, y - tile->y0);
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
    const std::uint32_t face = geometry::face_number(*s.world->instances[node.instance].shape, node.primitive);
    return Pick{scene::path_to(s.world->scene, s.world->identity[node.instance]), face, named ? scene::MaterialId{node.material} : scene::MaterialId{},
                node.position, {node.normal[0], node.normal[1], node.normal[2]}};
}

}  // namespace crescente::render
