// Torus about the y axis.
#pragma once

#include <optional>

#include "base/fields.h"
#include "geometry/shape.h"

namespace crescente::geometry {

struct Torus {
    double major_radius = 1;    // from the axis to the middle of the tube
    double minor_radius = 0.25;  // of the tube; may exceed the major one (spindle torus)

    Bounds bounds() const;
    std::uint32_t parts() const { return 1; }
    Bounds part_bounds(std::uint32_t) const { return bounds(); }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    static const FieldTable<Torus>& fields();
};

// Where a ray crosses (sqrt(x^2 + z^2) - major)^2 + y^2 = minor^2 with t_min < t <= t_max, ascending: the nearest `most` (up to 4). A negative major
// gives the inner sheet of a spindle torus, whose tube's center lies on the other side of the axis.
int torus_crossings(const Ray& ray, double major, double minor, double* found, int most);

}  // namespace crescente::geometry
