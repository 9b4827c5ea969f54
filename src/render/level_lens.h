// Levels 4 and 5 through a lens: where the picture is not that of a pinhole at one moment, its light is gathered at the pixels instead of at the nodes of the trees, in
// the same rounds. The trees stay as they are.
#pragma once

#include "render/level.h"

namespace crescente::render {

// The pixels that a tile has samples of: its own, and those around it as far as they tell how many its own need, of which it has the first samples alone. So the
// picture is the same however it is cut. In pixels of the picture.
struct LensPixels {
    int x0, y0, width, height;
    std::size_t count() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(height); }
    std::size_t at(int x, int y) const { return static_cast<std::size_t>(y - y0) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x - x0); }
};
LensPixels lens_pixels_of(const Tile& tile, const scene::Settings& settings);

// A stage of level_sampled.h of a world with a lens.
bool advance_lens(Growth& growth, const Stage& stage, const Deadline& deadline);

}  // namespace crescente::render
