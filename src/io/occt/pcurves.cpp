#include "io/occt/pcurves.h"

#include <cmath>

#include <Geom2dConvert.hxx>
#include <Geom2dConvert_ApproxCurve.hxx>
#include <Geom2dConvert_BSplineCurveToBezierCurve.hxx>
#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>

#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

using namespace geometry;

Point2 scaled(const gp_Dir2d& direction, double length) { return {direction.X() * length, direction.Y() * length}; }

LoopPiece bezier_piece(const Geom2d_BezierCurve& curve) {
    if (curve.Degree() == 1) return LinePiece{point2(curve.Pole(1)), point2(curve.Pole(2))};
    BezierPiece piece;
    piece.points.reserve(static_cast<std::size_t>(curve.NbPoles()));
    for (int i = 1; i <= curve.NbPoles(); ++i) {
        const double weight = curve.IsRational() ? curve.Weight(i) : 1;
        const Point2 p = point2(curve.Pole(i));
        piece.points.push_back({p.u * weight, p.v * weight, weight});
    }
    return piece;
}

std::vector<LoopPiece> spline_pieces(const Handle(Geom2d_BSplineCurve)& whole, double t0, double t1) {
    const Handle(Geom2d_BSplineCurve) spline = Handle(Geom2d_BSplineCurve)::DownCast(whole->Copy());
    const double slack = 1e-9 * (whole->LastParameter() - whole->FirstParameter());
    if (spline->IsPeriodic()) {
        if (std::abs(t1 - t0 - spline->Period()) <= slack && std::abs(t0 - spline->FirstParameter()) <= slack) spline->SetNotPeriodic();
        else spline->Segment(t0, t1);
    } else {
        t0 = std::max(t0, spline->FirstParameter()), t1 = std::min(t1, spline->LastParameter());
        if (t0 > spline->FirstParameter() + slack || t1 < spline->LastParameter() - slack) spline->Segment(t0, t1);
    }
    Geom2dConvert_BSplineCurveToBezierCurve cut(spline);
    std::vector<LoopPiece> pieces;
    pieces.reserve(static_cast<std::size_t>(cut.NbArcs()));
    for (int i = 1; i <= cut.NbArcs(); ++i) pieces.push_back(bezier_piece(*cut.Arc(i)));
    return pieces;
}

}  // namespace

std::vector<LoopPiece> pieces_of(Handle(Geom2d_Curve) curve, double t0, double t1, double tolerance) {
    while (const auto trimmed = Handle(Geom2d_TrimmedCurve)::DownCast(curve)) curve = trimmed->BasisCurve();
    if (!(t1 > t0)) throw Standard_Failure("a curve of no length");
    if (const auto line = Handle(Geom2d_Line)::DownCast(curve)) return {LinePiece{point2(line->Value(t0)), point2(line->Value(t1))}};
    if (const auto circle = Handle(Geom2d_Circle)::DownCast(curve)) {
        const gp_Ax22d axes = circle->Position();
        return {ArcPiece{point2(axes.Location()), scaled(axes.XDirection(), circle->Radius()), scaled(axes.YDirection(), circle->Radius()), t0, t1}};
    }
    if (const auto ellipse = Handle(Geom2d_Ellipse)::DownCast(curve)) {
        const gp_Ax22d axes = ellipse->Position();
        return {ArcPiece{point2(axes.Location()), scaled(axes.XDirection(), ellipse->MajorRadius()), scaled(axes.YDirection(), ellipse->MinorRadius()), t0, t1}};
    }
    if (const auto spline = Handle(Geom2d_BSplineCurve)::DownCast(curve)) return spline_pieces(spline, t0, t1);
    const Handle(Geom2d_TrimmedCurve) part = new Geom2d_TrimmedCurve(curve, t0, t1);
    Handle(Geom2d_BSplineCurve) spline;
    if (curve->DynamicType()->Name() == std::string("Geom2d_OffsetCurve")) {
        constexpr int most_segments = 400, degree = 8;
        Geom2dConvert_ApproxCurve fit(part, tolerance, GeomAbs_C1, most_segments, degree);
        if (!fit.HasResult()) throw Standard_Failure("an offset curve that cannot be approximated");
        spline = fit.Curve();
    } else {  // Bézier curves, parabolas and hyperbolas are rational
        spline = Geom2dConvert::CurveToBSplineCurve(part);
    }
    return spline_pieces(spline, spline->FirstParameter(), spline->LastParameter());
}

}  // namespace crescente::io::occt
