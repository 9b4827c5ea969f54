// Level 3: adaptive supersampling. A pixel whose corners differ is split in four, recursively (after Whitted 1980, "An Improved
// Illumination Model for Shaded Display", section on antialiasing); new corners are shared by neighbours.
#pragma once

#include "render/level.h"

namespace crescente::render {

std::vector<Stage> edges_stages(const scene::Settings& settings);
bool advance_edges(Growth& growth, const Stage& stage, const Deadline& deadline);

// Takes back all splits, so that they can be decided anew. The roots inside pixels are kept by their place, and the splits for the picture until then.
void unsplit(Tile& tile, const scene::Settings& settings);

// Whether a tile that was stopped amid the stage has what is needed to go on. Its roots and quads must hold together.
bool can_go_on(const Tile& tile, const Stage& stage);

}  // namespace crescente::render
