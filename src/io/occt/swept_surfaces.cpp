#include "io/occt/swept_surfaces.h"

#include <algorithm>
#include <cmath>

#include <Geom_Circle.hxx>
#include <Geom_Line.hxx>
#include <Geom_TrimmedCurve.hxx>
#include <gp_Ax1.hxx>

#include "io/occt/curve_arcs.h"
#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

using namespace geometry;

constexpr double aligned = 1e-12;  // sine of an angle, or distance relative to a radius, that counts as none

Handle(Geom_Curve) untrimmed(Handle(Geom_Curve) curve) {
    while (const auto trimmed = Handle(Geom_TrimmedCurve)::DownCast(curve)) curve = trimmed->BasisCurve();
    return curve;
}

std::function<double(double)> or_same(std::function<double(double)> f) {
    return f ? std::move(f) : [](double t) { return t; };
}

ParameterMap separable_map(std::function<double(double)> along_u, std::function<double(double)> along_v) {
    if (!along_u && !along_v) return {};
    return {ParameterMap::Kind::separable, [u = or_same(std::move(along_u)), v = or_same(std::move(along_v))](Point2 p) { return Point2{u(p.u), v(p.v)}; }};
}

SurfaceConversion with_kind(SurfaceConversion conversion, CadSurface kind) {
    conversion.kind = kind;
    return conversion;
}

// A surface of revolution about `axis`, with a meridian in one half-plane: the radial direction x at angle 0.
struct Meridian {
    Vec3 origin, z;  // the axis

    double height(Vec3 p) const { return dot(p - origin, z); }
    Vec3 foot(Vec3 p) const { return origin + z * height(p); }
    Vec3 outward(Vec3 p) const { return p - foot(p); }
    Frame frame(Vec3 at, Vec3 x) const { return {at, x, cross(z, x), z}; }
    // The same angles about the opposite axis: left-handed.
    Frame turned(Vec3 at, Vec3 x) const { return {at, x, cross(z, x), -z}; }
};

std::optional<SurfaceConversion> revolved_line(const Geom_Line& line, const Meridian& m) {
    const Vec3 p = vec(line.Lin().Location()), d = vec(line.Lin().Direction());
    const double rise = dot(d, m.z), size = 1 + length(p - m.origin);
    const Vec3 radial = m.outward(p), across = d - m.z * rise;
    const double radius = length(radial);
    if (length(across) <= aligned) {  // parallel to the axis
        if (radius <= aligned * size) return std::nullopt;
        const Vec3 x = radial / radius;
        return SurfaceConversion{CylinderSurface{rise > 0 ? m.frame(m.foot(p), x) : m.turned(m.foot(p), x), radius}, {}};
    }
    // In a plane with the axis? x points outward where the line does.
    const Vec3 x = across / length(across);
    if (length(cross(radial, x)) > aligned * size) return std::nullopt;
    const double from_axis = dot(radial, x);  // negative where the line comes from beyond the axis
    if (std::abs(rise) <= aligned) return flat_cone(m.frame(m.foot(p), x), from_axis, 1);
    const double half_angle = std::atan2(length(across), std::abs(rise));
    return SurfaceConversion{ConeSurface{rise > 0 ? m.frame(m.foot(p), x) : m.turned(m.foot(p), x), from_axis, half_angle}, {}};
}

// A circle in a plane with the axis becomes a sphere or torus, whose v is the angle from the outward direction towards z.
std::optional<SurfaceConversion> revolved_circle(const Geom_Circle& circle, const Meridian& m, const Box2& box) {
    const gp_Ax2 axes = circle.Position();
    const Vec3 c = vec(axes.Location()), cx = vec(axes.XDirection()), cy = vec(axes.YDirection());
    const double radius = circle.Radius(), size = radius + length(c - m.origin);
    const Vec3 normal = cross(cx, cy), radial = m.outward(c);
    const double major = length(radial);
    const bool centred = major <= aligned * size;
    if (std::abs(dot(normal, m.z)) > aligned || (!centred && std::abs(dot(normal, radial)) > aligned * size)) return std::nullopt;
    // For the sphere outward is the side that the loops are on.
    Vec3 x = centred ? cross(m.z, normal) : radial / major;
    x = x / length(x);
    const double middle = (box.v0 + box.v1) / 2;
    if (centred && dot(cx * std::cos(middle) + cy * std::sin(middle), x) < 0) x = -x;
    const bool turned = dot(cross(x, m.z), normal) < 0;  // the circle runs from outward to -z
    const Frame frame = turned ? m.turned(m.foot(c), x) : m.frame(m.foot(c), x);
    const double phase = std::atan2(dot(cx, frame.z), dot(cx, x));
    // Angles of the sphere must be latitudes.
    const double turns = centred ? std::round((middle + phase) / (2 * math::pi)) : 0;
    const ParameterMap shift = affine_map(1, 0, 0, 0, 1, phase - turns * 2 * math::pi);
    if (!centred) return SurfaceConversion{TorusSurface{frame, major, radius}, shift};
    const double low = box.v0 + phase - turns * 2 * math::pi, high = box.v1 + phase - turns * 2 * math::pi, slack = 1e-9;
    if (low < -math::pi / 2 - slack || high > math::pi / 2 + slack) return std::nullopt;  // more than a half circle
    return SurfaceConversion{SphereSurface{frame, radius}, shift};
}

// Turned arcs of the meridian, times arcs of the circle: products of Bernstein polynomials with the weights multiplied.
PatchSurface turned_patches(const CurveArcs& meridian, const Meridian& m, double u0, double u1) {
    const CurveArcs circle = conic_arcs({}, {1, 0, 0}, {0, 1, 0}, u0, u1);
    PatchSurface result;
    for (const CurveArc& sweep : circle.arcs) {
        for (const CurveArc& arc : meridian.arcs) {
            BezierPatch patch{2, static_cast<int>(arc.points.size()) - 1, true, sweep.t0, sweep.t1, arc.t0, arc.t1, {}};
            for (const ControlPoint& turn : sweep.points) {
                for (const ControlPoint& p : arc.points) {
                    const Vec3 from_origin = p.weighted - m.origin * p.weight, axial = m.z * dot(from_origin, m.z), radial = from_origin - axial;
                    const Vec3 turned = radial * turn.weighted.x + cross(m.z, radial) * turn.weighted.y;
                    patch.points.push_back({(m.origin * p.weight + axial) * turn.weight + turned, p.weight * turn.weight});
                }
            }
            result.patches.push_back(std::move(patch));
        }
    }
    return result;
}

// The outward direction of all control points, if they are in one half-plane that the axis bounds.
std::optional<Vec3> common_side(const CurveArcs& meridian, const Meridian& m) {
    Vec3 x{};
    double size = 0;
    for (const CurveArc& arc : meridian.arcs) {
        for (const ControlPoint& c : arc.points) {
            const Vec3 radial = m.outward(c.weighted / c.weight);
            if (const double far = length(radial); far > size) size = far, x = radial / far;
        }
    }
    if (size == 0) return std::nullopt;
    constexpr double flat = 1e-10;  // angles come out of the plane by no more: invisible beside the band of the edges
    for (const CurveArc& arc : meridian.arcs) {
        for (const ControlPoint& c : arc.points) {
            const Vec3 radial = m.outward(c.weighted / c.weight);
            if (length(cross(radial, x)) > flat * size || dot(radial, x) < -flat * size) return std::nullopt;
        }
    }
    return x;
}

}  // namespace

SurfaceConversion flat_cone(const Frame& frame, double radius, double outward) {
    const auto to_plane = [=](Point2 p) {
        const double r = radius + outward * p.v;
        return Point2{r * std::cos(p.u), r * std::sin(p.u)};
    };
    return {PlaneSurface{frame}, {ParameterMap::Kind::polar, to_plane}};
}

SurfaceConversion convert_extrusion(const Geom_SurfaceOfLinearExtrusion& surface, const Box2& box, double tolerance) {
    const Handle(Geom_Curve) basis = untrimmed(surface.BasisCurve());
    const Vec3 d = vec(surface.Direction());
    if (const auto line = Handle(Geom_Line)::DownCast(basis)) {
        const Vec3 x = vec(line->Lin().Direction()), across = d - x * dot(d, x), y = normalize(across);
        const Frame frame{vec(line->Lin().Location()), x, y, cross(x, y)};
        return {PlaneSurface{frame}, affine_map(1, dot(d, x), 0, 0, length(across), 0), CadSurface::extrusion};
    }
    if (const auto circle = Handle(Geom_Circle)::DownCast(basis)) {
        const gp_Ax2 axes = circle->Position();
        if (length(cross(vec(axes.Direction()), d)) <= aligned) {
            const Frame frame{vec(axes.Location()), vec(axes.XDirection()), vec(axes.YDirection()), d};
            return {CylinderSurface{frame, circle->Radius()}, {}, CadSurface::extrusion};
        }
    }
    CurveArcs arcs = arcs_of(basis, box.u0, box.u1, tolerance);
    PatchSurface patches;
    for (const CurveArc& arc : arcs.arcs) {
        BezierPatch patch{static_cast<int>(arc.points.size()) - 1, 1, arcs.rational, arc.t0, arc.t1, box.v0, box.v1, {}};
        for (const ControlPoint& c : arc.points) {
            for (const double v : {box.v0, box.v1}) patch.points.push_back({c.weighted + d * (v * c.weight), c.weight});
        }
        patches.patches.push_back(std::move(patch));
    }
    return {std::move(patches), separable_map(std::move(arcs.along), {}), CadSurface::extrusion, arcs.approximated};
}

SurfaceConversion convert_revolution(const Geom_SurfaceOfRevolution& surface, const Box2& box, double tolerance) {
    const gp_Ax1 axis = surface.Axis();
    const Meridian m{vec(axis.Location()), vec(axis.Direction())};
    const Handle(Geom_Curve) basis = untrimmed(surface.BasisCurve());
    if (const auto line = Handle(Geom_Line)::DownCast(basis)) {
        if (auto analytic = revolved_line(*line, m)) return with_kind(std::move(*analytic), CadSurface::revolution);
    } else if (const auto circle = Handle(Geom_Circle)::DownCast(basis)) {
        if (auto analytic = revolved_circle(*circle, m, box)) return with_kind(std::move(*analytic), CadSurface::revolution);
    }
    CurveArcs meridian = arcs_of(basis, box.v0, box.v1, tolerance);
    PatchSurface patches = turned_patches(meridian, m, box.u0, box.u1);
    if (const auto side = common_side(meridian, m)) {
        patches.revolved = m.frame(m.origin, *side);
        return {std::move(patches), separable_map({}, std::move(meridian.along)), CadSurface::revolution, meridian.approximated};
    }
    // The meridian leaves its half-plane, so that the angle about the axis is not u: the patches' own parameter has to serve.
    CurveArcs sweep = conic_arcs({}, {1, 0, 0}, {0, 1, 0}, box.u0, box.u1);
    return {std::move(patches), separable_map(std::move(sweep.along), std::move(meridian.along)), CadSurface::revolution, meridian.approximated};
}

}  // namespace crescente::io::occt
