#include "io/occt/surfaces.h"

#include <algorithm>
#include <cmath>

#include <GeomConvert_ApproxSurface.hxx>
#include <GeomConvert_BSplineSurfaceToBezierSurface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>

#include "io/occt/swept_surfaces.h"
#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

using namespace geometry;

BezierPatch patch_of(const Geom_BezierSurface& surface, double u0, double u1, double v0, double v1) {
    const bool rational = surface.IsURational() || surface.IsVRational();
    BezierPatch patch{surface.UDegree(), surface.VDegree(), rational, u0, u1, v0, v1, {}};
    patch.points.reserve(static_cast<std::size_t>(surface.NbUPoles()) * static_cast<std::size_t>(surface.NbVPoles()));
    for (int i = 1; i <= surface.NbUPoles(); ++i) {
        for (int j = 1; j <= surface.NbVPoles(); ++j) {
            const double weight = rational ? surface.Weight(i, j) : 1;
            patch.points.push_back({vec(surface.Pole(i, j)) * weight, weight});
        }
    }
    return patch;
}

// The stretch of a parameter that the box needs, and by how many turns of the period the box lies elsewhere. The surface is not periodic any more.
struct Stretch {
    double first, last;
    double period;  // 0: never was
    int first_turn = 0, last_turn = 0;

    Stretch(double low, double high, double turn, double from, double to) : first(low), last(high), period(turn) {
        const double slack = 1e-9 * (high - low);
        if (period > 0 && (from < low - slack || to > high + slack)) {
            first_turn = static_cast<int>(std::floor((from + slack - low) / period));
            last_turn = static_cast<int>(std::floor((to - slack - low) / period));
            return;
        }
        // A little further than the loops, and no more: exporters extend surfaces wildly beyond, and that would cost hundreds of leaves for nothing.
        constexpr double margin = 0.02;
        first = std::clamp(from - margin * (to - from), low, high - 10 * slack);
        last = std::clamp(to + margin * (to - from), first + 10 * slack, high);
    }
};

PatchSurface spline_patches(const Handle(Geom_BSplineSurface)& whole, const Box2& box) {
    const Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(whole->Copy());
    const double u_period = spline->IsUPeriodic() ? spline->UPeriod() : 0, v_period = spline->IsVPeriodic() ? spline->VPeriod() : 0;
    if (u_period > 0) spline->SetUNotPeriodic();
    if (v_period > 0) spline->SetVNotPeriodic();
    double u0, u1, v0, v1;
    spline->Bounds(u0, u1, v0, v1);
    const Stretch u(u0, u1, u_period, box.u0, box.u1), v(v0, v1, v_period, box.v0, box.v1);
    constexpr double same_knot = 1e-12;
    GeomConvert_BSplineSurfaceToBezierSurface cut(spline, u.first, u.last, v.first, v.last, same_knot * std::max(u1 - u0, v1 - v0));
    TColStd_Array1OfReal u_knots(1, cut.NbUPatches() + 1), v_knots(1, cut.NbVPatches() + 1);
    cut.UKnots(u_knots), cut.VKnots(v_knots);
    PatchSurface result;
    const double u_slack = 1e-9 * (u1 - u0), v_slack = 1e-9 * (v1 - v0);
    for (int i = 1; i <= cut.NbUPatches(); ++i) {
        for (int j = 1; j <= cut.NbVPatches(); ++j) {
            Handle(Geom_BezierSurface) piece;
            for (int u_turn = u.first_turn; u_turn <= u.last_turn; ++u_turn) {
                const double pu0 = u_knots(i) + u_turn * u_period, pu1 = u_knots(i + 1) + u_turn * u_period;
                if (u_period > 0 && (pu1 <= box.u0 + u_slack || pu0 >= box.u1 - u_slack)) continue;
                for (int v_turn = v.first_turn; v_turn <= v.last_turn; ++v_turn) {
                    const double pv0 = v_knots(j) + v_turn * v_period, pv1 = v_knots(j + 1) + v_turn * v_period;
                    if (v_period > 0 && (pv1 <= box.v0 + v_slack || pv0 >= box.v1 - v_slack)) continue;
                    if (piece.IsNull()) piece = cut.Patch(i, j);
                    result.patches.push_back(patch_of(*piece, pu0, pu1, pv0, pv1));
                }
            }
        }
    }
    return result;
}

SurfaceConversion approximate(const Handle(Geom_Surface)& surface, const Box2& box, double tolerance) {
    const Handle(Geom_RectangularTrimmedSurface) part = new Geom_RectangularTrimmedSurface(surface, box.u0, box.u1, box.v0, box.v1);
    constexpr int degree = 8, most_segments = 200, as_precise_as_asked = 1;
    GeomConvert_ApproxSurface fit(part, tolerance, GeomAbs_C1, GeomAbs_C1, degree, degree, most_segments, as_precise_as_asked);
    if (!fit.HasResult() || fit.MaxError() > 10 * tolerance) throw Standard_Failure("a surface that cannot be approximated");
    return {spline_patches(fit.Surface(), box), {}, CadSurface::other, true};
}

double half_tangent_share(double angle, double from, double to) {  // where on a quadratic arc, 0 to 1
    const double half = (to - from) / 2;
    return (1 + std::tan((angle - from - half) / 2) / std::tan(half / 2)) / 2;
}

Vec3 patch_point(const BezierPatch& patch, double s, double t) {
    const auto along = [](std::vector<ControlPoint> points, double x) {
        for (std::size_t n = points.size() - 1; n > 0; --n) {
            for (std::size_t i = 0; i < n; ++i) {
                points[i] = {points[i].weighted + (points[i + 1].weighted - points[i].weighted) * x, points[i].weight + (points[i + 1].weight - points[i].weight) * x};
            }
        }
        return points[0];
    };
    std::vector<ControlPoint> column;
    for (int i = 0; i <= patch.degree_u; ++i) {
        const auto row = patch.points.begin() + static_cast<std::ptrdiff_t>(i) * (patch.degree_v + 1);
        column.push_back(along({row, row + patch.degree_v + 1}, t));
    }
    const ControlPoint p = along(std::move(column), s);
    return p.weighted / p.weight;
}

struct PointOn {
    Point2 p;

    static Vec3 place(const Frame& f, double x, double y, double z) { return f.origin + f.x * x + f.y * y + f.z * z; }
    static Vec3 round(const Frame& f, double radius, double angle, double z) { return place(f, radius * std::cos(angle), radius * std::sin(angle), z); }

    Vec3 operator()(const PlaneSurface& s) const { return place(s.frame, p.u, p.v, 0); }
    Vec3 operator()(const CylinderSurface& s) const { return round(s.frame, s.radius, p.u, p.v); }
    Vec3 operator()(const ConeSurface& s) const { return round(s.frame, s.radius + p.v * std::sin(s.half_angle), p.u, p.v * std::cos(s.half_angle)); }
    Vec3 operator()(const SphereSurface& s) const { return round(s.frame, s.radius * std::cos(p.v), p.u, s.radius * std::sin(p.v)); }
    Vec3 operator()(const TorusSurface& s) const { return round(s.frame, s.major + s.minor * std::cos(p.v), p.u, s.minor * std::sin(p.v)); }
    Vec3 operator()(const PatchSurface& s) const {
        const auto outside = [&](const BezierPatch& b) {
            return std::max({b.u0 - p.u, p.u - b.u1, 0.0}) / (b.u1 - b.u0) + std::max({b.v0 - p.v, p.v - b.v1, 0.0}) / (b.v1 - b.v0);
        };
        const BezierPatch* nearest = &s.patches[0];
        double least = outside(*nearest);
        for (const BezierPatch& patch : s.patches) {
            if (const double far = outside(patch); far < least) least = far, nearest = &patch;
        }
        const double u = s.revolved ? half_tangent_share(p.u, nearest->u0, nearest->u1) : (p.u - nearest->u0) / (nearest->u1 - nearest->u0);
        return patch_point(*nearest, u, (p.v - nearest->v0) / (nearest->v1 - nearest->v0));
    }
};

}  // namespace

SurfaceConversion convert(Handle(Geom_Surface) surface, const Box2& box, double tolerance) {
    while (const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface)) surface = trimmed->BasisSurface();
    if (const auto plane = Handle(Geom_Plane)::DownCast(surface)) return {PlaneSurface{frame(plane->Position())}, {}, CadSurface::plane};
    if (const auto cylinder = Handle(Geom_CylindricalSurface)::DownCast(surface)) {
        return {CylinderSurface{frame(cylinder->Position()), cylinder->Radius()}, {}, CadSurface::cylinder};
    }
    if (const auto cone = Handle(Geom_ConicalSurface)::DownCast(surface)) {
        constexpr double flat = 1e-10;
        if (std::abs(std::cos(cone->SemiAngle())) > flat) {
            return {ConeSurface{frame(cone->Position()), cone->RefRadius(), cone->SemiAngle()}, {}, CadSurface::cone};
        }
        SurfaceConversion disc = flat_cone(frame(cone->Position()), cone->RefRadius(), cone->SemiAngle() > 0 ? 1 : -1);
        disc.kind = CadSurface::cone;
        return disc;
    }
    if (const auto sphere = Handle(Geom_SphericalSurface)::DownCast(surface)) return {SphereSurface{frame(sphere->Position()), sphere->Radius()}, {}, CadSurface::sphere};
    if (const auto torus = Handle(Geom_ToroidalSurface)::DownCast(surface)) {
        return {TorusSurface{frame(torus->Position()), torus->MajorRadius(), torus->MinorRadius()}, {}, CadSurface::torus};
    }
    if (const auto extrusion = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(surface)) return convert_extrusion(*extrusion, box, tolerance);
    if (const auto revolution = Handle(Geom_SurfaceOfRevolution)::DownCast(surface)) return convert_revolution(*revolution, box, tolerance);
    if (const auto bezier = Handle(Geom_BezierSurface)::DownCast(surface)) return {PatchSurface{{patch_of(*bezier, 0, 1, 0, 1)}, {}}, {}, CadSurface::bezier};
    if (const auto spline = Handle(Geom_BSplineSurface)::DownCast(surface)) return {spline_patches(spline, box), {}, CadSurface::bspline};
    SurfaceConversion result;
    if (const auto offset = Handle(Geom_OffsetSurface)::DownCast(surface)) {
        if (const Handle(Geom_Surface) same = offset->Surface(); !same.IsNull()) result = convert(same, box, tolerance);
        else result = approximate(surface, box, tolerance);
        result.kind = CadSurface::offset;
        return result;
    }
    return approximate(surface, box, tolerance);
}

math::Vec3 point_on(const FaceSurface& surface, Point2 p) { return std::visit(PointOn{p}, surface); }

}  // namespace crescente::io::occt
