#include "geometry/sphere.h"

namespace crescente::geometry {

// The discriminant comes from the distance between the centre and the ray's line, which stays exact where b^2 - ac cancels
// (Haines et al., "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019, ch. 7).
std::optional<ShapeHit> Sphere::intersect(std::uint32_t, const Ray& ray) const {
    const double a = dot(ray.direction, ray.direction);
    const double b = -dot(ray.origin, ray.direction);
    const Vec3 nearest = ray.origin + ray.direction * (b / a);
    const double discriminant = radius * radius - dot(nearest, nearest);
    if (!(discriminant >= 0)) return std::nullopt;
    const double c = dot(ray.origin, ray.origin) - radius * radius;
    const double q = b + std::copysign(std::sqrt(a * discriminant), b);
    double t0 = c / q, t1 = q / a;
    if (t0 > t1) std::swap(t0, t1);
    for (const double t : {t0, t1}) {
        if (t > ray.t_min && t <= ray.t_max) return ShapeHit{t, 0};
    }
    return std::nullopt;
}

SurfacePoint Sphere::surface(std::uint32_t, Vec3 position) const {
    SurfacePoint point;
    point.normal = point.shading_normal = normalize(position);
    point.position = point.normal * radius;
    point.error = 4 * std::numeric_limits<double>::epsilon() * radius;
    point.u = std::atan2(point.normal.y, point.normal.x) / (2 * pi) + 0.5;
    point.v = std::acos(std::clamp(point.normal.z, -1.0, 1.0)) / pi;
    return point;
}

const FieldTable<Sphere>& Sphere::fields() {
    static const FieldTable<Sphere> table{
        field(&Sphere::radius, {"radius", FieldType::number, "m", 0, unbounded, "Distance of the surface from the origin"}),
    };
    return table;
}

}  // namespace crescente::geometry
