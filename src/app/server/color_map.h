// Numbers of a picture's layers as colours, for whoever wants to see where work went.
#pragma once

#include <array>

#include "app/server/message.h"
#include "scene/image.h"

namespace crescente::app {

// From dark violet over green to yellow: even in lightness, readable for the colour-blind. Display colour, 0..1; `share` is clamped to 0..1. Eleven colours of the map "viridis" (Smith and
// van der Walt 2015, matplotlib; CC0), linear between them.
std::array<float, 3> viridis(float share);

// One layer of a picture with all layers, as display colours 0..1 in a layer "color": samples by their logarithm up to the most that the settings allow, influence by itself from 0 to 1, level from
// none to the level asked for.
scene::Image through_color_map(const scene::Image& picture, ShownLayer layer, const scene::Settings& settings);

}  // namespace crescente::app
