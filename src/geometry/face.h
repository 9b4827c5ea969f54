// A face of a CAD model as the file says it: an exact surface and the loops in its parameters that bound it. Plain values; geometry/brep.h
// makes them ready for rays. Parametrisations are those of ISO 10303-42 (STEP), so that curves in (u, v) keep their meaning.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "geometry/bezier_patch.h"

namespace crescente::geometry {

struct Point2 {
    double u = 0, v = 0;

    bool operator==(const Point2&) const = default;
};

// Origin and orthonormal axes; z = x cross y, or its opposite in a left-handed frame.
struct Frame {
    Vec3 origin, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

    bool operator==(const Frame&) const = default;
};

struct PlaneSurface {  // origin + u x + v y
    Frame frame;
    bool operator==(const PlaneSurface&) const = default;
};
struct CylinderSurface {  // origin + radius (cos u x + sin u y) + v z
    Frame frame;
    double radius = 1;
    bool operator==(const CylinderSurface&) const = default;
};
struct ConeSurface {  // origin + (radius + v sin a) (cos u x + sin u y) + v cos a z; a in (-pi/2, pi/2), either nappe
    Frame frame;
    double radius = 0, half_angle = 0.5;
    bool operator==(const ConeSurface&) const = default;
};
struct SphereSurface {  // origin + radius cos v (cos u x + sin u y) + radius sin v z
    Frame frame;
    double radius = 1;
    bool operator==(const SphereSurface&) const = default;
};
struct TorusSurface {  // origin + (major + minor cos v) (cos u x + sin u y) + minor sin v z; minor > major: a spindle
    Frame frame;
    double major = 1, minor = 0.5;
    bool operator==(const TorusSurface&) const = default;
};
struct PatchSurface {  // any spline surface, cut into patches
    std::vector<BezierPatch> patches;
    // A surface of revolution: u of the face is the angle about this frame's z from x, not the parameter of the rational patches. Patches cover
    // [u0, u1] of the angle, and v is theirs.
    std::optional<Frame> revolved;
    bool operator==(const PatchSurface&) const = default;
};
// Normals are S_u x S_v.
using FaceSurface = std::variant<PlaneSurface, CylinderSurface, ConeSurface, SphereSurface, TorusSurface, PatchSurface>;

// Pieces of loops in (u, v), from their first point to their last.
struct LinePiece {
    Point2 from, to;
    bool operator==(const LinePiece&) const = default;
};
struct ArcPiece {  // centre + cos a x + sin a y for a from a0 to a1 (either may be the larger): circle or ellipse
    Point2 center, x, y;
    double a0 = 0, a1 = 0;
    bool operator==(const ArcPiece&) const = default;
};
struct BezierPiece {  // rational, any degree; u and v times the weight
    struct Control {
        double u, v, weight;
        bool operator==(const Control&) const = default;
    };
    std::vector<Control> points;
    bool operator==(const BezierPiece&) const = default;
};
using LoopPiece = std::variant<LinePiece, ArcPiece, BezierPiece>;

struct LoopEdge {
    LoopPiece piece;
    double band = 0;  // how far in space the face may end from this edge and still belong to it: the tolerance, or the gap to the neighbour
    bool operator==(const LoopEdge&) const = default;
};

// A closed curve. Of a face's points those belong to it that an odd number of crossings separates from the outside: the order and direction of
// loops do not matter.
using Loop = std::vector<LoopEdge>;

struct Face {
    FaceSurface surface;
    double u0 = 0, u1 = 1, v0 = 0, v1 = 1;  // a box of the loops in (u, v); on periodic surfaces u1 - u0 is at most a period
    std::vector<Loop> loops;    // none: the whole of [u0, u1] x [v0, v1]
    bool reversed = false;      // the outside is opposite to S_u x S_v
    std::uint16_t slot = 0;     // which of the node's materials
    std::uint32_t shell = 0;    // faces bound each other along edges only within a shell; those of others may touch or overlap them
    bool operator==(const Face&) const = default;
};

}  // namespace crescente::geometry
