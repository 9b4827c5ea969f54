// The stretch of a ray's line inside a convex solid, as the intersection of simpler convex sets. A closed solid found in this way has
// an entry and an exit or neither: however the roots were rounded, the crossings come in pairs.
#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include "geometry/shape.h"

namespace crescente::geometry {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

struct Stretch {
    double enter = -infinity, leave = infinity;  // ray parameters; empty unless enter < leave
    std::uint32_t enter_primitive = 0, leave_primitive = 0;

    void clip(const Stretch& other) {
        if (other.enter > enter) enter = other.enter, enter_primitive = other.enter_primitive;
        if (other.leave < leave) leave = other.leave, leave_primitive = other.leave_primitive;
    }
};

inline constexpr Stretch empty_stretch{infinity, -infinity};

// Where lower <= origin + t direction <= upper along one axis; the primitives are those of the lower and the upper side.
inline Stretch slab(double origin, double direction, double lower, double upper, std::uint32_t lower_primitive = 0,
                    std::uint32_t upper_primitive = 0) {
    if (direction == 0) return lower <= origin && origin <= upper ? Stretch{} : empty_stretch;
    const double t0 = (lower - origin) / direction, t1 = (upper - origin) / direction;
    return direction > 0 ? Stretch{t0, t1, lower_primitive, upper_primitive} : Stretch{t1, t0, upper_primitive, lower_primitive};
}

inline bool in_reach(double t, const Ray& ray) { return t > ray.t_min && t <= ray.t_max && t < infinity; }

// The nearest crossing of the solid's boundary in the ray's reach. A line that only touches (enter == leave) does not cross.
inline std::optional<ShapeHit> boundary_hit(const Stretch& inside, const Ray& ray) {
    if (!(inside.enter < inside.leave)) return std::nullopt;
    if (in_reach(inside.enter, ray)) return ShapeHit{inside.enter, inside.enter_primitive};
    if (in_reach(inside.leave, ray)) return ShapeHit{inside.leave, inside.leave_primitive};
    return std::nullopt;
}

// The point at parameter t with one rounding a component, so that a ray from far away can be moved near a shape before any product
// of its origin is formed. (Ray::at rounds the product too: an error in proportion to the distance.)
inline Vec3 exact_at(const Ray& ray, double t) {
    return {std::fma(ray.direction.x, t, ray.origin.x), std::fma(ray.direction.y, t, ray.origin.y),
            std::fma(ray.direction.z, t, ray.origin.z)};
}

}  // namespace crescente::geometry
