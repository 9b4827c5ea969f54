// Level 0: what the camera sees, on a growing grid of pixel corners, lit without shadows.
#pragma once

#include "render/level.h"

namespace crescente::render {

std::vector<Stage> visible_stages(const scene::Settings& settings);
bool advance_visible(Growth& growth, const Stage& stage, const Deadline& deadline);

}  // namespace crescente::render
