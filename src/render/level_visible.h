// Level 0: what the camera sees, on a growing grid of pixel corners, lit without shadows.
#pragma once

#include "render/level.h"

namespace crescente::render {

inline constexpr int coarsest_grid = 8;  // step between the corners of the first picture, pixels

// Whether corner coordinate c of a tile with `extent` pixels is on the grid of this step, a power of two. The last one always is, so that every
// grid covers the whole tile.
constexpr bool on_grid(int c, int extent, int step) { return (c & (step - 1)) == 0 || c == extent; }

std::vector<Stage> visible_stages(const scene::Settings& settings);

// Stages after which every corner of a tile has a root.
int stages_to_all_roots(const scene::Settings& settings);

bool advance_visible(Growth& growth, const Stage& stage, const Deadline& deadline);

}  // namespace crescente::render
