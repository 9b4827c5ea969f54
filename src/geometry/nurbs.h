// Non-uniform rational B-spline surface (Piegl, Tiller 1997, "The NURBS Book", chapter 4).
#pragma once

#include <vector>

#include "geometry/patch_shape.h"

namespace crescente::geometry {

struct Nurbs : PatchShape<Nurbs> {
    int degree_u = 3, degree_v = 3;
    std::vector<std::vector<Vec3>> points;      // rows along u, each with as many points along v
    std::vector<std::vector<double>> weights;   // as points, positive; empty: all 1
    std::vector<double> knots_u, knots_v;       // points + degree + 1 each, none less than the one before

    // Between the knots; u and v are those of the surface.
    Expected<std::vector<BezierPatch>> patches() const;
    static const FieldTable<Nurbs>& fields();
};

}  // namespace crescente::geometry
