#include "geometry/polygon.h"

#include "geometry/convex.h"
#include "geometry/ray_view.h"

namespace crescente::geometry {
namespace {

struct Facing {
    Vec3 normal;        // times twice the area
    double spread = 0;  // twice the area if nothing cancelled: rounding of the normal is relative to it

    bool has_area() const { return length(normal) > 4 * std::numeric_limits<double>::epsilon() * spread; }
};

// Newell's method, about the first point so that far-away polygons keep their precision.
Facing facing(const std::vector<Vec3>& loop) {
    Facing sum;
    for (std::size_t i = 2; i < loop.size(); ++i) {
        const Vec3 a = loop[i - 1] - loop[0], b = loop[i] - loop[0];
        sum.normal += cross(a, b);
        sum.spread += std::sqrt(dot(a, a) * dot(b, b));
    }
    return sum;
}

}  // namespace

Bounds Polygon::bounds() const {
    Bounds box;
    for (const auto& loop : loops) {
        for (const Vec3 p : loop) box.include(p);
    }
    return box;
}

std::optional<ShapeHit> Polygon::intersect(std::uint32_t, const Ray& ray) const {
    const RayView view(ray.origin, ray.direction);
    bool inside = false;
    double least = infinity, most = -infinity;
    for (const auto& loop : loops) {
        if (loop.empty()) continue;
        ViewPoint<double> before = view(loop.back());
        for (const Vec3 p : loop) {
            const ViewPoint<double> here = view(p);
            inside ^= crosses(before, here);
            least = std::min(least, here.depth), most = std::max(most, here.depth);
            before = here;
        }
    }
    if (!inside) return std::nullopt;
    const auto& first = loops.front();
    const Facing face = facing(first);
    if (!face.has_area()) return std::nullopt;
    const double s0 = view.parameter(least), s1 = view.parameter(most);
    const double plane = dot(first[0] - ray.origin, face.normal) / dot(ray.direction, face.normal);
    const double t = parameter_between(plane, std::min(s0, s1), std::max(s0, s1));
    return in_reach(t, ray) ? std::optional(ShapeHit{t, 0}) : std::nullopt;
}

// u, v: metres from the first point, along the first edge and across it.
SurfacePoint Polygon::surface(std::uint32_t, Vec3 position) const {
    const auto& first = loops.front();
    const Facing face = facing(first);
    SurfacePoint point;
    point.normal = point.shading_normal = normalize(face.normal);
    const Vec3 offset = position - first[0];
    point.position = position - point.normal * dot(point.normal, offset);
    const Vec3 along = first[1] - first[0];
    const Vec3 unit = dot(along, along) > 0 ? normalize(along) : perpendicular(point.normal);
    point.u = dot(offset, unit);
    point.v = dot(offset, cross(point.normal, unit));
    // Rounding of the coordinates, and of the normal, which tilts the plane.
    const double tilt = 8 * face.spread / length(face.normal);
    point.error = std::numeric_limits<double>::epsilon() * (8 * bounds().largest_coordinate() + tilt * length(offset));
    return point;
}

const FieldTable<Polygon>& Polygon::fields() {
    static const FieldTable<Polygon> table;
    return table;
}

}  // namespace crescente::geometry
