// What is shown at once after an edit, before the work that it asks for is done: the old picture, with the change on a coarse grid where it is seen.
#pragma once

#include <span>

#include "render/growth.h"

namespace crescente::render {

// For a tile that an edit touched and that is not settled, whose `pixels` are the picture before (with the weights of rays and the skies as they are now). Grows those corners of a coarse grid that are missing, lights what is seen through the others, and
// from them makes the new `pixels`: where corners are gone, light interpolated between those of the grid; where something is to be lit anew, the old pixel with the
// interpolated difference; elsewhere the old pixel. Nothing is done twice: what is traced and lit here is part of the trees. Tiles that were not further
// than their shadows go on as they are.
void preview(Tile& tile, const World& world, std::span<const scene::Level> level_of_stage);

}  // namespace crescente::render
