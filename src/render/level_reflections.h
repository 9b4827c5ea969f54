// Level 2: reflected and refracted rays, the most influential first.
#pragma once

#include "render/level.h"

namespace crescente::render {

std::vector<Stage> reflections_stages(const scene::Settings& settings);
bool advance_reflections(Growth& growth, const Stage& stage, const Deadline& deadline);

}  // namespace crescente::render
