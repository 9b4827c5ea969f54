#include "geometry/sphere.h"

#include "geometry/revolved.h"

namespace crescente::geometry {

// The origin is first moved to the point of the line nearest to the centre; the discriminant then is a difference of distances, which
// stays exact where b^2 - a c cancels (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019,
// ch. 7).
std::optional<ShapeHit> Sphere::intersect(std::uint32_t, const Ray& ray) const {
    const double a = dot(ray.direction, ray.direction);
    const double shift = -dot(ray.origin, ray.direction) / a;
    const Vec3 near = exact_at(ray, shift);
    const double distance = length(near);
    const double discriminant = (radius - distance) * (radius + distance);
    if (!(discriminant > 0)) return std::nullopt;
    const double middle = shift - dot(near, ray.direction) / a;  // what rounding of the shift left over
    const double half = std::sqrt(discriminant / a);
    return boundary_hit({middle - half, middle + half}, ray);
}

// u: turn about the y axis; v: from the south pole (0) to the north pole (1).
SurfacePoint Sphere::surface(std::uint32_t, Vec3 position) const {
    SurfacePoint point;
    const double distance = length(position);
    point.normal = point.shading_normal = distance > 0 ? position / distance : Vec3{0, 1, 0};
    point.position = point.normal * radius;
    point.error = 4 * std::numeric_limits<double>::epsilon() * radius;
    point.u = azimuth(point.normal);
    point.v = std::atan2(point.normal.y, axis_distance(point.normal)) / pi + 0.5;
    return point;
}

const FieldTable<Sphere>& Sphere::fields() {
    static const FieldTable<Sphere> table{
        field(&Sphere::radius, {"radius", FieldType::number, "m", 0, unbounded, "Distance of the surface from the origin"}),
    };
    return table;
}

}  // namespace crescente::geometry
