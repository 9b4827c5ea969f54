// Cone or truncated cone about the y axis, from y = 0 (base) to y = height (top).
#pragma once

#include <optional>

#include "base/fields.h"
#include "geometry/shape.h"

namespace crescente::geometry {

struct Cone {
    double base_radius = 1, top_radius = 0, height = 1;
    bool capped = true;  // closed by disks where a radius is not zero

    Bounds bounds() const;
    std::uint32_t parts() const { return 1; }
    Bounds part_bounds(std::uint32_t) const { return bounds(); }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    static const FieldTable<Cone>& fields();
};

}  // namespace crescente::geometry
