#include "render/level_edges.h"

#include <numeric>

namespace crescente::render {
namespace {

// A scale on which equal steps look about equal: square root of the clipped radiance, as display gamma does.
Rgb perceived(Rgb radiance) {
    const auto f = [](float v) { return std::sqrt(std::clamp(v, 0.0f, 1.0f)); };
    return {f(radiance.r), f(radiance.g), f(radiance.b)};
}

bool differ(const std::array<Rgb, 4>& corners, float contrast) {
    Rgb low = corners[0], high = corners[0];
    for (const Rgb& c : corners) {
        low = {std::min(low.r, c.r), std::min(low.g, c.g), std::min(low.b, c.b)};
        high = {std::max(high.r, c.r), std::max(high.g, c.g), std::max(high.b, c.b)};
    }
    return max_component(high - low) > contrast;
}

void make_pixel_quads(Tile& tile) {
    tile.quads.reserve(static_cast<std::size_t>(tile.width) * tile.height);
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            tile.quads.push_back({{tile.corner(x, y), tile.corner(x + 1, y), tile.corner(x, y + 1), tile.corner(x + 1, y + 1)}, no_node});
        }
    }
}

// Where the quads of one depth stand on the lattice of the picture.
struct Place {
    std::uint32_t quad;
    LatticePoint at;
};

// The quads of this depth (0: pixels), in a fixed order.
std::vector<Place> quads_at_depth(const Tile& tile, int depth) {
    std::vector<Place> places;
    places.reserve(static_cast<std::size_t>(tile.width) * tile.height);
    std::uint32_t i = 0;
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x, ++i) {
            places.push_back({i, corner_point(tile.x0 + x, tile.y0 + y)});
        }
    }
    for (int d = 0; d < depth; ++d) {
        const std::uint32_t half = (1u << subpixel_bits) >> (d + 1);
        std::vector<Place> inner;
        inner.reserve(tile.quads.size());
        for (const Place& place : places) {
            const std::uint32_t parts = tile.quads[place.quad].parts;
            if (parts == no_node) continue;
            for (std::uint32_t k = 0; k < 4; ++k) {
                inner.push_back({parts + k, {place.at.x + (k & 1 ? half : 0), place.at.y + (k & 2 ? half : 0)}});
            }
        }
        places = std::move(inner);
    }
    return places;
}

// The five points that split a quad of this size: middle of the top, left, centre, right, bottom.
std::array<LatticePoint, 5> split_points(LatticePoint at, std::uint32_t size) {
    const std::uint32_t half = size / 2;
    return {{{at.x + half, at.y}, {at.x, at.y + half}, {at.x + half, at.y + half}, {at.x + size, at.y + half}, {at.x + half, at.y + size}}};
}

void keep_roots_of_parts(const std::vector<Quad>& quads, const Quad& quad, LatticePoint at, std::uint32_t size, Tile& tile) {
    if (quad.parts == no_node) return;
    const std::uint32_t half = size / 2;
    const auto points = split_points(at, size);
    const auto root = [&](std::uint32_t part, std::uint32_t corner) { return quads[quad.parts + part].corners[corner]; };
    const std::array roots{root(0, 1), root(0, 2), root(0, 3), root(1, 3), root(2, 3)};
    for (std::size_t k = 0; k < points.size(); ++k) {
        if (roots[k] != no_node) tile.subpixel_roots.emplace(key_of(points[k]), roots[k]);
    }
    for (std::uint32_t k = 0; k < 4; ++k) keep_roots_of_parts(quads, quads[quad.parts + k], {at.x + (k & 1 ? half : 0), at.y + (k & 2 ? half : 0)}, half, tile);
}

void keep_roots(const std::vector<Quad>& quads, Tile& tile) {
    if (quads.empty()) return;
    for (const Place& place : quads_at_depth(tile, 0)) keep_roots_of_parts(quads, quads[place.quad], place.at, 1u << subpixel_bits, tile);
}

// Those of the pixels that the places lie in, and of their neighbours, which share corners with them.
void keep_roots_around(const std::vector<Place>& places, std::span<const std::uint32_t> chosen, Tile& tile) {
    std::vector<std::uint8_t> wanted(static_cast<std::size_t>(tile.width) * tile.height);
    for (const std::uint32_t i : chosen) {
        const int x = static_cast<int>(places[i].at.x >> subpixel_bits) - tile.x0, y = static_cast<int>(places[i].at.y >> subpixel_bits) - tile.y0;
        for (int v = std::max(0, y - 1); v <= std::min(tile.height - 1, y + 1); ++v) {
            for (int u = std::max(0, x - 1); u <= std::min(tile.width - 1, x + 1); ++u) wanted[static_cast<std::size_t>(v) * tile.width + u] = 1;
        }
    }
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        if (!wanted[i]) continue;
        const LatticePoint at = corner_point(tile.x0 + static_cast<int>(i) % tile.width, tile.y0 + static_cast<int>(i) / tile.width);
        keep_roots_of_parts(tile.quads, tile.quads[i], at, 1u << subpixel_bits, tile);
    }
}

// For what splitting will add, as far as can be told: about four corners each, most shared with neighbours, with trees as large as those there are.
void make_room(Tile& tile) {
    if (tile.all_lit > 0) return;  // little is added after an edit
    const std::size_t roots = tile.corners.size() + tile.subpixel_roots.size(), more_roots = 4 * tile.todo.size(), more = more_roots * tile.nodes.size() / roots;
    tile.subpixel_roots.reserve(tile.subpixel_roots.size() + more_roots);
    tile.nodes.reserve(tile.nodes.size() + more);
    tile.shares.reserve(tile.shares.size() + more * tile.shares.size() / tile.nodes.size());
}

}  // namespace

void unsplit(Tile& tile, const scene::Settings& settings) {
    const bool splits = settings.supersampling > 0 && settings.level >= scene::Level::edges;
    if (splits) keep_roots(tile.quads, tile), keep_roots(tile.quads_before, tile);
    if (!tile.quads.empty()) tile.quads_before = std::move(tile.quads);
    tile.quads = {};
    if (!splits) release(tile.quads_before), release(tile.subpixel_roots);
}

bool can_go_on(const Tile& tile, const Stage& stage) {
    const int depth = static_cast<int>(stage.parameter) - 1;
    if (tile.quads.empty() || tile.cursor > tile.todo.size() + 1) return false;
    const std::vector<Place> places = quads_at_depth(tile, depth);
    for (std::size_t i = 0; i < tile.todo.size(); ++i) {
        if (tile.todo[i] >= places.size()) return false;
        if (i + 1 >= tile.cursor) continue;  // not done yet
        for (const LatticePoint& p : split_points(places[tile.todo[i]].at, (1u << subpixel_bits) >> depth)) {
            if (!tile.subpixel_roots.contains(key_of(p))) return false;
        }
    }
    return true;
}

std::vector<Stage> edges_stages(const scene::Settings& settings) {
    std::vector<Stage> stages;
    for (int depth = 1; depth <= settings.supersampling; ++depth) stages.push_back({scene::Level::edges, double(depth), 1.5});
    return stages;
}

bool advance_edges(Growth& growth, const Stage& stage, const Deadline& deadline) {
    Tile& tile = growth.tile();
    const int depth = static_cast<int>(stage.parameter) - 1;  // of the quads that may be split now
    const std::uint32_t size = (1u << subpixel_bits) >> depth;
    if (tile.quads.empty()) make_pixel_quads(tile);
    const std::vector<Place> places = quads_at_depth(tile, depth);

    if (tile.cursor == 0) {  // decide once, from what the stages before left
        // Splitting adds trees and leaves those that are there as they are.
        std::vector<Rgb>& radiance = growth.radiance_before_splits();
        if (depth == 0) radiance.clear();
        append_radiances(tile, radiance);
        const std::vector<float> clear = clearness(tile);
        tile.todo.clear();
        std::vector<std::uint32_t> whole_again;  // quads that were split before an edit
        bool split_before = false;
        for (std::uint32_t i = 0; i < places.size(); ++i) {
            Quad& quad = tile.quads[places[i].quad];
            std::array<Rgb, 4> corners;
            for (int k = 0; k < 4; ++k) corners[k] = perceived(radiance[quad.corners[k]]);
            std::array<float, 4> clear_corners{};
            for (int k = 0; k < 4 && !clear.empty(); ++k) clear_corners[k] = clear[quad.corners[k]];
            const auto contrast = static_cast<float>(growth.settings().contrast);
            const auto [least, most] = std::minmax_element(clear_corners.begin(), clear_corners.end());
            const bool split = differ(corners, contrast) || *most - *least > contrast;
            split_before = split_before || quad.parts != no_node;
            if (split && quad.parts == no_node) {
                tile.todo.push_back(i);
            } else if (!split && quad.parts != no_node) {
                whole_again.push_back(places[i].quad);
            }
        }
        // Corners that are there already are found by their place.
        if (!tile.todo.empty() && split_before) keep_roots_around(places, tile.todo, tile);
        for (const std::uint32_t quad : whole_again) tile.quads[quad].parts = no_node;
        tile.forgotten += whole_again.size();
        tile.cursor = 1;
        make_room(tile);
    }

    // New corners, a chunk at a time, each grown to the end before the next. `todo` lists places by index; the cursor is one more than
    // those done.
    const bool shortcut = growth.settings().subpixel_shortcut != scene::SubpixelShortcut::off;
    while (true) {
        if (!growth.grow_above(tile.growing, growth.settings().threshold, deadline)) return false;
        tile.pending.insert(tile.pending.end(), tile.growing.begin(), tile.growing.end());
        tile.growing.clear();
        if (tile.cursor - 1 == tile.todo.size()) break;

        std::vector<LatticePoint> points;
        std::vector<std::array<std::uint32_t, 4>> tried_first;
        const std::size_t end = std::min(tile.todo.size(), tile.cursor - 1 + chunk_size / 4);
        for (std::size_t i = tile.cursor - 1; i < end; ++i) {
            const Place& place = places[tile.todo[i]];
            for (const LatticePoint& p : split_points(place.at, size)) {
                const auto [entry, fresh] = tile.subpixel_roots.try_emplace(key_of(p), static_cast<std::uint32_t>(tile.nodes.size() + points.size()));
                if (!fresh) continue;
                points.push_back(p);
                if (shortcut) tried_first.push_back(tile.quads[place.quad].corners);
            }
        }
        const std::uint32_t first = growth.add_roots(points, tried_first);
        std::vector<std::uint32_t> roots(points.size());
        std::iota(roots.begin(), roots.end(), first);
        growth.light_and_spawn(roots, accel::Coherence::coherent, tile.growing);
        tile.cursor = end + 1;
        if (deadline.passed()) return false;
    }

    for (const std::uint32_t i : tile.todo) {
        const Place& place = places[i];
        std::array<std::uint32_t, 5> m;
        const auto points = split_points(place.at, size);
        for (int k = 0; k < 5; ++k) m[k] = tile.subpixel_roots.at(key_of(points[k]));
        const auto c = tile.quads[place.quad].corners;
        tile.quads[place.quad].parts = static_cast<std::uint32_t>(tile.quads.size());
        tile.quads.push_back({{c[0], m[0], m[1], m[2]}, no_node});
        tile.quads.push_back({{m[0], c[1], m[2], m[3]}, no_node});
        tile.quads.push_back({{m[1], m[2], c[2], m[4]}, no_node});
        tile.quads.push_back({{m[2], m[3], m[4], c[3]}, no_node});
    }
    tile.todo.clear();
    release(tile.growing);
    if (stage.parameter == growth.settings().supersampling) {
        release(tile.subpixel_roots);
        release(tile.quads_before);
    }
    return true;
}

}  // namespace crescente::render
