// Surfaces made from curves: turned about an axis, moved along a line, and stretched between two.
#pragma once

#include <vector>

#include "geometry/curve.h"
#include "geometry/patch_shape.h"

namespace crescente::geometry {

// Generalised surface of revolution (A. Costa 1988, "Geração de superfícies pelo método de revolução generalizada"): the profile is turned about the
// y axis, and its distance from the axis follows a directrix that need not be a circle. At the angle a (from x towards -z, as for the other shapes
// about y) a point (x, y, z) of the profile is turned by twist a / sweep in the plane of the profile, about `pivot`, moved out by
// the factor directrix(a), turned about the axis, and raised by pitch a / 360 deg. Circles are exact (rational patches); anything else is interpolated
// by cubic patches with its true derivatives, in steps of 7.5 deg or less.
struct Revolution : PatchShape<Revolution> {
    std::vector<Curve> profile;      // one after another; x is the distance from the axis where z is 0
    double start = 0, sweep = 2 * pi;
    double twist = 0;                // over the whole sweep
    double pitch = 0;                // rise in a full turn
    Vec3 pivot;                      // of the twist, in the profile's plane (z is not used)
    std::vector<double> directrix;   // factors at equal angles, from start; over a full turn they close, else the last is at the end. Empty: 1

    // u: the angle in radians; v: the profile's parameter.
    Expected<std::vector<BezierPatch>> patches() const;
    static const FieldTable<Revolution>& fields();
};

// A profile moved along a straight line.
struct Extrusion : PatchShape<Extrusion> {
    std::vector<Curve> profile;
    Vec3 direction{0, 1, 0};  // how far

    // u: the profile's parameter; v: from 0 to 1 along the direction.
    Expected<std::vector<BezierPatch>> patches() const;
    static const FieldTable<Extrusion>& fields();
};

// Straight lines between points of two curves at the same share of their parameters.
struct Ruled : PatchShape<Ruled> {
    std::vector<Curve> from, to;

    // u: from 0 to 1 along the curves; v: from 0 to 1 between them.
    Expected<std::vector<BezierPatch>> patches() const;
    static const FieldTable<Ruled>& fields();
};

}  // namespace crescente::geometry
