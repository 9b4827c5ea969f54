#include "geometry/plane.h"

#include "geometry/convex.h"

namespace crescente::geometry {

Bounds Plane::bounds() const { return {{-infinity, 0, -infinity}, {infinity, 0, infinity}}; }

std::optional<ShapeHit> Plane::intersect(std::uint32_t, const Ray& ray) const {
    const double t = -ray.origin.y / ray.direction.y;  // not a number or infinite for a ray in the plane or along it: out of reach
    if (!in_reach(t, ray)) return std::nullopt;
    return ShapeHit{t, 0};
}

// u, v: x and -z in metres, so that they run counter-clockwise seen from above.
SurfacePoint Plane::surface(std::uint32_t, Vec3 position) const {
    SurfacePoint point;
    point.position = {position.x, 0, position.z};
    point.normal = point.shading_normal = {0, 1, 0};
    point.error = 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(position.x), std::abs(position.z));
    point.u = position.x;
    point.v = -position.z;
    return point;
}

const FieldTable<Plane>& Plane::fields() {
    static const FieldTable<Plane> table;
    return table;
}

}  // namespace crescente::geometry
