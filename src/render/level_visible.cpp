#include "render/level_visible.h"

#include <numeric>

namespace crescente::render {
namespace {

// Calls visit(x, y) for the corners of the tile in small blocks, so that neighbours in a packet of rays are neighbours in the picture.
template <class Visit>
void for_each_corner(const Tile& tile, int step, Visit&& visit) {
    const int block = 4 * step;
    for (int by = 0; by <= tile.height; by += block) {
        for (int bx = 0; bx <= tile.width; bx += block) {
            for (int y = by; y < std::min(by + block, tile.height + 1); ++y) {
                if (!on_grid(y, tile.height, step)) continue;
                for (int x = bx; x < std::min(bx + block, tile.width + 1); ++x) {
                    if (on_grid(x, tile.width, step)) visit(x, y);
                }
            }
        }
    }
}

}  // namespace

std::vector<Stage> visible_stages(const scene::Settings&) {
    return {{scene::Level::visible, coarsest_grid, 0.01}, {scene::Level::visible, 4, 0.03}, {scene::Level::visible, 2, 0.1}, {scene::Level::visible, 1, 0.4}};
}

int stages_to_all_roots(const scene::Settings& settings) { return static_cast<int>(visible_stages(settings).size()); }

bool advance_visible(Growth& growth, const Stage& stage, const Deadline& deadline) {
    Tile& tile = growth.tile();
    if (tile.corners.empty()) tile.corners.assign(static_cast<std::size_t>(tile.width + 1) * (tile.height + 1), no_node);
    if (stage.parameter == 1) tile.nodes.reserve(tile.corners.size());
    std::vector<LatticePoint> points;
    std::vector<std::uint32_t*> targets;
    std::vector<std::uint32_t> roots;
    bool stopped = false;
    const auto flush = [&] {
        if (points.empty()) return;
        const std::uint32_t first = growth.add_roots(points);
        roots.resize(points.size());
        std::iota(roots.begin(), roots.end(), first);
        for (std::size_t i = 0; i < points.size(); ++i) *targets[i] = roots[i];
        if (growth.unseen()) {
            tile.lit = false;
        } else {
            growth.light(roots, false, accel::Coherence::coherent);
        }
        points.clear();
        targets.clear();
        stopped = deadline.passed();
    };
    // Corners that have a root are skipped: those of coarser grids, and those done before an interruption.
    for_each_corner(tile, static_cast<int>(stage.parameter), [&](int x, int y) {
        std::uint32_t& corner = tile.corner(x, y);
        if (stopped || corner != no_node) return;
        points.push_back(corner_point(tile.x0 + x, tile.y0 + y));
        targets.push_back(&corner);
        if (points.size() == chunk_size) flush();
    });
    if (stopped) return false;
    flush();
    return true;
}

}  // namespace crescente::render
