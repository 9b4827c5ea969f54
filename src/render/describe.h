// A pixel's ray trees as text, for whoever asks why it looks as it does.
#pragma once

#include <string>

#include "render/forest.h"
#include "render/world.h"

namespace crescente::render {

// x, y: pixel in the tile.
std::string describe_pixel(const Tile& tile, const World& world, int x, int y);

}  // namespace crescente::render
