// Textures that are computed: checker, noise, brushed metal, wood. What is finer than the footprint is averaged out.
#pragma once

#include "render/texture_mapping.h"

namespace crescente::render {

// How much of color_a there is, from 0 to 1; the rest is color_b. Units of place.at: cells, noise's largest features, scratches, rings.
double procedure_value(const scene::Texture& texture, const TexturePlace& place);

}  // namespace crescente::render
