#include "app/server/areas.h"

#include <algorithm>

namespace crescente::app {

std::vector<render::Area> rectangles_of(const TileGrid& grid, const std::vector<bool>& marked, int tallest) {
    const int across = grid.across(), down = grid.down();
    const auto is_marked = [&](int x, int y) { return marked[static_cast<std::size_t>(y) * static_cast<std::size_t>(across) + static_cast<std::size_t>(x)]; };
    struct Run {
        int x, y, width, height;  // in tiles
    };
    std::vector<Run> runs;
    std::vector<std::size_t> open;  // runs that end in the row before
    for (int y = 0; y < down; ++y) {
        std::vector<std::size_t> now;
        for (int x = 0; x < across;) {
            if (!is_marked(x, y)) {
                ++x;
                continue;
            }
            const int first = x;
            while (x < across && is_marked(x, y)) ++x;
            const auto above = std::find_if(open.begin(), open.end(), [&](std::size_t i) { return runs[i].x == first && runs[i].width == x - first && runs[i].height < tallest; });
            if (above != open.end()) {
                ++runs[*above].height;
                now.push_back(*above);
            } else {
                now.push_back(runs.size());
                runs.push_back({first, y, x - first, 1});
            }
        }
        open = std::move(now);
    }
    std::vector<render::Area> areas;
    for (const Run& run : runs) {
        const int x = run.x * grid.tile, y = run.y * grid.tile;
        areas.push_back({x, y, std::min(run.width * grid.tile, grid.width - x), std::min(run.height * grid.tile, grid.height - y)});
    }
    return areas;
}

}  // namespace crescente::app
