// The wires of a face as closed loops in its parameters.
#pragma once

#include <string>
#include <vector>

#include <Geom_Surface.hxx>
#include <TopoDS_Face.hxx>

#include "geometry/face.h"
#include "io/occt/edge_bands.h"
#include "io/occt/loop_pieces.h"

namespace crescente::io::occt {

struct FaceLoops {
    std::vector<geometry::Loop> loops;  // consecutive pieces meet to the bit
    Box2 box;
    double widest_gap = 0;  // mm, between the end of an edge and the beginning of the next
    std::string broken;     // why these loops bound nothing; empty: they do
};

// The face must be oriented forward. `surface` is its own, in the part's space. Throws Standard_Failure where OpenCASCADE does.
FaceLoops loops_of(const TopoDS_Face& face, const Geom_Surface& surface, const EdgeBands& bands);

}  // namespace crescente::io::occt
