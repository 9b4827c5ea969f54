#include "geometry/polygon.h"

#include "geometry/convex.h"
#include "geometry/ray_view.h"

namespace crescente::geometry {
namespace {

// Twice the area times the unit normal (Newell's method, about the first point so that far-away polygons keep their precision).
Vec3 area_normal(const std::vector<Vec3>& loop) {
    Vec3 sum;
    for (std::size_t i = 2; i < loop.size(); ++i) sum += cross(loop[i - 1] - loop[0], loop[i] - loop[0]);
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
    const Vec3 normal = area_normal(first);
    if (!(dot(normal, normal) > 0)) return std::nullopt;
    const double s0 = view.parameter(least), s1 = view.parameter(most);
    const double t = parameter_between(dot(first[0] - ray.origin, normal) / dot(ray.direction, normal), std::min(s0, s1), std::max(s0, s1));
    return in_reach(t, ray) ? std::optional(ShapeHit{t, 0}) : std::nullopt;
}

// u, v: metres from the first point, along the first edge and across it.
SurfacePoint Polygon::surface(std::uint32_t, Vec3 position) const {
    const auto& first = loops.front();
    SurfacePoint point;
    point.normal = point.shading_normal = normalize(area_normal(first));
    const Vec3 offset = position - first[0];
    point.position = position - point.normal * dot(point.normal, offset);
    const Vec3 along = first[1] - first[0];
    const Vec3 unit = dot(along, along) > 0 ? normalize(along) : perpendicular(point.normal);
    point.u = dot(offset, unit);
    point.v = dot(offset, cross(point.normal, unit));
    point.error = 32 * std::numeric_limits<double>::epsilon() * bounds().largest_coordinate();
    return point;
}

const FieldTable<Polygon>& Polygon::fields() {
    static const FieldTable<Polygon> table;
    return table;
}

}  // namespace crescente::geometry
