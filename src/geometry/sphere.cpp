#include "geometry/sphere.h"

#include "geometry/revolved.h"

namespace crescente::geometry {

std::optional<ShapeHit> Sphere::intersect(std::uint32_t, const Ray& ray) const {
    const Vec3 &o = ray.origin, &d = ray.direction;
    // Most rays that are tried pass by, and these are told from far: no rounding reaches this far over the radius.
    const double a = dot(d, d), along = dot(o, d);
    if (dot(o, o) * a - along * along > radius * radius * a + 1e-6 * dot(o, o) * a) return std::nullopt;
    const auto [enter, leave] = inside_sphere<double>(radius, {o.x, o.y, o.z}, {d.x, d.y, d.z});
    return boundary_hit({enter, leave}, ray);
}

// u: turn about the y axis; v: from the south pole (0) to the north pole (1).
SurfacePoint Sphere::surface(std::uint32_t, Vec3 position) const {
    SurfacePoint point;
    point.normal = point.shading_normal = vec3(sphere_normal(vec_of(position)));
    point.position = point.normal * radius;
    point.error = sphere_error(radius);
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
