// The ray-triangle test, written once for one triangle and for eight at a time: the operations and their order are the same for both, so the
// answers are the same to the bit.
//
// Signed volumes of the ray with each edge (Plücker coordinates; Shevtsov et al. 2007; Woop, Benthin, Wald 2013, "Watertight
// Ray/Triangle Intersection"). For two triangles that share an edge they are exact negatives of each other, so that no ray passes
// between them.
#pragma once

#include "math/vec.h"

namespace crescente::geometry {

// Three coordinates of one point (T = double), or of one corner of several triangles (T = a vector of doubles).
template <class T>
struct Point3 {
    T x, y, z;
};

template <class T>
struct TriangleTest {
    T u, v, w;  // inside if none is negative or none is positive
    T t;        // parameter of the ray in the triangle's plane; NaN or infinite if the triangle is degenerate or edge-on
};

template <class T>
inline TriangleTest<T> test_triangle(const Point3<T>& p, const Point3<T>& q, const Point3<T>& r, math::Vec3 origin, math::Vec3 direction) {
    const T ax = p.x - origin.x, ay = p.y - origin.y, az = p.z - origin.z;
    const T bx = q.x - origin.x, by = q.y - origin.y, bz = q.z - origin.z;
    const T cx = r.x - origin.x, cy = r.y - origin.y, cz = r.z - origin.z;
    const double dx = direction.x, dy = direction.y, dz = direction.z;
    TriangleTest<T> test;
    test.u = (cy * bz - cz * by) * dx + (cz * bx - cx * bz) * dy + (cx * by - cy * bx) * dz;
    test.v = (ay * cz - az * cy) * dx + (az * cx - ax * cz) * dy + (ax * cy - ay * cx) * dz;
    test.w = (by * az - bz * ay) * dx + (bz * ax - bx * az) * dy + (bx * ay - by * ax) * dz;
    const T ex = q.x - p.x, ey = q.y - p.y, ez = q.z - p.z;
    const T fx = r.x - p.x, fy = r.y - p.y, fz = r.z - p.z;
    const T nx = ey * fz - ez * fy, ny = ez * fx - ex * fz, nz = ex * fy - ey * fx;
    test.t = (ax * nx + ay * ny + az * nz) / (nx * dx + ny * dy + nz * dz);
    return test;
}

}  // namespace crescente::geometry
