// Planar polygon with any number of loops; a point is inside by the even-odd rule, so that loops inside a loop are holes.
#pragma once

#include <optional>
#include <vector>

#include "base/fields.h"
#include "geometry/shape.h"

namespace crescente::geometry {

struct Polygon {
    std::vector<std::vector<Vec3>> loops;  // each of at least three points, not closed; all in one plane. The normal follows the first

    Bounds bounds() const;
    std::uint32_t parts() const { return 1; }
    Bounds part_bounds(std::uint32_t) const { return bounds(); }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    static const FieldTable<Polygon>& fields();
};

}  // namespace crescente::geometry
