#include "io/occt/loops.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Geom2d_Curve.hxx>
#include <ShapeFix_Edge.hxx>
#include <Standard_Failure.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Iterator.hxx>
#include <gp_Pnt.hxx>
#include <gp_Vec.hxx>

#include "io/occt/pcurves.h"
#include "io/occt/thinning.h"
#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

using namespace geometry;

// The pieces of one edge in the direction of its wire.
struct Side {
    std::vector<LoopPiece> pieces;
    double band = 0;
    bool used = false;

    Point2 start() const { return point_on(pieces.front(), 0); }
    Point2 end() const { return point_on(pieces.back(), 1); }
    void reverse() {
        std::reverse(pieces.begin(), pieces.end());
        for (LoopPiece& piece : pieces) piece = reversed(piece);
    }
    void move(double du, double dv) {
        for (LoopPiece& piece : pieces) piece = mapped(piece, affine_map(1, 0, du, 0, 1, dv), 0)[0];
    }
};

Handle(Geom2d_Curve) curve_on(const TopoDS_Edge& edge, const TopoDS_Face& face, double& t0, double& t1) {
    Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, t0, t1);
    if (!curve.IsNull() || BRep_Tool::Degenerated(edge)) return curve;
    ShapeFix_Edge().FixAddPCurve(edge, face, BRep_Tool::IsClosed(edge, face));  // computes and keeps what the file left out
    return BRep_Tool::CurveOnSurface(edge, face, t0, t1);
}

std::vector<Side> sides_of(const TopoDS_Shape& wire, const TopoDS_Face& face, const EdgeBands& bands, double tolerance, Point2 scale) {
    constexpr double thinning = 5e-8;  // of the diagonal: a twentieth of the least band
    std::vector<Side> sides;
    for (TopoDS_Iterator each(wire); each.More(); each.Next()) {
        const TopoDS_Edge edge = TopoDS::Edge(each.Value());
        if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) continue;  // bounds nothing
        double t0 = 0, t1 = 0;
        const Handle(Geom2d_Curve) curve = curve_on(edge, face, t0, t1);
        if (curve.IsNull()) {
            if (BRep_Tool::Degenerated(edge)) continue;  // a pole: the gap is closed along it
            throw Standard_Failure("an edge without a curve on the surface");
        }
        Side side{pieces_of(curve, t0, t1, tolerance), bands.band(edge)};
        if (side.pieces.empty()) throw Standard_Failure("an edge whose curve has no pieces");
        side.pieces = thinned(side.pieces, scale.u, scale.v, thinning * bands.diagonal());
        if (edge.Orientation() == TopAbs_REVERSED) side.reverse();
        sides.push_back(std::move(side));
    }
    return sides;
}

// How far a step of one in u, in v goes in space at most, at a few places of the face.
Point2 lengths_of_parameters(const TopoDS_Face& face, const Geom_Surface& surface) {
    double u0, u1, v0, v1;
    BRepTools::UVBounds(face, u0, u1, v0, v1);
    Point2 most{1e-12, 1e-12};
    for (const double s : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
            gp_Pnt at;
            gp_Vec du, dv;
            surface.D1(u0 + (u1 - u0) * s, v0 + (v1 - v0) * t, at, du, dv);
            most = {std::max(most.u, du.Magnitude()), std::max(most.v, dv.Magnitude())};
        }
    }
    return most;
}

class LoopMaker {
public:
    LoopMaker(const Geom_Surface& surface, FaceLoops& result) : surface_(surface), result_(result) {
        if (surface.IsUPeriodic()) period_.u = surface.UPeriod();
        if (surface.IsVPeriodic()) period_.v = surface.VPeriod();
    }

    void add_wire(std::vector<Side> sides) {
        Box2 box;
        for (const Side& side : sides) {
            for (const LoopPiece& piece : side.pieces) grow(box, piece);
        }
        size_ = {std::max(box.u1 - box.u0, 1e-300), std::max(box.v1 - box.v0, 1e-300)};
        for (std::size_t first = 0; first < sides.size(); ++first) {
            if (!sides[first].used) add_loop(sides, first);
        }
    }

private:
    static constexpr double meets = 1e-7;  // of the wire's size in the parameters

    // How far apart, in shares of the wire's size.
    double apart(Point2 a, Point2 b) const { return std::max(std::abs(a.u - b.u) / size_.u, std::abs(a.v - b.v) / size_.v); }
    gp_Pnt in_space(Point2 p) const { return surface_.Value(p.u, p.v); }

    void add_loop(std::vector<Side>& sides, std::size_t first) {
        Loop loop;
        const Point2 start = sides[first].start();
        Point2 end = sides[first].end();
        append(loop, sides[first]);
        std::size_t last = first;
        while (true) {
            const auto next = next_side(sides, last, end);
            const double to_start = apart(end, start);
            if (!next || (to_start <= apart(end, sides[*next].start()) && to_start <= meets)) break;
            if (to_start < apart(end, sides[*next].start())) break;
            const double band = std::max(sides[last].band, sides[*next].band);
            close_gap(loop, end, sides[*next].start(), band);
            append(loop, sides[*next]);
            last = *next, end = sides[last].end();
        }
        close_gap(loop, end, start, sides[last].band);
        meet_to_the_bit(loop);
        result_.loops.push_back(std::move(loop));
    }

    static void append(Loop& loop, Side& side) {
        side.used = true;
        for (const LoopPiece& piece : side.pieces) loop.push_back({piece, side.band});
    }

    // The side that goes on from `end`: the one after `last` if it does, else the nearest, turned round or moved by periods if that brings it there.
    std::optional<std::size_t> next_side(std::vector<Side>& sides, std::size_t last, Point2 end) const {
        const std::size_t after = (last + 1) % sides.size();
        if (!sides[after].used && apart(end, sides[after].start()) <= meets) return after;
        std::optional<std::size_t> best, best_turned;
        double least = 1e300, least_turned = 1e300;
        for (std::size_t i = 0; i < sides.size(); ++i) {
            if (sides[i].used) continue;
            if (const double d = apart(end, sides[i].start()); d < least) least = d, best = i;
            if (const double d = apart(end, sides[i].end()); d < least_turned) least_turned = d, best_turned = i;
        }
        constexpr double far = 1e-3;
        if (best && least > far && least_turned <= meets) {
            sides[*best_turned].reverse();
            return best_turned;
        }
        if (best && least > far) move_near(sides, end, *best);
        return best;
    }

    void move_near(std::vector<Side>& sides, Point2 end, std::size_t fallback) const {
        for (std::size_t k = 0; k < sides.size(); ++k) {
            Side& side = sides[(fallback + k) % sides.size()];
            if (side.used) continue;
            const auto turns = [](double gap, double period) { return period > 0 ? std::round(gap / period) * period : 0.0; };
            const Point2 start = side.start();
            const double du = turns(end.u - start.u, period_.u), dv = turns(end.v - start.v, period_.v);
            if ((du != 0 || dv != 0) && k == 0 && apart(end, {start.u + du, start.v + dv}) <= meets) return side.move(du, dv);
        }
    }

    // A line where one edge ends and the next begins elsewhere. It must be no longer in space than the gap that it closes: along a pole it is not.
    void close_gap(Loop& loop, Point2 from, Point2 to, double band) {
        if (from == to) return;
        const gp_Pnt a = in_space(from), b = in_space(to), middle = in_space({(from.u + to.u) / 2, (from.v + to.v) / 2});
        const double gap = a.Distance(b);
        result_.widest_gap = std::max(result_.widest_gap, gap);
        const double way = a.Distance(middle) + middle.Distance(b);
        if (apart(from, to) > meets && way > 2 * gap + 10 * band) result_.broken = "its loops are not closed in its parameters";
        loop.push_back({LinePiece{from, to}, band + gap / 2});
    }

    // Lines and Bézier pieces take over the point where the next begins; lines that are as short as rounding vanish.
    void meet_to_the_bit(Loop& loop) const {
        std::erase_if(loop, [&](const LoopEdge& edge) {
            const auto* line = std::get_if<LinePiece>(&edge.piece);
            return loop.size() > 1 && line && apart(line->from, line->to) <= meets / 100;
        });
        Loop met;
        for (std::size_t i = 0; i < loop.size(); ++i) {
            LoopEdge edge = loop[i];
            const Point2 next = point_on(loop[(i + 1) % loop.size()].piece, 0);
            if (auto* line = std::get_if<LinePiece>(&edge.piece)) {
                line->to = next;
            } else if (auto* bezier = std::get_if<BezierPiece>(&edge.piece)) {
                auto& c = bezier->points.back();
                c = {next.u * c.weight, next.v * c.weight, c.weight};
            }
            met.push_back(edge);
            if (const Point2 end = point_on(edge.piece, 1); !(end == next)) met.push_back({LinePiece{end, next}, edge.band});
        }
        loop = std::move(met);
    }

    const Geom_Surface& surface_;
    FaceLoops& result_;
    Point2 period_{0, 0};
    Point2 size_{1, 1};
};

}  // namespace

FaceLoops loops_of(const TopoDS_Face& face, const Geom_Surface& surface, const EdgeBands& bands) {
    FaceLoops result;
    LoopMaker maker(surface, result);
    constexpr double pcurve_tolerance = 1e-8;  // of offset curves, in the parameters
    const Point2 scale = lengths_of_parameters(face, surface);
    for (TopoDS_Iterator wire(face); wire.More(); wire.Next()) {
        if (wire.Value().ShapeType() == TopAbs_WIRE) maker.add_wire(sides_of(wire.Value(), face, bands, pcurve_tolerance, scale));
    }
    for (const Loop& loop : result.loops) {
        for (const LoopEdge& edge : loop) grow(result.box, edge.piece);
    }
    return result;
}

}  // namespace crescente::io::occt
