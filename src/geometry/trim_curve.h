// The curves in (u, v) that bound a face, cut into pieces that are monotone in u and in v.
#pragma once

#include <vector>

#include "geometry/face.h"
#include "math/vec.h"

namespace crescente::geometry {

// The first fundamental form of a surface at a point: |du S_u + dv S_v|^2 = uu du^2 + 2 uv du dv + vv dv^2. Lengths in (u, v) become lengths in space.
struct Metric {
    double uu = 1, uv = 0, vv = 1;
};

inline Metric metric_of(math::Vec3 along_u, math::Vec3 along_v) { return {dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)}; }

// Lengths as they are seen along a direction (not zero), but no more than `grazing_reach` times shorter than they are. Where a ray grazes two faces that do not quite meet it
// may pass between them far from where they end, but not farther, as it sees it, than the gap is wide.
inline constexpr double grazing_reach = 4;
inline Metric metric_seen_along(math::Vec3 direction, math::Vec3 along_u, math::Vec3 along_v) {
    const double share = (1 - 1 / (grazing_reach * grazing_reach)) / dot(direction, direction), u = dot(along_u, direction), v = dot(along_v, direction);
    const Metric plain = metric_of(along_u, along_v);
    return {plain.uu - share * u * u, plain.uv - share * u * v, plain.vv - share * v * v};
}

// A curve and its first derivative at one parameter.
struct CurvePoint {
    Point2 at, slope;
};

// Of an arc (angle in radians) or a Bézier piece (0 to 1) alone: lines need no evaluation.
CurvePoint evaluate(const LoopPiece& curve, double t);

Point2 first_point(const LoopPiece& piece);
Point2 last_point(const LoopPiece& piece);

// Parameters from start to end of a curve, both included, between which u and v are monotone. At most 4 * degree of them.
std::vector<double> monotone_stops(const LoopPiece& curve);

// A stretch of a curve, monotone in u and v; `from` and `to` are welded to those of the neighbours in the loop, bit by bit.
struct MonotonePiece {
    static constexpr std::uint32_t no_curve = 0xffffffff;

    Point2 from, to;
    float band = 0;                   // length in space
    std::uint32_t stretch = no_curve;  // no_curve: a line; else an index into the stretches

    bool is_line() const { return stretch == no_curve; }
};
struct CurveStretch {
    double t0 = 0, t1 = 0;    // of `from` and `to`
    std::uint32_t curve = 0;  // arcs and Bézier pieces of the face
};

// u of a monotone stretch where it has the given v, and the other way round. The value is kept between those of the ends.
double u_at(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve, double v);
double v_at(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve, double u);

// A point between the ends of the stretch, and the direction from `from` to `to` or back.
CurvePoint middle_of(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve);

// The point of the stretch that is nearest to p, as the metric measures, and its squared distance. Of a curve that turns sharply a point may be missed
// that is nearer than the one found, where p is farther away than the radius of its curvature.
struct NearestPoint {
    Point2 at, along;  // along: the direction of the stretch there, as middle_of has it
    double distance2 = 0;
};
NearestPoint nearest_point(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve, Point2 p, const Metric& metric);

}  // namespace crescente::geometry
