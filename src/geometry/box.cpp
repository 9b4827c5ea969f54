#include "geometry/box.h"

#include "geometry/convex.h"

namespace crescente::geometry {

Bounds Box::bounds() const { return {lower, upper}; }

// Slabs (Kay and Kajiya 1986). Primitive 2 axis is the lower face along that axis, 2 axis + 1 the upper.
std::optional<ShapeHit> Box::intersect(std::uint32_t, const Ray& ray) const {
    Stretch inside;
    for (std::uint32_t axis = 0; axis < 3; ++axis) {
        const int i = static_cast<int>(axis);
        inside.clip(slab(ray.origin[i], ray.direction[i], lower[i], upper[i], 2 * axis, 2 * axis + 1));
    }
    // A box without thickness is a rectangle: its two faces are one.
    const bool flat = lower.x == upper.x || lower.y == upper.y || lower.z == upper.z;
    if (flat && inside.enter == inside.leave && in_reach(inside.enter, ray)) return ShapeHit{inside.enter, inside.enter_primitive};
    return boundary_hit(inside, ray);
}

// u, v: shares of the face along the next two axes in the cycle x, y, z.
SurfacePoint Box::surface(std::uint32_t primitive, Vec3 position) const {
    const int axis = static_cast<int>(primitive / 2), second = (axis + 1) % 3, third = (axis + 2) % 3;
    const bool on_upper = primitive % 2 == 1;
    SurfacePoint point;
    point.position = max(lower, min(position, upper));
    point.position[axis] = on_upper ? upper[axis] : lower[axis];
    point.normal[axis] = on_upper ? 1 : -1;
    point.shading_normal = point.normal;
    point.error = 4 * std::numeric_limits<double>::epsilon() * bounds().largest_coordinate();
    const Vec3 extent = upper - lower;
    point.u = extent[second] > 0 ? (point.position[second] - lower[second]) / extent[second] : 0;
    point.v = extent[third] > 0 ? (point.position[third] - lower[third]) / extent[third] : 0;
    return point;
}

const FieldTable<Box>& Box::fields() {
    static const FieldTable<Box> table{
        field(&Box::lower, {"lower", FieldType::vector, "m", -unbounded, unbounded, "Corner with the least coordinates"}),
        field(&Box::upper, {"upper", FieldType::vector, "m", -unbounded, unbounded, "Corner with the greatest coordinates"}),
    };
    return table;
}

}  // namespace crescente::geometry
