// Sphere about the origin.
#pragma once

#include <optional>

#include "base/fields.h"
#include "geometry/ray_view.h"
#include "geometry/shape.h"
#include "math/lanes.h"

namespace crescente::geometry {

struct Sphere {
    double radius = 1;

    Bounds bounds() const { return {{-radius, -radius, -radius}, {radius, radius, radius}}; }
    std::uint32_t parts() const { return 1; }
    Bounds part_bounds(std::uint32_t) const { return bounds(); }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    static const FieldTable<Sphere>& fields();
};

// Where a line is inside a sphere about the origin: enter < leave, or not at all (also NaN). Written once for one ray and for eight.
//
// The origin is first moved to the point of the line nearest to the centre; the discriminant then is a difference of distances, which
// stays exact where b^2 - a c cancels (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019,
// ch. 7).
template <class T>
struct SphereStretch {
    T enter, leave;
};

template <class T>
inline SphereStretch<T> inside_sphere(double radius, const Point3<T>& o, const Point3<T>& d) {
    const T a = d.x * d.x + d.y * d.y + d.z * d.z;
    const T shift = -(o.x * d.x + o.y * d.y + o.z * d.z) / a;
    const T x = fused_multiply_add(d.x, shift, o.x), y = fused_multiply_add(d.y, shift, o.y), z = fused_multiply_add(d.z, shift, o.z);
    const T distance = square_root(x * x + y * y + z * z);
    const T discriminant = (radius - distance) * (radius + distance);
    const T middle = shift - (x * d.x + y * d.y + z * d.z) / a;  // what rounding of the shift left over
    const T half = square_root(discriminant / a);
    return {middle - half, middle + half};
}

// The normal (unit length) at a point of the sphere: the direction of `near` from the centre.
template <class T>
inline Point3<T> sphere_normal(const Point3<T>& near) {
    const T distance = length(near);
    const auto good = distance > 0.0;
    return {good ? near.x / distance : T{}, good ? near.y / distance : T{} + 1.0, good ? near.z / distance : T{}};
}
inline double sphere_error(double radius) { return 4 * std::numeric_limits<double>::epsilon() * radius; }

}  // namespace crescente::geometry
