// A ray as the narrow phase sees it: one cache line, double precision.
#pragma once

#include <limits>

#include "math/vec.h"

namespace crescente::geometry {

using namespace math;

// Points origin + t direction with t_min < t <= t_max. The direction need not be of unit length: a ray carried into a
// shape's own space keeps its parameter t.
struct alignas(64) Ray {
    Vec3 origin;
    Vec3 direction;
    double t_min = 0;
    double t_max = std::numeric_limits<double>::infinity();

    constexpr Vec3 at(double t) const { return origin + direction * t; }
};
static_assert(sizeof(Ray) == 64);

}  // namespace crescente::geometry
