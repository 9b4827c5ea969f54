// What an edit makes of the trees of a tile: what no longer holds is taken out of them, so that the stages, which do what is missing, find it to do.
#pragma once

#include "render/change.h"
#include "render/forest.h"

namespace crescente::render {

// Brings the tile's trees from the world before to the world now. Nodes whose rays may end elsewhere are taken out with all below them; lights whose ways
// to a node may be others are untried again; weights, what is hidden and what is pending are those that the world now gives. If anything of that changes
// the picture the tile goes back to `repeated`, the first stage that may find something missing (camera rays at every corner), and shows what holds, or
// what it was, until the stages are through. Traces nothing. Returns whether the picture may change.
bool revise(Tile& tile, const World& before, const World& now, const Change& change, int repeated);

}  // namespace crescente::render
