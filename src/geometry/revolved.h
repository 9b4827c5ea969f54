// What the shapes of revolution about the y axis share.
#pragma once

#include "geometry/convex.h"

namespace crescente::geometry {

// Distance from the axis.
inline double axis_distance(Vec3 p) { return std::sqrt(p.x * p.x + p.z * p.z); }

// The unit vector from the axis to p, along y = 0; on the axis itself +x.
inline Vec3 away_from_axis(Vec3 p) {
    const double distance = axis_distance(p);
    return distance > 0 ? Vec3{p.x / distance, 0, p.z / distance} : Vec3{1, 0, 0};
}

// Angle about the axis as a share of the full turn, in [0, 1]: 0 at +x, counter-clockwise seen from above (+y).
inline double azimuth(Vec3 p) {
    const double turn = std::atan2(-p.z, p.x) / (2 * pi);
    return turn < 0 ? turn + 1 : turn + 0.0;
}

// The ray parameter nearest to the axis; NaN or huge for rays along it.
inline double nearest_to_axis(const Ray& ray) {
    const double a = ray.direction.x * ray.direction.x + ray.direction.z * ray.direction.z;
    return -(ray.origin.x * ray.direction.x + ray.origin.z * ray.direction.z) / a;
}

// The ray parameter in the stretch that is nearest to the axis: the place to move the origin to before products are formed. Zero
// where there is none (a null direction).
inline double nearest_to_axis(const Ray& ray, const Stretch& stretch) {
    const double t = nearest_to_axis(ray);
    const double inside = t >= stretch.enter ? (t > stretch.leave ? stretch.leave : t) : stretch.enter;
    return std::abs(inside) < infinity ? inside : 0.0;
}

// Where the line origin + s direction is inside the infinite cone (or cylinder, slope = 0) of radius `radius + slope y`, on the side of
// the apex where that is positive. The origin should be near the shape.
Stretch inside_cone(Vec3 origin, Vec3 direction, double radius, double slope);

// The stretch of a ray inside the wall alone and inside the slab 0 <= y <= height alone, for cylinders and cones.
// Primitives: 0 wall, 1 base, 2 top.
struct Frustum {
    Stretch wall, slab;
};
Frustum inside_frustum(const Ray& ray, double base_radius, double top_radius, double height);
std::optional<ShapeHit> frustum_hit(const Ray& ray, double base_radius, double top_radius, double height, bool capped);
SurfacePoint frustum_surface(std::uint32_t primitive, Vec3 position, double base_radius, double top_radius, double height);

}  // namespace crescente::geometry
