// What rays met, eight at a time: surfaces in world space, ready to be lit.
#pragma once

#include <cstdint>

#include "accel/narrow_phase.h"
#include "math/vec_lanes.h"
#include "render/world.h"

namespace crescente::render {

struct SurfaceLanes {
    Vec3Lanes position;   // on the surface
    Vec3Lanes geometric;  // normal on the side that the ray came from, unit length
    Vec3Lanes shading;    // interpolated normal on the same side, turned so that the ray's origin can see it; unit length
    Lanes offset;         // how far from position, along the geometric normal, rays may start without meeting the surface again
    unsigned inside = 0;  // lanes that met the surface from its inner side, as bits
    std::uint32_t material[lane_count];  // index of lobes
};

// Lanes whose bit is not set in `found` are left undefined. The others do not depend on their companions.
SurfaceLanes surfaces_at(const World& world, const geometry::Ray* rays, const accel::Hit* hits, unsigned found);

}  // namespace crescente::render
