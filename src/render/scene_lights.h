// The lights of a world: those that the scene lists, the sun of its sky, and what stands in for soft light at levels that do not sample.
#pragma once

#include "render/world.h"

namespace crescente::render {

// Fills World::lights and World::luminous. Instances and environment must be there.
void make_lights(World& world);

}  // namespace crescente::render
