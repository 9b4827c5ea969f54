// Curves that exporters and healers approximated by thousands of tiny pieces, with fewer.
#pragma once

#include <vector>

#include "io/occt/loop_pieces.h"

namespace crescente::io::occt {

// The same curve by lines and cubics, each as long as it stays within `tolerance` of the given pieces (tried at four places a piece). Distances are taken
// with u times `scale_u` and v times `scale_v`, so that they mean lengths in space. Ends stay where they are to the bit. Curves of few pieces come
// back as they are.
std::vector<LoopPiece> thinned(const std::vector<LoopPiece>& pieces, double scale_u, double scale_v, double tolerance);

}  // namespace crescente::io::occt
