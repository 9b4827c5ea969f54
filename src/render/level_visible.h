// Level 0: what the camera sees, on a growing grid of pixel corners, lit without shadows.
#pragma once

#include "render/level.h"

namespace crescente::render {

inline constexpr int coarsest_grid = 8;  // step between the corners of the first picture, pixels

std::vector<Stage> visible_stages(const scene::Settings& settings);

// Stages after which every corner of a tile has a root.
int stages_to_all_roots(const scene::Settings& settings);

bool advance_visible(Growth& growth, const Stage& stage, const Deadline& deadline);

}  // namespace crescente::render
