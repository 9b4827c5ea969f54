// The world as seen along a ray: points are sheared so that the ray becomes the positive third axis, and a flat shape is hit where its
// outline encloses the origin of the other two. (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection".)
//
// What a point is moved by in rounding depends on the ray and the point alone, and the test of an edge is exact on the moved points and
// the same in both directions. So shapes that share vertices and edges keep sharing them: there is no gap between them, a ray through
// an edge or vertex hits exactly one of those that tile a surface there, and crosses a closed surface an even number of times.
#pragma once

#include "geometry/ray.h"
#include "math/exact.h"

namespace crescente::geometry {

struct ViewPoint {
    double x = 0, y = 0;  // across the ray
    double depth = 0;     // along the axis of the ray's largest component, from its origin
};

class RayView {
public:
    explicit RayView(const Ray& ray) : origin_(ray.origin) {
        const Vec3 size = abs(ray.direction);
        axis_ = size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
        inverse_ = 1.0 / ray.direction[axis_];
        shear_x_ = ray.direction[next(axis_)] * inverse_;
        shear_y_ = ray.direction[next(next(axis_))] * inverse_;
    }

    ViewPoint operator()(Vec3 p) const {
        const Vec3 q = p - origin_;
        const double depth = q[axis_];
        return {std::fma(-shear_x_, depth, q[next(axis_)]), std::fma(-shear_y_, depth, q[next(next(axis_))]), depth};
    }

    // The ray parameter of a depth.
    double parameter(double depth) const { return depth * inverse_; }

private:
    static constexpr int next(int axis) { return axis == 2 ? 0 : axis + 1; }

    Vec3 origin_;
    int axis_ = 0;
    double inverse_ = 0, shear_x_ = 0, shear_y_ = 0;
};

// Whether the edge crosses the half axis y = 0, x > 0. An outline encloses the ray if an odd number of its edges do. The end with y <= 0
// belongs to the edge, the other does not, so that of two edges in a row exactly one owns their vertex.
inline bool crosses(const ViewPoint& p, const ViewPoint& q) {
    if ((p.y > 0) == (q.y > 0)) return false;
    return q.y > 0 ? product_greater(p.x, q.y, q.x, p.y) : product_greater(q.x, p.y, p.x, q.y);
}

// The ray parameter of the plane through `offset` (from the ray's origin) with that normal, kept in the shape's own range of parameters:
// for a plane seen on edge it is lost in rounding, yet the hit must lie on the shape.
inline double plane_parameter(Vec3 offset, Vec3 normal, Vec3 direction, double t0, double t1) {
    const double t = dot(offset, normal) / dot(direction, normal);
    const double least = std::min(t0, t1), most = std::max(t0, t1);
    return !(t >= least) ? least : t > most ? most : t;
}

}  // namespace crescente::geometry
