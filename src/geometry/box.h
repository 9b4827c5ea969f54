// Box with faces parallel to the axes.
#pragma once

#include <optional>

#include "base/fields.h"
#include "geometry/shape.h"

namespace crescente::geometry {

struct Box {
    Vec3 lower{-0.5, -0.5, -0.5}, upper{0.5, 0.5, 0.5};

    Bounds bounds() const;
    std::uint32_t parts() const { return 1; }
    Bounds part_bounds(std::uint32_t) const { return bounds(); }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    static const FieldTable<Box>& fields();
};

}  // namespace crescente::geometry
