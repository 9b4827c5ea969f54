// Curves in the parameters of a surface, as pieces of loops.
#pragma once

#include <vector>

#include <Geom2d_Curve.hxx>

#include "io/occt/loop_pieces.h"

namespace crescente::io::occt {

// The curve from t0 to t1. Lines, circles, ellipses and whatever is polynomial or rational are kept exactly; the rest (offset curves) is
// approximated to `tolerance` in the parameters. Throws Standard_Failure where OpenCASCADE cannot make anything of it.
std::vector<LoopPiece> pieces_of(Handle(Geom2d_Curve) curve, double t0, double t1, double tolerance);

}  // namespace crescente::io::occt
