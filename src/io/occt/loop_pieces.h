// Pieces of loops: points on them, turning them round, carrying them to other parameters of the same surface.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "geometry/face.h"

namespace crescente::io::occt {

using geometry::LoopPiece;
using geometry::Point2;

// s from 0 to 1.
Point2 point_on(const LoopPiece& piece, double s);
LoopPiece reversed(const LoopPiece& piece);

// A box of the piece: of lines and arcs exact to rounding, of Bézier pieces that of their control points.
struct Box2 {
    double u0 = 1e300, u1 = -1e300, v0 = 1e300, v1 = -1e300;
    void grow(Point2 p);
    bool empty() const { return u0 > u1; }
};
void grow(Box2& box, const LoopPiece& piece);

// From the parameters of the file's surface to those of ours. Both describe the same points.
struct ParameterMap {
    enum class Kind {
        identity,
        affine,     // pieces stay what they are
        separable,  // u to u, v to v, each monotone: lines along a parameter stay lines
        polar,      // from angle and radius (v is the radius) to the plane: lines of constant u stay lines, those of constant v become arcs
    };
    Kind kind = Kind::identity;
    std::function<Point2(Point2)> point;  // of identity: empty

    Point2 operator()(Point2 p) const { return kind == Kind::identity ? p : point(p); }
};
ParameterMap affine_map(double uu, double uv, double u, double vu, double vv, double v);  // (uu u + uv v + u, vu u + vv v + v)

// The piece in the new parameters, exact where the map's kind says so, else cubics that stray from it by less than `tolerance` in them.
std::vector<LoopPiece> mapped(const LoopPiece& piece, const ParameterMap& map, double tolerance);

}  // namespace crescente::io::occt
