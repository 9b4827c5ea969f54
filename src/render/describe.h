// What is known of a pixel, taken out of its tile.
#pragma once

#include "render/forest.h"
#include "render/ray_tree.h"
#include "render/world.h"

namespace crescente::render {

// x, y: pixel in the tile.
PixelTrees trees_of_pixel(const Tile& tile, const World& world, int x, int y);

}  // namespace crescente::render
