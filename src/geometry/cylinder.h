// Cylinder about the y axis, from y = 0 to y = height.
#pragma once

#include <optional>

#include "base/fields.h"
#include "geometry/shape.h"

namespace crescente::geometry {

struct Cylinder {
    double radius = 1, height = 1;
    bool capped = true;  // closed by disks

    Bounds bounds() const;
    std::uint32_t parts() const { return 1; }
    Bounds part_bounds(std::uint32_t) const { return bounds(); }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    static const FieldTable<Cylinder>& fields();
};

}  // namespace crescente::geometry
