#include "render/forest.h"

#include <algorithm>

namespace crescente::render {

namespace {

// The sum over all columns of a tile of what `length` says of each; maps by entry and bucket.
template <class Length>
std::size_t sum_columns(const Tile& tile, Length length) {
    const auto vector_bytes = [&](const auto& column) { return length(column) * sizeof(column[0]); };
    const auto map_bytes = [](const auto& map) {
        using Value = typename std::remove_cvref_t<decltype(map)>::value_type;
        return map.size() * (sizeof(Value) + sizeof(void*)) + map.bucket_count() * sizeof(void*);
    };
    return vector_bytes(tile.nodes) + vector_bytes(tile.shares) + vector_bytes(tile.samples) + vector_bytes(tile.estimates) + vector_bytes(tile.lens_samples) +
           vector_bytes(tile.lens_estimates) + vector_bytes(tile.lens_pixels) + vector_bytes(tile.lens_clear) + vector_bytes(tile.unsampled) + vector_bytes(tile.corners) +
           vector_bytes(tile.pending) + vector_bytes(tile.growing) + vector_bytes(tile.quads) + vector_bytes(tile.quads_before) + vector_bytes(tile.todo) + vector_bytes(tile.pixels) + vector_bytes(tile.clear_pixels) + map_bytes(tile.filtered) + map_bytes(tile.straight) + map_bytes(tile.subpixel_roots);
}

}  // namespace

std::size_t Tile::bytes() const {
    return sum_columns(*this, [](const auto& column) { return column.capacity(); });
}

std::size_t Tile::filled_bytes() const {
    return sum_columns(*this, [](const auto& column) { return column.size(); });
}

void Tile::trim() {
    // A little is not worth copying the rest.
    const auto shrink = [](auto& column) {
        if (column.capacity() - column.size() > column.size() / 16) column.shrink_to_fit();
    };
    shrink(nodes), shrink(shares), shrink(samples), shrink(estimates), shrink(pending), shrink(quads), shrink(todo);
}

void show_without_samples(Tile& tile) {
    release(tile.unsampled);
    for (Node& node : tile.nodes) {
        if (!node.sampled) continue;
        node.sampled = node.samples_reflection = node.samples_refraction = false;
        node.shadowed = false;
    }
}

void forget_samples(Tile& tile) {
    show_without_samples(tile);
    for (Node& node : tile.nodes) node.outdated = false;
    release(tile.samples), release(tile.estimates);
    release(tile.lens_samples), release(tile.lens_estimates), release(tile.lens_pixels), release(tile.lens_clear);
    tile.lens_piloted = false;
}

void forget_samples(Tile& tile, std::uint32_t node) {
    const std::size_t groups = tile.estimates.size() / tile.samples.size();
    tile.samples[node] = 0;
    tile.nodes[node].outdated = false;
    std::fill_n(tile.estimates.begin() + static_cast<std::ptrdiff_t>(node * groups), groups, Estimate{});
}

std::vector<SplitDepth> split_depths(const Tile& tile) {
    const std::size_t pixels = static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height);
    if (tile.quads.size() <= pixels) return {};
    std::vector<SplitDepth> of_nodes(tile.nodes.size());
    std::vector<std::uint8_t> of_quads(tile.quads.size(), SplitDepth::none);
    std::fill_n(of_quads.begin(), pixels, std::uint8_t{0});
    for (std::size_t q = 0; q < tile.quads.size(); ++q) {  // parts come after what they are parts of
        if (of_quads[q] == SplitDepth::none) continue;      // given up by an edit
        const Quad& quad = tile.quads[q];
        for (std::uint32_t k = 0; k < 4; ++k) {
            if (quad.parts != no_node) of_quads[quad.parts + k] = static_cast<std::uint8_t>(of_quads[q] + 1);
            if (quad.corners[k] == no_node) continue;
            SplitDepth& depth = of_nodes[quad.corners[k]];
            depth.place = std::min(depth.place, of_quads[q]);
            if (quad.parts == no_node) depth.parts = std::min(depth.parts, of_quads[q]);
        }
    }
    return of_nodes;
}

std::vector<Tile> cut_tiles(const scene::Settings& settings) {
    std::vector<Tile> tiles;
    for (int y = 0; y < settings.height; y += settings.tile) {
        for (int x = 0; x < settings.width; x += settings.tile) {
            Tile& tile = tiles.emplace_back();
            tile.x0 = x, tile.y0 = y;
            tile.width = std::min(settings.tile, settings.width - x), tile.height = std::min(settings.tile, settings.height - y);
        }
    }
    return tiles;
}

Tile blank_tile(const Tile& place) {
    Tile tile;
    tile.x0 = place.x0, tile.y0 = place.y0, tile.width = place.width, tile.height = place.height;
    tile.revision = place.revision;
    tile.changed = place.changed;
    return tile;
}

Rgb influence(const Tile& tile, std::uint32_t node) {
    std::array<std::uint32_t, 256> way;  // upwards: as many as Node::depth can count
    std::size_t steps = 0;
    for (std::uint32_t i = node; i != no_node; i = tile.nodes[i].parent) way[steps++] = i;
    Rgb product = tile.nodes[way[--steps]].weight;
    while (steps > 0) product *= tile.nodes[way[--steps]].weight;
    return product;
}

std::vector<Rgb> radiances(const Tile& tile, const Corrections& corrections) {
    std::vector<Rgb> result(tile.nodes.size());
    for (std::size_t i = tile.nodes.size(); i-- > 0;) {
        const Rgb correction = corrections.radiance.empty() ? Rgb{} : corrections.radiance[i];
        result[i] = radiance_above(tile, static_cast<std::uint32_t>(i), [&](std::uint32_t child) { return result[child]; }, correction);
    }
    return result;
}

void append_radiances(const Tile& tile, std::vector<Rgb>& known) {
    const std::size_t first = known.size();
    known.resize(tile.nodes.size());
    for (std::size_t i = tile.nodes.size(); i-- > first;) {
        known[i] = radiance_above(tile, static_cast<std::uint32_t>(i), [&](std::uint32_t child) { return known[child]; });
    }
}

std::vector<float> clearness(const Tile& tile, const Corrections& corrections) {
    if (corrections.clear.empty() && !tile.keeps_clear) return {};
    std::vector<float> result(tile.nodes.size());
    for (std::size_t i = tile.nodes.size(); i-- > 0;) {
        float sum = static_cast<float>(tile.nodes[i].clear) / float{all_clear} + (corrections.clear.empty() ? 0 : corrections.clear[i]);
        for_each_child(tile, static_cast<std::uint32_t>(i), [&](std::uint32_t child, Way) { sum += luminance(tile.nodes[child].weight) * result[child]; });
        result[i] = sum;
    }
    return result;
}

}  // namespace crescente::render
