#include "io/occt/edge_bands.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <Geom2d_Curve.hxx>
#include <GeomAbs_Shape.hxx>
#include <Geom_Surface.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopTools_ListIteratorOfListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include "io/occt/free_edges.h"
#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

using math::Vec3;
using math::operator-;

constexpr int least_places = 12;
constexpr double least_band = 1e-6;  // of the diagonal

// Where the sides of an edge are compared: in each span of its curves in their surfaces' parameters, since curves that were fitted to points at the knots agree best there.
std::vector<double> places_of(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) {
    std::vector<double> stops;
    for (TopTools_ListIteratorOfListOfShape face(faces); face.More(); face.Next()) {
        double t0, t1;
        const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, TopoDS::Face(face.Value()), t0, t1);
        if (curve.IsNull() || !std::isfinite(t0) || !std::isfinite(t1)) continue;
        stops.push_back(t0), stops.push_back(t1);
        const Geom2dAdaptor_Curve adaptor(curve, t0, t1);
        const int spans = adaptor.NbIntervals(GeomAbs_CN);
        TColStd_Array1OfReal knots(1, spans + 1);
        adaptor.Intervals(knots, GeomAbs_CN);
        for (int i = 2; i <= spans; ++i) stops.push_back(knots(i));
    }
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end()), stops.end());
    std::vector<double> places;
    if (stops.empty()) return places;
    const std::size_t each = std::max<std::size_t>(3, (least_places + stops.size() - 1) / stops.size());
    for (std::size_t i = 0; i + 1 < stops.size(); ++i) {
        for (std::size_t k = 0; k < each; ++k) places.push_back(stops[i] + (stops[i + 1] - stops[i]) * static_cast<double>(k) / static_cast<double>(each));
    }
    places.push_back(stops.back());
    return places;
}

std::vector<double> even_places(const TopoDS_Edge& edge, const TopoDS_Face& face) {
    double t0, t1;
    std::vector<double> places;
    if (BRep_Tool::CurveOnSurface(edge, face, t0, t1).IsNull() || !std::isfinite(t0) || !std::isfinite(t1)) return places;
    for (int i = 0; i < least_places; ++i) places.push_back(t0 + (t1 - t0) * i / (least_places - 1));
    return places;
}

// The points that one face gives an edge.
void add_side(const TopoDS_Edge& edge, const TopoDS_Face& face, const std::vector<double>& places, std::vector<EdgePoints>& sides) {
    double t0, t1;
    const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, t0, t1);
    if (curve.IsNull() || places.empty()) return;
    TopLoc_Location location;
    const Handle(Geom_Surface)& surface = BRep_Tool::Surface(face, location);
    if (surface.IsNull()) return;
    EdgePoints points;
    for (const double t : places) {
        const gp_Pnt2d p = curve->Value(t);
        gp_Pnt q = surface->Value(p.X(), p.Y());
        if (!location.IsIdentity()) q.Transform(location.Transformation());
        points.push_back(vec(q));
    }
    sides.push_back(std::move(points));
}

std::vector<EdgePoints> sides_of(const TopoDS_Edge& edge, const TopTools_ListOfShape& faces) {
    std::vector<EdgePoints> sides;
    const TopoDS_Face first = TopoDS::Face(faces.First().Oriented(TopAbs_FORWARD));
    const bool free = faces.Extent() == 1 && !BRep_Tool::IsClosed(edge, first);
    const std::vector<double> places = free ? even_places(edge, first) : places_of(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), faces);
    for (TopTools_ListIteratorOfListOfShape face(faces); face.More(); face.Next()) {
        const TopoDS_Face forward = TopoDS::Face(face.Value().Oriented(TopAbs_FORWARD));
        add_side(TopoDS::Edge(edge.Oriented(TopAbs_FORWARD)), forward, places, sides);
        if (BRep_Tool::IsClosed(edge, forward)) add_side(TopoDS::Edge(edge.Oriented(TopAbs_REVERSED)), forward, places, sides);
    }
    return sides;
}

// Sets of faces that edges join: a forest in which every face knows one of its set (Tarjan 1975, "Efficiency of a good but not linear set union algorithm").
class FaceSets {
public:
    void join(const TopTools_ListOfShape& faces) {
        for (TopTools_ListIteratorOfListOfShape face(faces); face.More(); face.Next()) join(faces.First(), face.Value());
    }
    void join(const TopoDS_Shape& a, const TopoDS_Shape& b) {
        const int one = root(index_of(a)), other = root(index_of(b));
        above_[static_cast<std::size_t>(std::max(one, other))] = std::min(one, other);
    }
    void number(TopTools_DataMapOfShapeInteger& shells) {
        for (int i = 1; i <= faces_.Extent(); ++i) shells.Bind(faces_(i), root(i) - 1);
    }

private:
    int index_of(const TopoDS_Shape& face) {
        const int index = faces_.Add(face);
        for (int next = static_cast<int>(above_.size()); next <= index; ++next) above_.push_back(next);
        return index;
    }
    int root(int face) {
        auto above = [&](int f) -> int& { return above_[static_cast<std::size_t>(f)]; };
        while (above(face) != face) face = above(face) = above(above(face));
        return face;
    }

    TopTools_IndexedMapOfShape faces_;
    std::vector<int> above_;
};

}  // namespace

EdgeBands::EdgeBands(const TopoDS_Shape& part) {
    Bnd_Box box;
    BRepBndLib::Add(part, box, false);
    diagonal_ = box.IsVoid() || box.IsOpen() ? 1 : std::sqrt(box.SquareExtent());
    floor_ = least_band * diagonal_;
    TopTools_IndexedDataMapOfShapeListOfShape edges;
    TopExp::MapShapesAndUniqueAncestors(part, TopAbs_EDGE, TopAbs_FACE, edges);
    std::vector<FreeEdge> free_edges;
    FaceSets sets;
    for (int i = 1; i <= edges.Extent(); ++i) {
        const TopoDS_Edge& edge = TopoDS::Edge(edges.FindKey(i));
        const TopTools_ListOfShape& faces = edges(i);
        if (faces.IsEmpty()) continue;
        sets.join(faces);
        const double tolerance = BRep_Tool::Tolerance(edge);
        largest_tolerance_ = std::max(largest_tolerance_, tolerance);
        double gap = 0;
        if (!BRep_Tool::Degenerated(edge)) {
            std::vector<EdgePoints> sides;
            try {
                sides = sides_of(edge, faces);
            } catch (const Standard_Failure&) {  // of a curve or surface that cannot be evaluated: its face will tell
            }
            for (std::size_t side = 1; side < sides.size(); ++side) gap = std::max(gap, distance_between(sides[0], sides[side], std::max(tolerance, floor_)));
            if (sides.size() == 1) free_edges.push_back({i, tolerance, std::move(sides[0])});
        }
        largest_gap_ = std::max(largest_gap_, gap);
        bands_.Bind(edge, std::max(tolerance, gap));
    }
    for (const FreeEdgeGap& found : gaps_between(free_edges, diagonal_)) {
        double& band = bands_.ChangeFind(edges.FindKey(free_edges[found.edge].id));
        band = std::max(band, found.gap);
        largest_gap_ = std::max(largest_gap_, found.gap);
        unmatched_ -= found.matched;
        if (found.matched) sets.join(edges(free_edges[found.edge].id).First(), edges(free_edges[found.other].id).First());
    }
    sets.number(shells_);
    unmatched_ += free_edges.size();
}

double EdgeBands::band(const TopoDS_Edge& edge) const {
    const double* found = bands_.Seek(edge);
    return (found ? *found : BRep_Tool::Tolerance(edge)) + floor_;
}

std::uint32_t EdgeBands::shell(const TopoDS_Face& face) const {
    const int* found = shells_.Seek(face);
    return static_cast<std::uint32_t>(found ? *found : 0);
}

}  // namespace crescente::io::occt
