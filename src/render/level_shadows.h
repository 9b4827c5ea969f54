// Level 1: for each node and light, the share of the light that gets through.
#pragma once

#include "render/level.h"

namespace crescente::render {

std::vector<Stage> shadows_stages(const scene::Settings& settings);
bool advance_shadows(Growth& growth, const Stage& stage, const Deadline& deadline);

}  // namespace crescente::render
