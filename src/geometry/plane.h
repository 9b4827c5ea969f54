// The infinite plane y = 0; its normal is +y.
#pragma once

#include <optional>

#include "base/fields.h"
#include "geometry/shape.h"

namespace crescente::geometry {

struct Plane {

    Bounds bounds() const;
    std::uint32_t parts() const { return 1; }
    Bounds part_bounds(std::uint32_t) const { return bounds(); }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    static const FieldTable<Plane>& fields();
};

}  // namespace crescente::geometry
