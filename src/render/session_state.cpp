#include "render/session_state.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <numeric>
#include <utility>

#include "render/film.h"
#include "render/level_visible.h"
#include "render/preview.h"
#include "render/revision.h"

namespace crescente::render {
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

std::span<const Rgb> Session::State::displayed_by(std::size_t tile) const {
    return tile < displayed.size() && displayed[tile].time >= tiles[tile].changed ? displayed[tile].pixels : std::span<const Rgb>{};
}

bool Session::State::revise(Tile& tile, bool watched) {
    if (tile.revision == edits) return false;
    std::span<const Rgb> picture = displayed_by(static_cast<std::size_t>(&tile - tiles.data()));
    for (std::size_t i = steps.size() - static_cast<std::size_t>(edits - tile.revision); i < steps.size(); ++i) {
        render::revise(tile, *steps[i].before, i + 1 < steps.size() ? *steps[i + 1].before : *world, steps[i].change, watched, picture);
        picture = {};
    }
    if (tile.unsettled || tile.nodes.empty()) ++revised, tile.changed = clock;
    if (!tile.samples.empty()) tile.changed = clock;  // it is filtered again, with its neighbours
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
    tiles = render::cut_tiles(world->scene.settings);
    release(seen), release(displayed);
    ++clock;
    for (Tile& tile : tiles) tile.revision = edits, tile.changed = clock;
}

std::optional<Reprojected> Session::State::seen_anew(const World& before) try {
    const std::size_t pixels = static_cast<std::size_t>(width()) * static_cast<std::size_t>(height());
    const auto ceiling = static_cast<std::uint64_t>(world->scene.settings.memory);
    constexpr std::uint64_t bytes = 64, share = 4;  // a pixel, in all that is needed here; of what may be kept
    if (ceiling > 0 && pixels * bytes > ceiling / share) return {};
    const auto has_corners = [&](const Tile& tile) { return tile.stage >= stages_to_all_roots(world->scene.settings); };
    if (seen.empty() || std::all_of(tiles.begin(), tiles.end(), has_corners)) {
        seen.assign(pixels, {});
        pool.for_each(tiles.size(), [&](std::size_t i) { take_points(tiles[i], displayed_by(i), before.environment.backdrop(), width(), seen); });
    }
    return reproject(seen, world->camera, width(), height(), pool);
} catch (const std::bad_alloc&) {
    release(seen);
    return {};
}

void Session::State::begin_anew(const Reprojected& picture) {
    const int shadows = first_stage(level_of_stage, scene::Level::shadows);
    const bool reuse = world->scene.settings.memory == 0;
    ++clock;
    pool.for_each(tiles.size(), [&](std::size_t i) {
        Tile& tile = tiles[i];
        std::vector<Rgb> pixels;
        std::size_t holes = 0;
        for (int y = tile.y0; y < tile.y0 + tile.height; ++y) {
            const auto first = static_cast<std::ptrdiff_t>(y) * width() + tile.x0;
            pixels.insert(pixels.end(), picture.pixels.begin() + first, picture.pixels.begin() + first + tile.width);
            holes += static_cast<std::size_t>(std::count(picture.seen.begin() + first, picture.seen.begin() + first + tile.width, 0));
        }
        Tile fresh = without_trees(tile, std::move(pixels));
        fresh.revision = edits, fresh.changed = clock;
        constexpr std::size_t few = 4;  // with more of it guessed the coarse picture is the better one
        if (holes * few < fresh.pixels.size()) {
            fresh.previewed_until = std::min(shadows + 1, static_cast<int>(level_of_stage.size()));
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
        keep_picture(tile);
        tile.pixels_stage = tile.stage;
    }
    Growth growth(*world, tile, unseen);
    while (tile.stage < until) {
        const Stage& stage = stages[static_cast<std::size_t>(tile.stage)];
        if (!kind_of(stage.level).advance(growth, stage, deadline)) return false;
        tile.cursor = 0;
        if (++tile.stage == 1 && !tile.shows_pixels() && tile.previewed_until == 0) release(tile.pixels), release(tile.clear_pixels);  // of before an edit that left no tree
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

}  // namespace crescente::render
