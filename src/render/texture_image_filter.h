// Pictures seen through footprints: trilinear between the levels of their pyramid, in several taps along a narrow footprint.
#pragma once

#include "render/texture_mapping.h"

namespace crescente::render {

// The mean of the picture over the place's footprint, or, of what is seen blurred, the nearest texel at the pyramid's level of that size. The texture has a
// decoded image.
scene::Rgba filtered_image(const scene::Texture& texture, const TexturePlace& place, bool blurred = false);

}  // namespace crescente::render
