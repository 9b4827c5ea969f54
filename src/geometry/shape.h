// What every shape is: a plain struct of its parameters with these six functions. A shape lives in its own space, in one file
// pair of its own; geometry/kinds.h lists them all.
//
//   Bounds bounds() const                                  the whole shape; may be unbounded (plane)
//   std::uint32_t parts() const                            pieces that can be bounded and tried alone: 1, or a mesh's triangles
//   Bounds part_bounds(std::uint32_t part) const
//   std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const
//                                                          nearest hit of the part with t_min < t <= t_max
//   SurfacePoint surface(std::uint32_t primitive, Vec3 position) const
//                                                          the surface at a hit: position is ray.at(t), in the shape's space
//   static const FieldTable<Self>& fields()                its parameters for files, schema and manual
//
// intersect and surface are pure functions of their arguments to the bit: every accelerator gets its hits from them, which is what
// makes the picture independent of the accelerator. They are compiled without contraction into fused multiply-adds.
#pragma once

#include <cstdint>

#include "geometry/ray.h"
#include "math/bounds.h"
#include "math/vec.h"

namespace crescente::geometry {

struct ShapeHit {
    double t = 0;
    std::uint32_t primitive = 0;  // which face of the shape: a mesh's triangle, a box's side, a cylinder's wall or cap
};

struct SurfacePoint {
    Vec3 position;        // on the surface, refined: nearer to it than the argument
    Vec3 normal;          // geometric, unit length, outward (for open surfaces: the side that the parametrisation gives)
    Vec3 shading_normal;  // interpolated where the shape has such normals, else equal to normal; unit length
    double error = 0;     // bound on the distance of position from the true surface, in the shape's space
    double u = 0, v = 0;  // parameters on the surface
    std::uint32_t slot = 0;  // which of the node's materials
};

}  // namespace crescente::geometry
