// Which borders of patches are those of the whole surface.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "geometry/bezier_patch.h"

namespace crescente::geometry {

// For each patch whether its borders at u0, u1, v0, v1 are free: of some length, and no border of the set has the same course (the other way
// round too), to within 1e-6 of the patch's size.
std::vector<std::array<bool, 4>> free_borders(std::span<const BezierPatch> patches);

}  // namespace crescente::geometry
