// What an edit makes of the trees of a tile: what no longer holds is taken out of them, so that the stages, which do what is missing, find it to do.
#pragma once

#include <span>

#include "render/change.h"
#include "render/forest.h"

namespace crescente::render {

// Brings the tile's trees from the world before to the world now. Nodes whose rays may end elsewhere are taken out with all below them; lights whose ways
// to a node may be others are untried again; weights, what is hidden and what is pending are those that the world now gives. Traces nothing. Several
// edits are gone through one after the other, then the tile is settled. watched: somebody looks before that, and `pixels` of a tile that is touched are the
// picture from before: the one that was `displayed`, if that is not empty, else what its trees said.
void revise(Tile& tile, const World& before, const World& now, const Change& change, bool watched, std::span<const Rgb> displayed);

// Lights anew what needs no ray for it, and sends the tile back to the first stage that finds something missing. Until the stages are through, it shows
// what holds, or what it was.
void settle(Tile& tile, const World& world, std::span<const scene::Level> level_of_stage);

}  // namespace crescente::render
