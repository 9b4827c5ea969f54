#include "geometry/disk.h"

#include "geometry/revolved.h"

namespace crescente::geometry {

Bounds Disk::bounds() const { return {{-radius, 0, -radius}, {radius, 0, radius}}; }

std::optional<ShapeHit> Disk::intersect(std::uint32_t, const Ray& ray) const {
    const double t = -ray.origin.y / ray.direction.y;  // not a number or infinite for a ray in the plane or along it: out of reach
    if (!in_reach(t, ray)) return std::nullopt;
    const double distance = axis_distance(exact_at(ray, t));
    if (distance > radius || distance < inner_radius) return std::nullopt;
    return ShapeHit{t, 0};
}

// u: turn about the axis; v: distance from it as a share of the radius.
SurfacePoint Disk::surface(std::uint32_t, Vec3 position) const {
    SurfacePoint point;
    const Vec3 away = away_from_axis(position);
    const double distance = std::clamp(axis_distance(position), std::min(inner_radius, radius), radius);
    point.position = {away.x * distance, 0, away.z * distance};
    point.normal = point.shading_normal = {0, 1, 0};
    point.error = 4 * std::numeric_limits<double>::epsilon() * radius;
    point.u = azimuth(position);
    point.v = distance / radius;
    return point;
}

const FieldTable<Disk>& Disk::fields() {
    static const FieldTable<Disk> table{
        field(&Disk::radius, {"radius", FieldType::number, "m", 0, unbounded, "Outer radius"}),
        field(&Disk::inner_radius, {"inner_radius", FieldType::number, "m", 0, unbounded, "Radius of the hole; 0: none"}),
    };
    return table;
}

}  // namespace crescente::geometry
