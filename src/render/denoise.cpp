#include "render/denoise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/octahedral.h"
#include "render/catcher.h"
#include "render/surface_lobes.h"

namespace crescente::render {
namespace {

constexpr int deepest = 3;             // bounces after which nodes weigh too little to be filtered
constexpr std::uint32_t own_way = 1;   // of roots; each bounce adds two bits
constexpr std::uint32_t caught_way = 1u << 31;  // is added for nodes that catch

// A node that has samples, and all that the filter needs to know of it.
struct NoisyNode {
    std::uint32_t node;
    std::uint32_t way;       // by which the pixel sees it
    float x, y;              // where its root is, in pixels of the picture
    Guide guide;
    FilteredLight light;
    Rgb diffuse_color, glossy_color;  // of the surface, which light is without
    float trust;             // share that its own samples have in what is shown; the rest is the filter's

    bool catches() const { return way & caught_way; }  // then the diffuse light is as_caught()
};

class NoisyNodes {
public:
    NoisyNodes(const World& world, const Tile& tile) : world_(world), tile_(tile), depths_(split_depths(tile)), visited_(tile.nodes.size()) {}

    std::vector<NoisyNode> find() {
        if (tile_.samples.empty() || tile_.corners.empty()) return {};
        for (int y = 0; y <= tile_.height; ++y) {
            for (int x = 0; x <= tile_.width; ++x) add_tree(tile_.corner(x, y), static_cast<float>(tile_.x0 + x), static_cast<float>(tile_.y0 + y));
        }
        if (tile_.quads.empty()) return std::move(found_);
        std::uint32_t quad = 0;
        for (int y = 0; y < tile_.height; ++y) {
            for (int x = 0; x < tile_.width; ++x) add_parts(quad++, static_cast<float>(tile_.x0 + x), static_cast<float>(tile_.y0 + y), 1);
        }
        return std::move(found_);
    }

private:
    void add_parts(std::uint32_t i, float x, float y, float size) {
        const Quad& quad = tile_.quads[i];
        if (quad.parts == no_node) {
            for (std::uint32_t k = 0; k < 4; ++k) add_tree(quad.corners[k], x + (k & 1 ? size : 0), y + (k & 2 ? size : 0));
            return;
        }
        for (std::uint32_t k = 0; k < 4; ++k) add_parts(quad.parts + k, x + (k & 1 ? size / 2 : 0), y + (k & 2 ? size / 2 : 0), size / 2);
    }

    void add_tree(std::uint32_t root, float x, float y) {
        if (root == no_node || visited_[root]) return;
        visited_[root] = true;
        splits_ = split_depth(depths_, root).place;
        add(root, own_way, x, y, 0);
    }

    void add(std::uint32_t i, std::uint32_t way, float x, float y, int depth) {
        const Node& node = tile_.nodes[i];
        if (node.left_scene()) return;
        if (node.sampled && i < tile_.samples.size() && tile_.samples[i] > 0) found_.push_back(noisy(i, way, x, y));
        if (depth == deepest) return;
        for_each_child(tile_, i, [&](std::uint32_t child, Way next) { add(child, way << 2 | static_cast<std::uint32_t>(next), x, y, depth + 1); });
    }

    NoisyNode noisy(std::uint32_t i, std::uint32_t way, float x, float y) const {
        const Node& node = tile_.nodes[i];
        NoisyNode noisy{i, way, x, y, {}, {}, {1, 1, 1}, {1, 1, 1}, 0};
        if (catches(world_, tile_, i)) noisy.way |= caught_way;
        const Vec3 from_viewer = node.position - world_.camera.position();
        noisy.guide.position = {static_cast<float>(from_viewer.x), static_cast<float>(from_viewer.y), static_cast<float>(from_viewer.z)};
        noisy.guide.normal = node.normal;
        noisy.guide.surface = static_cast<std::uint32_t>(mix_bits(std::uint64_t{node.instance} << 32 | node.material)) >> 1;
        TexturedLobes scratch;
        const Lobes& lobes = lobes_of(world_, tile_, i, scratch);
        noisy.guide.roughness = roughness_of(lobes);
        if (world_.textured_material(node.material) && !noisy.catches()) {
            constexpr float darkest = 0.02f;
            const auto bright = [&](Rgb v) { return Rgb{std::max(v.r, darkest), std::max(v.g, darkest), std::max(v.b, darkest)}; };
            noisy.diffuse_color = bright(lobes.albedo);
            if (lobes.layered()) noisy.glossy_color = bright(lobes.highlight);
        }
        SampledParts parts = sampled_parts(world_, tile_, i);
        if (noisy.catches()) {
            const CaughtLight caught = caught_by_samples(world_, tile_, i);
            parts.diffuse = as_caught(caught.open, caught.all);
        }
        noisy.light.diffuse = over(parts.diffuse, noisy.diffuse_color), noisy.light.glossy = over(parts.glossy, noisy.glossy_color);
        noisy.light.luminance = noisy.catches() ? share_of(parts.diffuse) + luminance(parts.glossy) : luminance(noisy.light.diffuse + noisy.light.glossy);
        const double wanted = samples_wanted(world_, tile_, i, splits_), samples = tile_.samples[i];
        noisy.trust = samples >= wanted ? 1.0f : static_cast<float>(samples / wanted);
        if (noisy.catches()) {
            noisy.guide.aim = noisy.trust;
        } else if (parts.deviation >= 0) {
            const float seen = luminance(parts.diffuse + parts.glossy), bare = seen > 0 ? noisy.light.luminance / seen : 1;
            noisy.light.variance = parts.deviation * parts.deviation * bare * bare / static_cast<float>(samples);
            noisy.guide.aim = noisy.light.variance * noisy.trust;
        }
        return noisy;
    }

    // Of the sharpest lobe that is sampled.
    static float roughness_of(const Lobes& lobes) {
        float roughness = 1;  // of lobes along whose grain alone they are rough: across it
        if (lobes.highlight_lobe == HighlightLobe::phong || lobes.highlight_lobe == HighlightLobe::blinn) roughness = std::sqrt(2 / (lobes.exponent + 2));
        if (lobes.layered() && !lobes.smooth()) roughness = std::min(roughness, std::max(lobes.alpha, smoothest_alpha));
        if (lobes.coat > 0 && !lobes.coat_is_smooth()) roughness = std::min(roughness, lobes.coat_alpha);
        return roughness;
    }

    static Rgb over(Rgb a, Rgb b) { return {a.r / b.r, a.g / b.g, a.b / b.b}; }

    const World& world_;
    const Tile& tile_;
    const std::vector<SplitDepth> depths_;
    std::vector<bool> visited_;
    unsigned splits_ = 0;  // where the root is whose tree is looked at
    std::vector<NoisyNode> found_;
};

// The corners that are seen by one way.
struct Layer {
    GuidedGrid grid;
    int x0 = 0, y0 = 0;  // corner of the picture at its first point

    const Guide& guide(int x, int y) const { return grid.guides[index(x, y)]; }
    const FilteredLight& light(int x, int y) const { return grid.light[index(x, y)]; }
    bool contains(int x, int y) const { return x >= x0 && y >= y0 && x < x0 + grid.width && y < y0 + grid.height; }
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y - y0) * grid.width + (x - x0); }
};

bool is_corner(const NoisyNode& n) { return n.x == std::floor(n.x) && n.y == std::floor(n.y); }

// Of two tiles that repeat a corner the one to its right, or below, speaks for it.
bool speaks_for(const World& world, const Tile& tile, const NoisyNode& n) {
    const int x = static_cast<int>(n.x), y = static_cast<int>(n.y);
    const scene::Settings& settings = world.scene.settings;
    return is_corner(n) && (x < tile.x0 + tile.width || x == settings.width) && (y < tile.y0 + tile.height || y == settings.height);
}

Layer layer_of(const World& world, std::span<const Tile* const> tiles, const std::vector<std::vector<NoisyNode>>& nodes, std::uint32_t way, parallel::Pool& pool) {
    int x0 = std::numeric_limits<int>::max(), y0 = x0, x1 = 0, y1 = 0;
    const auto for_each_corner = [&](std::size_t t, auto&& visit) {
        for (const NoisyNode& n : nodes[t]) {
            if (n.way == way && speaks_for(world, *tiles[t], n)) visit(n, static_cast<int>(n.x), static_cast<int>(n.y));
        }
    };
    for (std::size_t t = 0; t < tiles.size(); ++t) {
        for_each_corner(t, [&](const NoisyNode&, int x, int y) { x0 = std::min(x0, x), y0 = std::min(y0, y), x1 = std::max(x1, x + 1), y1 = std::max(y1, y + 1); });
    }
    Layer layer;
    if (x1 <= x0) return layer;
    layer.x0 = x0, layer.y0 = y0;
    layer.grid.shares = way & caught_way;
    layer.grid.width = x1 - x0, layer.grid.height = y1 - y0;
    layer.grid.guides.resize(static_cast<std::size_t>(layer.grid.width) * layer.grid.height);
    layer.grid.light.resize(layer.grid.guides.size());
    pool.for_each(tiles.size(), [&](std::size_t t) {
        for_each_corner(t, [&](const NoisyNode& n, int x, int y) {
            layer.grid.guides[layer.index(x, y)] = n.guide;
            layer.grid.light[layer.index(x, y)] = n.light;
        });
    });
    return layer;
}

// What the filter has to say at a node: of a corner its own light, inside pixels the node's with that of the alike among the sixteen corners around. Nothing: no such corner.
bool look_up(const Layer& layer, const NoisyNode& n, FilteredLight& light) {
    const int x = static_cast<int>(std::floor(n.x)), y = static_cast<int>(std::floor(n.y));
    if (is_corner(n) && layer.contains(x, y) && layer.guide(x, y).surface == n.guide.surface) {
        light = layer.light(x, y);
        return true;
    }
    const bool told = n.light.variance >= 0 || n.catches();
    FilteredLight own_light = n.light;
    constexpr float own = 4;  // as much as the nearest corner can have
    float diffuse_weights = told ? own : 0, glossy_weights = diffuse_weights;
    light = {};
    if (told) light.diffuse = own * n.light.diffuse, light.glossy = own * n.light.glossy;
    for (int v = y - 1; v <= y + 2; ++v) {
        for (int u = x - 1; u <= x + 2; ++u) {
            if (!layer.contains(u, v)) continue;
            const float near = (2 - std::abs(n.x - static_cast<float>(u))) * (2 - std::abs(n.y - static_cast<float>(v)));
            const Alikeness alike = near > 0 ? alikeness(n.guide, layer.guide(u, v)) : Alikeness{};
            if (alike.diffuse == 0) continue;
            if (n.catches()) own_light.variance = layer.light(u, v).variance;
            const float weight = told ? near * likelihood(own_light, layer.light(u, v)) : near;
            diffuse_weights += weight * alike.diffuse, glossy_weights += weight * alike.glossy;
            light.diffuse += weight * alike.diffuse * layer.light(u, v).diffuse, light.glossy += weight * alike.glossy * layer.light(u, v).glossy;
        }
    }
    constexpr float enough = 0.05f;
    if (std::min(diffuse_weights, glossy_weights) < enough) return false;
    light.diffuse *= gray(1 / diffuse_weights), light.glossy *= gray(1 / glossy_weights);
    return true;
}

// What a catcher shows more of what is behind it by the filtered light.
float clearer(const NoisyNode& n, const FilteredLight& filtered, CaughtLight by_lamps) {
    const auto clear = [&](Rgb caught) { return CaughtLight{by_lamps.open + caught.g, by_lamps.all + caught.b}.clear(); };
    return clear(filtered.diffuse) - clear(n.light.diffuse);
}

}  // namespace

std::vector<Corrections> denoise(const World& world, std::span<const Tile* const> tiles, parallel::Pool& pool) {
    std::vector<Corrections> corrections(tiles.size());
    std::vector<std::vector<NoisyNode>> nodes(tiles.size());
    pool.for_each(tiles.size(), [&](std::size_t t) {
        if (tiles[t]) nodes[t] = NoisyNodes(world, *tiles[t]).find();
    });
    std::vector<std::uint32_t> ways;  // by which something is seen that wants more samples
    for (const auto& of_tile : nodes) {
        for (const NoisyNode& n : of_tile) {
            if (n.trust < 1 && std::find(ways.begin(), ways.end(), n.way) == ways.end()) ways.push_back(n.way);
        }
    }
    const bool apart = world.environment.source().transparent;
    for (const std::uint32_t way : ways) {
        Layer layer = layer_of(world, tiles, nodes, way, pool);
        filter(layer.grid, pool);
        pool.for_each(tiles.size(), [&](std::size_t t) {
            TexturedLobes scratch;
            for (const NoisyNode& n : nodes[t]) {
                FilteredLight light;
                if (n.way != way || n.trust == 1 || !look_up(layer, n, light)) continue;
                if (corrections[t].radiance.empty()) corrections[t].radiance.resize(tiles[t]->nodes.size());
                Rgb difference = n.glossy_color * (light.glossy - n.light.glossy);
                if (n.catches()) {
                    const float clear = clearer(n, light, caught_by_lamps(world, *tiles[t], n.node)) * lobes_of(world, *tiles[t], n.node, scratch).opacity;
                    difference += seen_behind(world, tiles[t]->nodes[n.node].position) * clear;
                    if (corrections[t].clear.empty() && apart) corrections[t].clear.resize(tiles[t]->nodes.size());
                    if (apart) corrections[t].clear[n.node] = clear * (1 - n.trust);
                } else {
                    difference += n.diffuse_color * (light.diffuse - n.light.diffuse);
                }
                corrections[t].radiance[n.node] = difference * (1 - n.trust);
            }
        });
    }
    return corrections;
}

}  // namespace crescente::render
