// Changed tiles as few rectangles.
#pragma once

#include <vector>

#include "render/session.h"

namespace crescente::app {

// The grid of tiles over a picture.
struct TileGrid {
    int width = 0, height = 0, tile = 64;  // pixels

    int across() const { return (width + tile - 1) / tile; }
    int down() const { return (height + tile - 1) / tile; }
    std::size_t size() const { return static_cast<std::size_t>(across()) * static_cast<std::size_t>(down()); }
    bool operator==(const TileGrid&) const = default;
};

// Rectangles that cover the marked tiles and nothing else, each tile once: runs of a row, joined with equal runs of the rows below, up to `tallest` rows of tiles, so that
// several processors can encode them.
std::vector<render::Area> rectangles_of(const TileGrid& grid, const std::vector<bool>& marked, int tallest);

}  // namespace crescente::app
