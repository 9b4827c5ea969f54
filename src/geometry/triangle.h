// The ray-triangle test, written once for one triangle and for eight at a time: the operations and their order are the same for both, so the
// answers are the same to the bit.
//
// u, v and w are twice the signed areas of the triangle's three parts as seen along the ray (ray_view.h). Rounding may make one zero but
// never gives it the wrong sign, since rounded products keep their order: a triangle that encloses the ray always passes, and confirmed()
// decides exactly which of the triangles at an edge or vertex is the ray's.
#pragma once

#include <limits>

#include "geometry/ray_view.h"

namespace crescente::geometry {

// The ray's place among the edges: inside if none of u, v, w is negative or none is positive, and confirmed().
template <class T>
struct TriangleSides {
    T u, v, w;
    T depth_p, depth_q, depth_r;
};

// P and T are double or a vector of doubles: one ray and one triangle, one ray and several triangles, or several rays and one
// triangle.
template <class P, class T, class V = decltype(P{} - T{})>
inline TriangleSides<V> triangle_sides(const Point3<P>& p, const Point3<P>& q, const Point3<P>& r, const RayViewOf<T>& view) {
    const ViewPoint<V> a = view(p), b = view(q), c = view(r);
    return {c.x * b.y - c.y * b.x, a.x * c.y - a.y * c.x, b.x * a.y - b.y * a.x, a.depth, b.depth, c.depth};
}

// The ray's parameter in the triangle's plane; NaN if the triangle has no area.
template <class P, class T, class V>
inline V triangle_parameter(const TriangleSides<V>& sides, const Point3<P>& p, const Point3<P>& q, const Point3<P>& r, const RayViewOf<T>& view,
                            const Point3<T>& origin, const Point3<T>& direction) {
    const P ex = q.x - p.x, ey = q.y - p.y, ez = q.z - p.z;
    const P fx = r.x - p.x, fy = r.y - p.y, fz = r.z - p.z;
    const P nx = ey * fz - ez * fy, ny = ez * fx - ex * fz, nz = ex * fy - ey * fx;
    const V t = ((p.x - origin.x) * nx + (p.y - origin.y) * ny + (p.z - origin.z) * nz) / (nx * direction.x + ny * direction.y + nz * direction.z);
    const V s0 = view.parameter(sides.depth_p), s1 = view.parameter(sides.depth_q), s2 = view.parameter(sides.depth_r);
    const V low = s0 < s1 ? s0 : s1, high = s0 < s1 ? s1 : s0;
    return parameter_between(t, V(s2 < low ? s2 : low), V(s2 > high ? s2 : high));
}

inline Point3<double> point3(math::Vec3 v) { return math::vec_of(v); }

// A point of a triangle, with what is there.
template <class T>
struct TriangleSurface {
    Point3<T> position, normal;  // moved into the plane; unit length, on the side from which the corners run counter-clockwise
    T u, v;                      // of q and r in the barycentric mean
    T error;                     // bound on the distance of position from the true plane
};

template <class T>
inline TriangleSurface<T> triangle_surface(const Point3<T>& p, const Point3<T>& q, const Point3<T>& r, const Point3<T>& near) {
    const Point3<T> e = q - p, f = r - p, offset = near - p;
    const Point3<T> normal = math::exact_cross(e, f);
    const T area2 = dot(normal, normal);
    TriangleSurface<T> at;
    at.normal = normal / math::square_root(area2);
    at.position = near - at.normal * dot(at.normal, offset);
    // Rounding of the coordinates, and of the edges: the latter tilts the normal, the more the narrower the triangle.
    const T tilt = math::square_root(T(dot(e, e) * dot(f, f) / area2));
    const T largest = math::greater(largest_component(p), math::greater(largest_component(q), largest_component(r)));
    at.error = std::numeric_limits<double>::epsilon() * (8.0 * largest + 4.0 * tilt * length(offset));
    at.u = parameter_between(T(dot(cross(offset, f), normal) / area2), T{} + 0.0, T{} + 1.0);
    at.v = parameter_between(T(dot(cross(e, offset), normal) / area2), T{} + 0.0, T(1.0 - at.u));
    return at;
}

// The mean of the corners' normals at (u, v), of unit length; `flat` where they cancel out.
template <class T>
inline Point3<T> interpolated_normal(const Point3<T>& p, const Point3<T>& q, const Point3<T>& r, const T& u, const T& v, const Point3<T>& flat) {
    const Point3<T> sum = p * T(1.0 - u - v) + q * u + r * v;
    const T size = length(sum);
    const auto good = (size > 0.0) & (size < std::numeric_limits<double>::infinity());
    return {good ? sum.x / size : flat.x, good ? sum.y / size : flat.y, good ? sum.z / size : flat.z};
}

// Whether the triangle has an area that is more than rounding.
inline bool has_area(math::Vec3 p, math::Vec3 q, math::Vec3 r) {
    constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();  // of a cross product and its factors, relative to their lengths
    const math::Vec3 e = q - p, f = r - p, n = cross(e, f);
    return dot(n, n) > rounding * rounding * dot(e, e) * dot(f, f);
}

// The last word on a triangle that the test found inside: whether it has an area and, for a ray on its edge or vertex, whether it is the
// one of those sharing it that the ray belongs to. Few come here, so it is for one triangle only.
inline bool confirmed(const TriangleSides<double>& sides, math::Vec3 p, math::Vec3 q, math::Vec3 r, math::Vec3 origin, math::Vec3 direction) {
    if (!has_area(p, q, r)) return false;
    if (sides.u != 0 && sides.v != 0 && sides.w != 0) return true;
    const RayView view(origin, direction);
    const ViewPoint<double> a = view(p), b = view(q), c = view(r);
    return crosses(a, b) ^ crosses(b, c) ^ crosses(c, a);
}

}  // namespace crescente::geometry
