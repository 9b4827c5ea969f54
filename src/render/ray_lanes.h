// Eight rays, made at once.
#pragma once

#include <cstddef>
#include <cstring>

#include "geometry/ray.h"
#include "math/octahedral.h"
#include "math/vec_lanes.h"

namespace crescente::render {

using namespace math;

// Blocks of eight lanes for so many; the last may not be full.
inline std::size_t blocks_of(std::size_t count) { return (count + lane_count - 1) / lane_count; }

// Starts on the side of `direction` of a surface, clear of it.
inline Vec3Lanes starts(const Vec3Lanes& position, const Vec3Lanes& geometric_normal, const Lanes& offset, const Vec3Lanes& direction) {
    return position + geometric_normal * (dot(geometric_normal, direction) >= 0.0 ? offset : -offset);
}

inline void make_rays(const Vec3Lanes& origin, const Vec3Lanes& direction, const Lanes& t_min, const Lanes& t_max, geometry::Ray* rays) {
    Lanes rows[lane_count] = {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, t_min, t_max};
    transpose(rows);
    std::memcpy(static_cast<void*>(rays), rows, sizeof rows);
}

// Of their codes in steps (Node::geometric_normal).
inline Vec3Lanes geometric_normals(const OctahedralPoint<Lanes>& code) { return from_octahedral(OctahedralPoint<Lanes>{code.a / octahedral_scale, code.b / octahedral_scale}); }

}  // namespace crescente::render
