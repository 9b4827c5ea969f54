// A rectangle as a point sees it: its solid angle, and points of it that are spread evenly over that (Ureña, Fajardo and King 2013, "An Area-Preserving
// Parametrization for Spherical Rectangles").
#pragma once

#include "math/vec.h"

namespace crescente::render {

using namespace math;

class SphericalRectangle {
public:
    // Edges a and b from a corner, at right angles. `from` should not lie in the rectangle itself.
    SphericalRectangle(Vec3 corner, Vec3 a, Vec3 b, Vec3 from);

    double solid_angle() const { return solid_angle_; }  // steradian; to an absolute error of a few 1e-15

    // A point of the rectangle, for u in [0, 1]^2.
    Vec3 sample(double u0, double u1) const;

private:
    Vec3 from_, x_, y_, z_;              // axes along the edges, and away from the point
    double x0_, x1_, y0_, y1_, z0_;      // the rectangle in them
    double b0_, b1_, k_, solid_angle_;
};

}  // namespace crescente::render
