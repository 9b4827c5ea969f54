// How far each edge of a part may be from where its faces end.
#pragma once

#include <cstdint>

#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_DataMapOfShapeReal.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

namespace crescente::io::occt {

class EdgeBands {
public:
    // Measures every edge of the part at 12 places: the gap between the points that its two faces (or the two sides of a seam) give it. Edges of one
    // face only are compared with such edges of other faces that run along the same way, as files without shared edges have them (IGES).
    explicit EdgeBands(const TopoDS_Shape& part);

    double band(const TopoDS_Edge& edge) const;  // max(declared tolerance, measured gap) + 1e-6 of the part's diagonal; mm
    std::uint32_t shell(const TopoDS_Face& face) const;  // the same number for faces that edges join, directly or by others
    double diagonal() const { return diagonal_; }
    double largest_tolerance() const { return largest_tolerance_; }
    double largest_gap() const { return largest_gap_; }
    std::uint64_t unmatched() const { return unmatched_; }  // edges without a second face, found or near

private:
    TopTools_DataMapOfShapeReal bands_;
    TopTools_DataMapOfShapeInteger shells_;
    double diagonal_ = 0, largest_tolerance_ = 0, largest_gap_ = 0, floor_ = 0;
    std::uint64_t unmatched_ = 0;
};

}  // namespace crescente::io::occt
