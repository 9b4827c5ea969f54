// Light that rays meet without meeting a surface: what surrounds the scene, and lights with extent on the way.
#pragma once

#include "render/growth.h"

namespace crescente::render {

// Whether the ray that ended at a node came straight through its parent, past its coverage or unbent.
bool goes_straight(const World& world, const Tile& tile, std::uint32_t node);

// Gives a node whose ray left the scene its light. `point`: of the picture, of a root; of others it is not looked at.
void light_sky(const World& world, Tile& tile, std::uint32_t node, LatticePoint point);

// Of the lights that the ray passes which ended on the node's surface.
Rgb lights_before(const World& world, const Tile& tile, std::uint32_t node);

}  // namespace crescente::render
