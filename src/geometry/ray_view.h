// The world as seen along a ray: points are sheared so that the ray becomes the third axis, and a flat shape is hit where its outline
// encloses the origin of the other two. (Woop, Benthin, Wald 2013, "Watertight Ray/Triangle Intersection".)
//
// What a point is moved by in rounding depends on the ray and the point alone, and the test of an edge is exact on the moved points and
// the same in both directions. So shapes that share vertices and edges keep sharing them: there is no gap between them, a ray through
// an edge or vertex hits exactly one of those that tile a surface there, and crosses a closed surface an even number of times.
#pragma once

#include <algorithm>
#include <limits>

#include "math/exact.h"
#include "math/vec_lanes.h"

namespace crescente::geometry {

// Three coordinates of one point (T = double), or of one corner of several triangles (T = a vector of doubles).
template <class T>
using Point3 = math::VecOf<T>;

template <class T>
struct ViewPoint {
    T x, y;   // across the ray
    T depth;  // along the axis of the ray's largest component, from its origin
};

// T = double: one ray. T = a vector of doubles: several rays with the same axis.
template <class T>
class RayViewOf {
public:
    RayViewOf() = default;
    RayViewOf(const Point3<T>& origin, const Point3<T>& direction, int axis) : origin_(origin), axis_(axis) {
        inverse_ = 1.0 / pick(direction, axis_);
        shear_x_ = pick(direction, next(axis_)) * inverse_;
        shear_y_ = pick(direction, next(next(axis_))) * inverse_;
    }

    // Of the largest component, which is the view's axis.
    static int axis_of(math::Vec3 direction) {
        const math::Vec3 size = abs(direction);
        return size.x > size.y ? (size.x > size.z ? 0 : 2) : (size.y > size.z ? 1 : 2);
    }

    // One of the two, the ray and the point, is of one lane, or both are of as many.
    template <class P, class V = decltype(P{} - T{})>
    ViewPoint<V> operator()(const Point3<P>& p) const {
        const int i = next(axis_), j = next(i);
        const V depth = pick(p, axis_) - pick(origin_, axis_);
        return {(pick(p, i) - pick(origin_, i)) - shear_x_ * depth, (pick(p, j) - pick(origin_, j)) - shear_y_ * depth, depth};
    }
    ViewPoint<T> operator()(math::Vec3 p) const { return (*this)(Point3<double>{p.x, p.y, p.z}); }

    // The ray parameter of a depth.
    template <class V>
    V parameter(const V& depth) const {
        return depth * inverse_;
    }

private:
    friend class RayViewRange;
    static constexpr int next(int axis) { return axis == 2 ? 0 : axis + 1; }
    template <class P>
    static const P& pick(const Point3<P>& p, int axis) {
        return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    }

    Point3<T> origin_{};
    int axis_ = 0;
    T inverse_{}, shear_x_{}, shear_y_{};
};

// The views of several rays with one axis, as intervals: where they see a point. Rounding is monotonic, so the bounds hold for what each
// view computes, not only for what is true.
class RayViewRange {
public:
    template <class V>
    struct Box {
        V x_low, x_high, y_low, y_high;
    };

    // Lanes whose bit is not set are left out.
    void include(const RayViewOf<math::Lanes>& view, unsigned lanes) {
        if (!lanes) return;
        axis_ = view.axis_;
        const auto extend = [lanes](Interval& interval, const math::Lanes& values) {
            interval.low = std::min(interval.low, math::least(values, lanes));
            interval.high = std::max(interval.high, math::greatest(values, lanes));
        };
        extend(origin_[0], view.origin_.x), extend(origin_[1], view.origin_.y), extend(origin_[2], view.origin_.z);
        extend(shear_x_, view.shear_x_), extend(shear_y_, view.shear_y_);
    }

    template <class P>
    Box<P> operator()(const Point3<P>& p) const {
        const int i = RayViewOf<double>::next(axis_), j = RayViewOf<double>::next(i);
        const P near = RayViewOf<double>::pick(p, axis_) - origin_[axis_].high, far = RayViewOf<double>::pick(p, axis_) - origin_[axis_].low;
        const auto shear = [&](const Interval& s, P& low, P& high) {
            const P a = s.low * near, b = s.low * far, c = s.high * near, d = s.high * far;
            low = math::lesser(math::lesser(a, b), math::lesser(c, d)), high = math::greater(math::greater(a, b), math::greater(c, d));
        };
        P x_low, x_high, y_low, y_high;
        shear(shear_x_, x_low, x_high);
        shear(shear_y_, y_low, y_high);
        return {(RayViewOf<double>::pick(p, i) - origin_[i].high) - x_high, (RayViewOf<double>::pick(p, i) - origin_[i].low) - x_low,
                (RayViewOf<double>::pick(p, j) - origin_[j].high) - y_high, (RayViewOf<double>::pick(p, j) - origin_[j].low) - y_low};
    }

private:
    struct Interval {
        double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
    };
    int axis_ = 0;
    Interval origin_[3], shear_x_, shear_y_;
};

class RayView : public RayViewOf<double> {
public:
    RayView() = default;
    RayView(math::Vec3 origin, math::Vec3 direction)
        : RayViewOf({origin.x, origin.y, origin.z}, {direction.x, direction.y, direction.z}, axis_of(direction)) {}
};

// Whether the edge crosses the half axis y = 0, x > 0. An outline encloses the ray if an odd number of its edges do. The end with y <= 0
// belongs to the edge, the other does not, so that of two edges in a row exactly one owns their vertex.
inline bool crosses(const ViewPoint<double>& p, const ViewPoint<double>& q) {
    if ((p.y > 0) == (q.y > 0)) return false;
    return q.y > 0 ? math::product_greater(p.x, q.y, q.x, p.y) : math::product_greater(q.x, p.y, p.x, q.y);
}

// A ray parameter kept between two others. For a plane seen on edge the parameter is lost in rounding, yet the hit must lie on the
// shape. What is not a number stays so.
template <class T>
inline T parameter_between(const T& t, const T& least, const T& most) {
    const T low = t < least ? least : t;
    return low > most ? most : low;
}

}  // namespace crescente::geometry
