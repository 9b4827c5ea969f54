#include "io/occt/curve_arcs.h"

#include <algorithm>
#include <cmath>

#include <GeomConvert_ApproxCurve.hxx>
#include <GeomConvert_BSplineCurveToBezierCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Hyperbola.hxx>
#include <Geom_Line.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>

#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

using geometry::ControlPoint;
using math::Vec3;
using math::operator*;

// The equal part of [t0, t1] that t lies in; the first or last where it lies outside.
struct Parts {
    double t0, step;
    int count;

    Parts(double from, double to, double longest) : t0(from), count(std::max(1, static_cast<int>(std::ceil((to - from) / longest - 1e-9)))) {
        step = (to - from) / count;
    }
    double start(int i) const { return t0 + i * step; }
    int at(double t) const { return std::clamp(static_cast<int>((t - t0) / step), 0, count - 1); }
};

CurveArcs bezier_arc(const Geom_BezierCurve& curve, double t0, double t1) {
    CurveArcs result{{{{}, t0, t1}}, {}, curve.IsRational()};
    for (int i = 1; i <= curve.NbPoles(); ++i) {
        const double weight = curve.IsRational() ? curve.Weight(i) : 1;
        result.arcs[0].points.push_back({vec(curve.Pole(i)) * weight, weight});
    }
    return result;
}

// A little further than what is asked for, as what lies beyond may be anything.
void segment_around(Geom_BSplineCurve& spline, double t0, double t1) {
    constexpr double margin = 0.02;
    const double low = spline.FirstParameter(), high = spline.LastParameter(), slack = 1e-9 * (high - low);
    const double from = std::clamp(t0 - margin * (t1 - t0), low, high - 10 * slack), to = std::clamp(t1 + margin * (t1 - t0), from + 10 * slack, high);
    if (from > low + slack || to < high - slack) spline.Segment(from, to);
}

CurveArcs spline_arcs(const Handle(Geom_BSplineCurve)& whole, double t0, double t1) {
    const Handle(Geom_BSplineCurve) spline = Handle(Geom_BSplineCurve)::DownCast(whole->Copy());
    const double period = spline->IsPeriodic() ? spline->Period() : 0;
    if (period > 0) spline->SetNotPeriodic();
    else segment_around(*spline, t0, t1);
    GeomConvert_BSplineCurveToBezierCurve cut(spline);
    TColStd_Array1OfReal knots(1, cut.NbArcs() + 1);
    cut.Knots(knots);
    CurveArcs result;
    const double slack = 1e-9 * (knots.Last() - knots.First());
    const int first_turn = period > 0 ? static_cast<int>(std::floor((t0 - knots.Last()) / period)) : 0;
    const int last_turn = period > 0 ? static_cast<int>(std::ceil((t1 - knots.First()) / period)) : 0;
    for (int turn = first_turn; turn <= last_turn; ++turn) {
        for (int i = 1; i <= cut.NbArcs(); ++i) {
            const double from = knots(i) + turn * period, to = knots(i + 1) + turn * period;
            const bool outside = to <= t0 + slack || from >= t1 - slack;
            const bool at_an_end = period == 0 && ((i == 1 && t1 <= from + slack) || (i == cut.NbArcs() && t0 >= to - slack));
            if (outside && !at_an_end) continue;
            CurveArcs one = bezier_arc(*cut.Arc(i), from, to);
            result.rational = result.rational || one.rational;
            result.arcs.push_back(std::move(one.arcs[0]));
        }
    }
    return result;
}

// center + cosh t x + sinh t y: with q = exp t quadratic in q, over 2 q.
CurveArcs hyperbola_arcs(Vec3 center, Vec3 x, Vec3 y, double t0, double t1) {
    constexpr double longest = 1;
    const Parts parts(t0, t1, longest);
    CurveArcs result;
    result.rational = true;
    for (int i = 0; i < parts.count; ++i) {
        const double scale = 1 / std::exp(parts.start(i)), a = 1, b = std::exp(parts.step);  // q relative to the part's first
        const auto blossom = [&](double p, double q) {  // of c 2q + x (q^2 + 1) + y (q^2 - 1), all over 2 q of the first
            const double square = p * q, mean = (p + q) / 2, one = scale * scale;
            return ControlPoint{center * mean + (x * (square + one) + y * (square - one)) * (0.5 / scale), mean};
        };
        result.arcs.push_back({{blossom(a, a), blossom(a, b), blossom(b, b)}, parts.start(i), parts.start(i + 1)});
    }
    result.along = [parts](double t) {
        const double start = parts.start(parts.at(t));
        return start + parts.step * std::expm1(t - start) / std::expm1(parts.step);
    };
    return result;
}

CurveArcs parabola_arcs(Vec3 vertex, Vec3 x, Vec3 y, double focal, double t0, double t1) {  // vertex + t^2 / (4 focal) x + t y
    const auto blossom = [&](double p, double q) { return ControlPoint{vertex + x * (p * q / (4 * focal)) + y * ((p + q) / 2), 1}; };
    return {{{{blossom(t0, t0), blossom(t0, t1), blossom(t1, t1)}, t0, t1}}, {}};
}

}  // namespace

CurveArcs conic_arcs(Vec3 center, Vec3 x, Vec3 y, double a0, double a1) {
    const Parts parts(a0, a1, math::pi / 2);
    const double half = parts.step / 2, weight = std::cos(half);
    CurveArcs result;
    result.rational = true;
    const auto on = [&](double a) { return x * std::cos(a) + y * std::sin(a); };
    for (int i = 0; i < parts.count; ++i) {
        const double from = parts.start(i), to = parts.start(i + 1);
        result.arcs.push_back({{{center + on(from), 1}, {center * weight + on(from + half), weight}, {center + on(to), 1}}, from, to});
    }
    // On such an arc the tangent of half the angle from its middle grows evenly.
    result.along = [parts, half](double a) {
        const double from = parts.start(parts.at(a));
        return from + half * (1 + std::tan((a - from - half) / 2) / std::tan(half / 2));
    };
    return result;
}

CurveArcs arcs_of(Handle(Geom_Curve) curve, double t0, double t1, double tolerance) {
    while (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve)) curve = trimmed->BasisCurve();
    if (!(t1 > t0)) throw Standard_Failure("a curve of no length");
    if (const auto line = Handle(Geom_Line)::DownCast(curve)) {
        return {{{{{vec(line->Value(t0)), 1}, {vec(line->Value(t1)), 1}}, t0, t1}}, {}};
    }
    const auto conic_axes = [](const Geom_Conic& conic, double a, double b, auto&& make) {
        const gp_Ax2 axes = conic.Position();
        return make(vec(axes.Location()), vec(axes.XDirection()) * a, vec(axes.YDirection()) * b);
    };
    const auto ellipse_arcs = [&](Vec3 c, Vec3 x, Vec3 y) { return conic_arcs(c, x, y, t0, t1); };
    if (const auto circle = Handle(Geom_Circle)::DownCast(curve)) return conic_axes(*circle, circle->Radius(), circle->Radius(), ellipse_arcs);
    if (const auto ellipse = Handle(Geom_Ellipse)::DownCast(curve)) return conic_axes(*ellipse, ellipse->MajorRadius(), ellipse->MinorRadius(), ellipse_arcs);
    if (const auto hyperbola = Handle(Geom_Hyperbola)::DownCast(curve)) {
        return conic_axes(*hyperbola, hyperbola->MajorRadius(), hyperbola->MinorRadius(),
                          [&](Vec3 c, Vec3 x, Vec3 y) { return hyperbola_arcs(c, x, y, t0, t1); });
    }
    if (const auto parabola = Handle(Geom_Parabola)::DownCast(curve)) {
        return conic_axes(*parabola, 1, 1, [&](Vec3 c, Vec3 x, Vec3 y) { return parabola_arcs(c, x, y, parabola->Focal(), t0, t1); });
    }
    if (const auto bezier = Handle(Geom_BezierCurve)::DownCast(curve)) return bezier_arc(*bezier, 0, 1);
    if (const auto spline = Handle(Geom_BSplineCurve)::DownCast(curve)) return spline_arcs(spline, t0, t1);
    constexpr int most_segments = 400, degree = 8;
    GeomConvert_ApproxCurve fit(new Geom_TrimmedCurve(curve, t0, t1), tolerance, GeomAbs_C1, most_segments, degree);
    if (!fit.HasResult() || fit.MaxError() > 10 * tolerance) throw Standard_Failure("an offset curve that cannot be approximated");
    CurveArcs result = spline_arcs(fit.Curve(), t0, t1);
    result.approximated = true;
    return result;
}

}  // namespace crescente::io::occt
