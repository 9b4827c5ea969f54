// The curves that surfaces are made from: one description of all kinds, and their pieces as rational Bézier curves.
#pragma once

#include <string>
#include <vector>

#include "base/error.h"
#include "base/fields.h"
#include "geometry/bezier_patch.h"

namespace crescente::geometry {

// polyline: straight between the points. bezier: one piece; its degree is the number of points less one. b_spline: uniform, of the given degree; open
// ones begin and end in their end points. nurbs: as the knots say. arc: of the circle from the first of three points through the second to the third.
enum class CurveKind { polyline, bezier, b_spline, nurbs, arc };

struct Curve {
    CurveKind kind = CurveKind::polyline;
    int degree = 3;               // of b_spline and nurbs
    bool closed = false;          // of polyline and b_spline
    std::vector<Vec3> points;
    std::vector<double> weights;  // of bezier, b_spline and nurbs: positive; empty: all 1
    std::vector<double> knots;    // of nurbs: points + degree + 1, none less than the one before

    static const FieldTable<Curve>& fields();
};

// From s0 to s1 of the curve's parameter.
struct CurvePiece {
    double s0 = 0, s1 = 1;
    std::vector<ControlPoint> points;  // degree + 1
    bool rational = false;
};

// In order. A problem's place is the member that is wrong.
Expected<std::vector<CurvePiece>> pieces_of(const Curve& curve);

// The knots' spans that have length, and what makes the Bézier points of each: point k of a span is the sum of matrix[k][j] times the control point
// first + j. (Ramshaw 1989, "Blossoms are polar forms".)
struct KnotSpan {
    double from, to;
    std::size_t first;
    std::vector<std::vector<double>> matrix;
};
// What is wrong with the knots, else empty.
std::string knot_problem(const std::vector<double>& knots, std::size_t points, int degree);
std::vector<KnotSpan> knot_spans(const std::vector<double>& knots, int degree);

// The same curve with more points (Farin 2002, section 6.1).
void raise_degree(CurvePiece& piece, std::size_t to);
// The part before s (in the parameter of the curve) stays, that behind is returned.
CurvePiece cut_off(CurvePiece& piece, double s);

}  // namespace crescente::geometry
