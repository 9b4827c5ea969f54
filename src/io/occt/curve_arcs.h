// Curves in space as rational Bézier arcs: what surfaces that are swept along or about something are made of.
#pragma once

#include <functional>
#include <vector>

#include <Geom_Curve.hxx>

#include "geometry/bezier_patch.h"

namespace crescente::io::occt {

struct CurveArc {
    std::vector<geometry::ControlPoint> points;
    double t0 = 0, t1 = 1;  // the part of the parameter that it covers
};

struct CurveArcs {
    std::vector<CurveArc> arcs;
    // From the curve's own parameter to the one along the arcs: monotone, the same at the arcs' ends. Empty where they are the same; conics other
    // than parabolas run at another pace than their rational arcs.
    std::function<double(double)> along;
    bool rational = false, approximated = false;
};

// The curve from t0 to t1, splines a little beyond. Exact but for offset curves, which are approximated to `tolerance`. Throws
// Standard_Failure where OpenCASCADE cannot make anything of it.
CurveArcs arcs_of(Handle(Geom_Curve) curve, double t0, double t1, double tolerance);

// Circle: center + cos a x + sin a y from a0 to a1 as quadratic arcs of at most 90 degrees, with the angle along them. An ellipse likewise.
CurveArcs conic_arcs(math::Vec3 center, math::Vec3 x, math::Vec3 y, double a0, double a1);

}  // namespace crescente::io::occt
