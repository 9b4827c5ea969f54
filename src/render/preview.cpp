#include "render/preview.h"

#include <algorithm>
#include <numeric>

#include "render/level.h"
#include "render/level_visible.h"

namespace crescente::render {
namespace {

constexpr int step = coarsest_grid;

// Nodes that are not lit, or that one below is not, by node.
std::vector<std::uint8_t> unlit(const Tile& tile) {
    std::vector<std::uint8_t> result(tile.nodes.size());
    for (std::size_t i = tile.nodes.size(); i-- > 0;) {
        const Node& node = tile.nodes[i];
        if (!node.shadowed && !node.left_scene()) result[i] = 1;
        if (result[i] && node.parent != no_node) result[node.parent] = 1;
    }
    return result;
}

void collect_unlit(const Tile& tile, std::uint32_t root, std::vector<std::uint32_t>& nodes) {
    if (!tile.nodes[root].shadowed && !tile.nodes[root].left_scene()) nodes.push_back(root);
    for_each_child(tile, root, [&](std::uint32_t child, Way) { collect_unlit(tile, child, nodes); });
}

Rgb radiance_of(const Tile& tile, std::uint32_t root) {
    return radiance_above(tile, root, [&](std::uint32_t child) { return radiance_of(tile, child); });
}

struct Corner {
    bool lit_anew;
    Rgb before, now;
};

class Preview {
public:
    // sends_rays: all nodes of the tile have sent theirs.
    Preview(Tile& tile, const World& world, bool sends_rays) : tile_(tile), growth_(world, tile, false), sends_rays_(sends_rays) {}

    void run() {
        unlit_ = unlit(tile_);
        mark_pixels();
        grow_corners();
        for (int y = 0; y < tile_.height; ++y) {
            for (int x = 0; x < tile_.width; ++x) show(x, y);
        }
    }

private:
    enum class Mark : std::uint8_t { as_it_was, lit_anew, missing };

    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(tile_.width) + static_cast<std::size_t>(x); }

    void mark_pixels() {
        marks_.assign(static_cast<std::size_t>(tile_.width) * static_cast<std::size_t>(tile_.height), Mark::as_it_was);
        for (int y = 0; y < tile_.height; ++y) {
            for (int x = 0; x < tile_.width; ++x) {
                Mark& mark = marks_[index(x, y)];
                for (int k = 0; k < 4; ++k) {
                    const std::uint32_t root = tile_.corner(x + (k & 1), y + (k >> 1));
                    mark = std::max(mark, root == no_node ? Mark::missing : unlit_[root] ? Mark::lit_anew : Mark::as_it_was);
                }
            }
        }
    }

    // The coordinates of the grid's lines up to an extent, which has one too.
    static std::vector<int> lines(int extent) {
        std::vector<int> result;
        for (int c = 0; c < extent; c += step) result.push_back(c);
        result.push_back(extent);
        return result;
    }

    // The corners of the grid around cells in which something is to be shown: missing ones get roots, all of them light.
    void grow_corners() {
        columns_ = lines(tile_.width), rows_ = lines(tile_.height);
        std::vector<std::uint8_t> wanted(columns_.size() * rows_.size());
        for (int y = 0; y < tile_.height; ++y) {
            for (int x = 0; x < tile_.width; ++x) {
                if (marks_[index(x, y)] == Mark::as_it_was) continue;
                const std::size_t first = static_cast<std::size_t>(y / step) * columns_.size() + static_cast<std::size_t>(x / step);
                wanted[first] = wanted[first + 1] = wanted[first + columns_.size()] = wanted[first + columns_.size() + 1] = 1;
            }
        }
        std::vector<LatticePoint> points;
        std::vector<std::uint32_t*> targets;
        corners_.assign(wanted.size(), {false, {}, {}});
        std::vector<std::uint32_t> nodes;
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            if (!wanted[i]) continue;
            const int x = columns_[i % columns_.size()], y = rows_[i / columns_.size()];
            std::uint32_t& root = tile_.corner(x, y);
            if (root == no_node) {
                points.push_back(corner_point(tile_.x0 + x, tile_.y0 + y));
                targets.push_back(&root);
            } else {
                corners_[i] = {unlit_[root] != 0, radiance_of(tile_, root), {}};
                if (corners_[i].lit_anew) collect_unlit(tile_, root, nodes);
            }
        }
        std::vector<std::uint32_t> roots(points.size());
        std::iota(roots.begin(), roots.end(), growth_.add_roots(points));
        for (std::size_t k = 0; k < roots.size(); ++k) *targets[k] = roots[k];
        if (sends_rays_) growth_.spawn(roots, tile_.pending);
        nodes.insert(nodes.end(), roots.begin(), roots.end());
        growth_.light(nodes, true, accel::Coherence::coherent);
        for (std::size_t i = 0; i < wanted.size(); ++i) {
            if (!wanted[i]) continue;
            corners_[i].now = radiance_of(tile_, tile_.corner(columns_[i % columns_.size()], rows_[i / columns_.size()]));
        }
    }

    void show(int x, int y) {
        const Mark mark = marks_[index(x, y)];
        if (mark == Mark::as_it_was) return;
        const auto column = static_cast<std::size_t>(x / step), row = static_cast<std::size_t>(y / step);
        const auto along = [](int c, const std::vector<int>& lines, std::size_t i) {
            return (static_cast<float>(c - lines[i]) + 0.5f) / static_cast<float>(lines[i + 1] - lines[i]);
        };
        const float fx = along(x, columns_, column), fy = along(y, rows_, row);
        Rgb sum;
        float weights = 0;
        for (std::size_t k = 0; k < 4; ++k) {
            const Corner& corner = corners_[(row + (k >> 1)) * columns_.size() + column + (k & 1)];
            if (mark == Mark::lit_anew && !corner.lit_anew) continue;  // of something else
            const float weight = (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
            sum += weight * (mark == Mark::missing ? corner.now : corner.now - corner.before);
            weights += weight;
        }
        if (!(weights > 0)) return;
        Rgb& pixel = tile_.pixels[index(x, y)];
        const Rgb shown = mark == Mark::missing ? sum : pixel + sum * (1 / weights);
        pixel = {std::max(0.0f, shown.r), std::max(0.0f, shown.g), std::max(0.0f, shown.b)};
    }

    Tile& tile_;
    Growth growth_;
    const bool sends_rays_;
    std::vector<std::uint8_t> unlit_;  // by node, of those that were there before
    std::vector<Mark> marks_;          // by pixel
    std::vector<int> columns_, rows_;  // of the grid
    std::vector<Corner> corners_;      // of the grid, row by row
};

}  // namespace

void preview(Tile& tile, const World& world, std::span<const scene::Level> level_of_stage) {
    const scene::Level reached = tile.stage > 0 ? level_of_stage[static_cast<std::size_t>(tile.stage) - 1] : scene::Level::visible;
    if (!tile.unsettled || tile.nodes.empty() || tile.shows_pixels() || reached < scene::Level::shadows) return;
    tile.kept = static_cast<std::uint32_t>(tile.nodes.size());
    Preview(tile, world, reached >= scene::Level::reflections).run();
    tile.previewed_until = static_cast<int>(level_of_stage.size()) + 1;  // until it is settled, whatever its stage
}

}  // namespace crescente::render
