// Double boxes as Embree wants them: float, about a nearby origin, never smaller.
#pragma once

#include <cmath>

#include <embree3/rtcore.h>

#include "math/bounds.h"

namespace crescente::accel {

inline float round_down(double x) {
    const float f = static_cast<float>(x);
    return f > x ? std::nextafterf(f, -INFINITY) : f;
}
inline float round_up(double x) {
    const float f = static_cast<float>(x);
    return f < x ? std::nextafterf(f, INFINITY) : f;
}

// The box seen from `origin`, grown by `margin` on all sides.
inline RTCBounds float_bounds(const math::Bounds& box, math::Vec3 origin, double margin) {
    const math::Vec3 lower = box.lower - origin, upper = box.upper - origin;
    return {round_down(lower.x - margin), round_down(lower.y - margin), round_down(lower.z - margin), 0,
            round_up(upper.x + margin),   round_up(upper.y + margin),   round_up(upper.z + margin),   0};
}

}  // namespace crescente::accel
