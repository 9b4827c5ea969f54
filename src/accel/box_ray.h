// A ray as boxes see it: the octant rejection and the slab test.
#pragma once

#include <cmath>
#include <limits>

#include "geometry/ray.h"
#include "math/bounds.h"

namespace crescente::accel {

// Both tests pass every box that comes within `slack` of the ray's range. The slack stands for all rounding, of the boxes, of these tests and
// of the parts' own; it is far above the 2 ulps that the slab test itself needs (Ize 2013, "Robust BVH Ray Traversal").
class BoxRay {
public:
    static constexpr double missed = std::numeric_limits<double>::infinity();

    // slack: length, at least 2^-50 of the largest coordinate of the boxes and the origin. The direction must have unit length.
    BoxRay(const geometry::Ray& ray, double slack) : ray_(ray), slack_(slack), t_end_(ray.t_max) {
        for (int k = 0; k < 3; ++k) {
            const double d = ray.direction[k];
            inverse_[k] = 1 / d;
            negative_[k] = std::signbit(d);
            const double toward = std::copysign(slack, d);
            near_[k] = ray.origin[k] + toward;
            far_[k] = ray.origin[k] - toward;
            const double start = position(k, ray.t_min);
            (negative_[k] ? range_.upper : range_.lower)[k] = start - toward;
            if (d == 0) (negative_[k] ? range_.lower : range_.upper)[k] = start + toward;
        }
        end_at(ray.t_max);
    }

    // Nothing beyond t matters any more.
    void end_at(double t) {
        t_end_ = t;
        for (int k = 0; k < 3; ++k) {
            if (ray_.direction[k] > 0) range_.upper[k] = position(k, t) + slack_;
            if (ray_.direction[k] < 0) range_.lower[k] = position(k, t) - slack_;
        }
    }

    double t_end() const { return t_end_; }

    // Octant rejection: whether the box lies wholly behind the ray's start or beyond its end along some axis. Comparisons only.
    bool rejects(const math::Bounds& box) const {
        return box.upper.x < range_.lower.x || box.upper.y < range_.lower.y || box.upper.z < range_.lower.z ||
               box.lower.x > range_.upper.x || box.lower.y > range_.upper.y || box.lower.z > range_.upper.z;
    }

    // Slab test (Kay, Kajiya 1986, "Ray Tracing Complex Scenes"; signs as in Williams et al. 2005, "An Efficient and Robust Ray-Box Intersection
    // Algorithm"): where the ray enters the box, or `missed`. A ray that runs within a slab's own plane gives 0 * infinity; such a NaN
    // changes neither end, since each comparison with it fails.
    double entry(const math::Bounds& box) const {
        double enter = ray_.t_min, leave = t_end_;
        for (int k = 0; k < 3; ++k) {
            enter = std::max(enter, ((negative_[k] ? box.upper : box.lower)[k] - near_[k]) * inverse_[k]);
            leave = std::min(leave, ((negative_[k] ? box.lower : box.upper)[k] - far_[k]) * inverse_[k]);
        }
        return enter <= leave ? enter : missed;
    }

private:
    // Without 0 * infinity where the ray does not move along the axis.
    double position(int axis, double t) const {
        return ray_.direction[axis] == 0 ? ray_.origin[axis] : ray_.origin[axis] + t * ray_.direction[axis];
    }

    const geometry::Ray& ray_;
    double slack_;
    double t_end_;
    math::Vec3 inverse_, near_, far_;  // near_, far_: the origin moved by the slack, for the slabs' near and far planes
    bool negative_[3];
    math::Bounds range_;  // the box of the ray's range, grown by the slack
};

}  // namespace crescente::accel
