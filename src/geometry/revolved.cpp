#include "geometry/revolved.h"

#include "math/exact.h"

namespace crescente::geometry {

// The quadratic a s^2 + 2 b s + c <= 0 with the line seen in the space (x, z, radius): its form is x^2 + z^2 - radius^2, and b^2 - a c is
// the difference of two squared "areas" between origin and direction (Lagrange's identity with one negative axis). In that shape it
// loses nothing near grazing incidence, where b^2 - a c as written cancels. Roots as in Press et al., "Numerical Recipes", 5.6.
Stretch inside_cone(Vec3 origin, Vec3 direction, double radius, double slope) {
    const double r = radius + slope * origin.y, dr = slope * direction.y;
    const double across = std::sqrt(direction.x * direction.x + direction.z * direction.z);
    const double a = (across - std::abs(dr)) * (across + std::abs(dr));
    const double b = origin.x * direction.x + origin.z * direction.z - r * dr;
    const double distance = axis_distance(origin);
    const double c = (distance - std::abs(r)) * (distance + std::abs(r));
    const double px = difference_of_products(direction.x, r, origin.x, dr), pz = difference_of_products(direction.z, r, origin.z, dr);
    const double p = std::sqrt(px * px + pz * pz);
    const double q = std::abs(difference_of_products(origin.x, direction.z, origin.z, direction.x));
    const double discriminant = (p - q) * (p + q);

    if (a == 0) {  // parallel to the wall: one root, or none
        if (b == 0) return c <= 0 ? Stretch{} : empty_stretch;
        const double root = -c / (2 * b);
        return b > 0 ? Stretch{-infinity, root} : Stretch{root, infinity};
    }
    if (a > 0 && !(discriminant > 0)) return empty_stretch;
    const double sum = -(b + std::copysign(std::sqrt(std::max(discriminant, 0.0)), b));
    const double r0 = sum == 0 ? 0 : c / sum, r1 = sum / a;
    const double first = std::min(r0, r1), last = std::max(r0, r1);
    if (a > 0) return {first, last};
    return dr > 0 ? Stretch{last, infinity} : Stretch{-infinity, first};  // steeper than the wall: towards the open end
}

Frustum inside_frustum(const Ray& ray, double base_radius, double top_radius, double height) {
    Frustum inside;
    inside.slab = slab(ray.origin.y, ray.direction.y, 0, height, base_radius > 0 ? 1 : 0, top_radius > 0 ? 2 : 0);
    if (!(inside.slab.enter <= inside.slab.leave)) return {empty_stretch, empty_stretch};
    const double shift = nearest_to_axis(ray, inside.slab);
    inside.wall = inside_cone(exact_at(ray, shift), ray.direction, base_radius, (top_radius - base_radius) / height);
    inside.wall.enter += shift;
    inside.wall.leave += shift;
    return inside;
}

std::optional<ShapeHit> frustum_hit(const Ray& ray, double base_radius, double top_radius, double height, bool capped) {
    const Frustum inside = inside_frustum(ray, base_radius, top_radius, height);
    if (capped) {
        Stretch solid = inside.slab;
        solid.clip(inside.wall);
        return boundary_hit(solid, ray);
    }
    if (!(inside.wall.enter < inside.wall.leave)) return std::nullopt;
    for (const double t : {inside.wall.enter, inside.wall.leave}) {
        if (in_reach(t, ray) && t >= inside.slab.enter && t <= inside.slab.leave) return ShapeHit{t, 0};
    }
    return std::nullopt;
}

SurfacePoint frustum_surface(std::uint32_t primitive, Vec3 position, double base_radius, double top_radius, double height) {
    SurfacePoint point;
    const Vec3 away = away_from_axis(position);
    const double distance = axis_distance(position);
    if (primitive == 0) {
        // In the meridian plane the wall is the segment from (base_radius, 0) to (top_radius, height).
        const double run = top_radius - base_radius, slant = std::sqrt(run * run + height * height);
        const double along = ((distance - base_radius) * (run / slant) + position.y * (height / slant)) / slant;
        const double v = std::clamp(along, 0.0, 1.0);
        const double radius = base_radius + v * run;
        point.position = {away.x * radius, v * height, away.z * radius};
        point.normal = {away.x * (height / slant), -run / slant, away.z * (height / slant)};
        point.v = v;
    } else {
        const double radius = primitive == 1 ? base_radius : top_radius;
        const double inside = std::min(distance, radius);
        point.position = {away.x * inside, primitive == 1 ? 0.0 : height, away.z * inside};
        point.normal = {0, primitive == 1 ? -1.0 : 1.0, 0};
        point.v = inside / radius;
    }
    point.shading_normal = point.normal;
    point.error = 8 * std::numeric_limits<double>::epsilon() * std::max({base_radius, top_radius, height});
    point.u = azimuth(position);
    return point;
}

}  // namespace crescente::geometry
