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

}  // namespace crescente::geometry
