// Axis-aligned boxes.
#pragma once

#include <limits>

#include "math/vec.h"

namespace crescente::math {

struct Bounds {
    static constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3 lower{infinity, infinity, infinity};  // a default box is empty
    Vec3 upper{-infinity, -infinity, -infinity};

    static constexpr Bounds everything() { return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}; }

    constexpr void include(Vec3 p) { lower = min(lower, p), upper = max(upper, p); }
    constexpr void include(const Bounds& b) { lower = min(lower, b.lower), upper = max(upper, b.upper); }
    constexpr bool empty() const { return !(lower.x <= upper.x && lower.y <= upper.y && lower.z <= upper.z); }
    bool bounded() const { return !empty() && is_finite(lower) && is_finite(upper); }
    constexpr Vec3 center() const { return (lower + upper) * 0.5; }
    constexpr Vec3 diagonal() const { return upper - lower; }
    constexpr Vec3 corner(int i) const { return {i & 1 ? upper.x : lower.x, i & 2 ? upper.y : lower.y, i & 4 ? upper.z : lower.z}; }
    double largest_coordinate() const { return std::max(max_component(abs(lower)), max_component(abs(upper))); }
};

}  // namespace crescente::math
