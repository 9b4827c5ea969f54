// A rational Bézier patch: the piece that every spline surface is cut into.
#pragma once

#include <vector>

#include "math/vec.h"

namespace crescente::geometry {

using namespace math;

// A range of the parameters of a surface.
struct ParameterBox {
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;

    bool operator==(const ParameterBox&) const = default;
};

// A control point in homogeneous form: the point times its weight, and the weight, which is positive.
struct ControlPoint {
    Vec3 weighted;
    double weight = 1;

    bool operator==(const ControlPoint&) const = default;
};

// S(u, v) = sum B_i(s) B_j(t) weighted_ij / sum B_i(s) B_j(t) weight_ij with s, t the place of u, v in their ranges, from 0 to 1. Normal: S_u x S_v.
struct BezierPatch {
    int degree_u = 0, degree_v = 0;       // 1 or more
    bool rational = false;                // false: all weights are 1
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;  // the part of the surface's parameters that it covers
    std::vector<ControlPoint> points;     // (degree_u + 1) x (degree_v + 1); j of v runs fastest

    const ControlPoint& at(int i, int j) const { return points[static_cast<std::size_t>(i) * (degree_v + 1) + j]; }
    bool operator==(const BezierPatch&) const = default;
};

}  // namespace crescente::geometry
