// Clean pictures early: light that was sampled too seldom is filtered among the nodes that neighbours see by the same way (the surface itself, what is mirrored in
// it, what is seen through it), without the colours of surfaces; at catchers, the light that reaches them and what would if nothing were in
// its way, whose ratio is what they show. The nodes themselves stay as they are. What has as many samples as it wants is not touched, and
// what has few gives way to its own samples as these arrive.
#pragma once

#include <span>
#include <vector>

#include "parallel/pool.h"
#include "render/forest.h"
#include "render/guided_filter.h"
#include "render/world.h"

namespace crescente::render {

inline constexpr int denoise_reach = filter_reach + 2;  // pixels; what a pixel shows depends on no node further away

// By tile. Empty for tiles where there is nothing to add. The tiles must know the world as it is; those that
// are null are not there. The same for any number of threads.
std::vector<Corrections> denoise(const World& world, std::span<const Tile* const> tiles, parallel::Pool& pool);

}  // namespace crescente::render
