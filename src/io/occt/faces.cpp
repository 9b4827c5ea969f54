#include "io/occt/faces.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <ShapeFix_Face.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS.hxx>

#include "io/cad_check.h"
#include "io/occt/loops.h"
#include "io/occt/surfaces.h"
#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

using namespace geometry;
using Result = tl::expected<ConvertedFace, UnconvertedFace>;

tl::unexpected<UnconvertedFace> no(CadSurface kind, std::string reason, bool degenerate = false) {
    return tl::unexpected(UnconvertedFace{kind, degenerate, std::move(reason)});
}

CadSurface kind_of(const Geom_Surface& surface) {
    const std::string name = surface.DynamicType()->Name();
    constexpr std::pair<const char*, CadSurface> names[] = {
        {"Geom_Plane", CadSurface::plane}, {"Geom_CylindricalSurface", CadSurface::cylinder}, {"Geom_ConicalSurface", CadSurface::cone},
        {"Geom_SphericalSurface", CadSurface::sphere}, {"Geom_ToroidalSurface", CadSurface::torus}, {"Geom_SurfaceOfRevolution", CadSurface::revolution},
        {"Geom_SurfaceOfLinearExtrusion", CadSurface::extrusion}, {"Geom_BSplineSurface", CadSurface::bspline}, {"Geom_BezierSurface", CadSurface::bezier},
        {"Geom_OffsetSurface", CadSurface::offset}};
    for (const auto& [known, kind] : names) {
        if (name == known) return kind;
    }
    return CadSurface::other;
}

// How far the loops reach in space, from points on them.
double extent(const FaceLoops& loops, const Geom_Surface& surface) {
    gp_Pnt low(1e300, 1e300, 1e300), high(-1e300, -1e300, -1e300);
    for (const Loop& loop : loops.loops) {
        for (const LoopEdge& edge : loop) {
            for (const double s : {0.0, 0.5, 1.0}) {
                const Point2 p = point_on(edge.piece, s);
                const gp_Pnt q = surface.Value(p.u, p.v);
                for (int i = 1; i <= 3; ++i) low.SetCoord(i, std::min(low.Coord(i), q.Coord(i))), high.SetCoord(i, std::max(high.Coord(i), q.Coord(i)));
            }
        }
    }
    return low.Distance(high);
}

// Twice the area that the loops enclose in the parameters, if they run the same way round; of polylines with two steps a piece. Zero means nothing
// where loops of both directions cancel, so only the largest counts.
bool encloses_nothing(const FaceLoops& loops) {
    const double whole = (loops.box.u1 - loops.box.u0) * (loops.box.v1 - loops.box.v0);
    constexpr double nothing = 1e-12;  // of the box
    return std::all_of(loops.loops.begin(), loops.loops.end(), [&](const Loop& loop) {
        double area = 0;
        for (const LoopEdge& edge : loop) {
            for (const double s : {0.0, 0.25, 0.5, 0.75}) {
                const Point2 a = point_on(edge.piece, s), b = point_on(edge.piece, s + 0.25);
                area += (a.u - loops.box.u0) * (b.v - loops.box.v0) - (b.u - loops.box.u0) * (a.v - loops.box.v0);
            }
        }
        return std::abs(area) <= nothing * whole;
    });
}

// Where the two descriptions of the surface differ most: on the loops, and inside their box.
double disagreement(const FaceLoops& loops, const Geom_Surface& surface, const SurfaceConversion& ours) {
    std::vector<Point2> places;
    constexpr std::size_t most_on_loops = 12;
    std::size_t pieces = 0;
    for (const Loop& loop : loops.loops) pieces += loop.size();
    const std::size_t step = std::max<std::size_t>(1, pieces / most_on_loops);
    std::size_t n = 0;
    for (const Loop& loop : loops.loops) {
        for (const LoopEdge& edge : loop) {
            if (n++ % step == 0) places.push_back(point_on(edge.piece, 0.4));
        }
    }
    const Box2& b = loops.box;
    for (const double s : {0.11, 0.57, 0.93}) {
        for (const double t : {0.17, 0.53, 0.88}) places.push_back({b.u0 + (b.u1 - b.u0) * s, b.v0 + (b.v1 - b.v0) * t});
    }
    double most = 0;
    for (const Point2 p : places) {
        const double apart = length(vec(surface.Value(p.u, p.v)) - point_on(ours.surface, ours.map(p)));
        most = std::isfinite(apart) ? std::max(most, apart) : 1e300;
    }
    return most;
}

// The whole of a surface that nothing bounds.
std::optional<Box2> natural_box(const Geom_Surface& surface) {
    Box2 box;
    surface.Bounds(box.u0, box.u1, box.v0, box.v1);
    constexpr double infinite = 1e50;
    if (std::max({std::abs(box.u0), std::abs(box.u1), std::abs(box.v0), std::abs(box.v1)}) > infinite) return std::nullopt;
    return box;
}

// Pcurves of full faces may overrun the period by rounding.
void keep_within_period(Face& face) {
    const bool closed = !std::holds_alternative<PlaneSurface>(face.surface) &&
                        (!std::holds_alternative<PatchSurface>(face.surface) || std::get<PatchSurface>(face.surface).revolved);
    if (closed) face.u1 = std::min(face.u1, face.u0 + 2 * math::pi);
    if (std::holds_alternative<TorusSurface>(face.surface)) face.v1 = std::min(face.v1, face.v0 + 2 * math::pi);
}

// Whether the normals of the two descriptions are opposite: the sign of the map's Jacobian, by differences about a place inside.
bool turns_over(const ParameterMap& map, const Box2& box) {
    if (map.kind == ParameterMap::Kind::identity) return false;
    const double u = 0.45 * box.u0 + 0.55 * box.u1, v = 0.45 * box.v0 + 0.55 * box.v1, du = 1e-4 * (box.u1 - box.u0), dv = 1e-4 * (box.v1 - box.v0);
    const Point2 a = map({u - du, v}), b = map({u + du, v}), c = map({u, v - dv}), d = map({u, v + dv});
    return (b.u - a.u) * (d.v - c.v) - (b.v - a.v) * (d.u - c.u) < 0;
}

Result attempt(const TopoDS_Face& given, const EdgeBands& bands) {
    const TopoDS_Face forward = TopoDS::Face(given.Oriented(TopAbs_FORWARD));
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(forward);
    if (surface.IsNull()) return no(CadSurface::other, "has no surface", true);
    const CadSurface kind = kind_of(*surface);
    try {
        FaceLoops loops = loops_of(forward, *surface, bands);
        if (loops.loops.empty()) {
            const auto box = natural_box(*surface);
            if (!box) return no(kind, "is not bounded");
            loops.box = *box;
        } else {
            if (!(loops.box.u1 > loops.box.u0 && loops.box.v1 > loops.box.v0) || encloses_nothing(loops)) return no(kind, "has no area", true);
            if (extent(loops, *surface) <= 1e-9 * bands.diagonal()) return no(kind, "has no area", true);
            if (!loops.broken.empty()) return no(kind, loops.broken);
        }
        constexpr double exact = 1e-9, near = 1e-6;  // of the diagonal
        const double tolerance = near * bands.diagonal();
        SurfaceConversion ours = convert(surface, loops.box, tolerance);
        if (const auto* patches = std::get_if<PatchSurface>(&ours.surface); patches && patches->patches.empty()) return no(ours.kind, "lies outside of its surface");
        const double allowed = ours.approximated ? 20 * tolerance : exact * (bands.diagonal() + length(vec(surface->Value(loops.box.u0, loops.box.v0))));
        if (disagreement(loops, *surface, ours) > allowed) return no(ours.kind, "has a surface that could not be carried over");

        ConvertedFace result{{}, ours.kind, ours.approximated, false};
        const double size = std::max(loops.box.u1 - loops.box.u0, loops.box.v1 - loops.box.v0);
        Box2 box;
        for (const Loop& loop : loops.loops) {
            Loop carried;
            for (const LoopEdge& edge : loop) {
                for (const LoopPiece& piece : mapped(edge.piece, ours.map, exact * size)) carried.push_back({piece, edge.band});
            }
            for (const LoopEdge& edge : carried) grow(box, edge.piece);
            result.face.loops.push_back(std::move(carried));
        }
        if (loops.loops.empty()) box = loops.box;
        result.face.surface = std::move(ours.surface);
        result.face.u0 = box.u0, result.face.u1 = box.u1, result.face.v0 = box.v0, result.face.v1 = box.v1;
        result.face.reversed = (given.Orientation() == TopAbs_REVERSED) != turns_over(ours.map, loops.box);
        keep_within_period(result.face);
        if (!holds_together(result.face)) return no(ours.kind, "has a surface or loops out of all bounds");
        return result;
    } catch (const Standard_Failure& failure) {
        const std::string reason = failure.GetMessageString();
        return no(kind, "could not be carried over: " + (reason.empty() ? std::string(failure.DynamicType()->Name()) : reason));
    }
}

}  // namespace

Result convert_face(const TopoDS_Face& face, const EdgeBands& bands) {
    Result result = attempt(face, bands);
    if (result || result.error().degenerate) return result;
    try {
        ShapeFix_Face fix(face);
        fix.Perform();
        const TopoDS_Shape fixed = fix.Result();
        if (fixed.IsNull() || fixed.ShapeType() != TopAbs_FACE) return result;
        Result again = attempt(TopoDS::Face(fixed), bands);
        if (again) again->healed = true;
        if (again || again.error().degenerate) return again;
    } catch (const Standard_Failure&) {  // the first reason is the one to tell
    }
    return result;
}

}  // namespace crescente::io::occt
