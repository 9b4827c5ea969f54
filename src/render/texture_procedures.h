// Textures that are computed: checker, noise, brushed metal, wood, leather, flakes of metallic paint. What is finer than the footprint is averaged out.
#pragma once

#include "render/texture_mapping.h"

namespace crescente::render {

// How much of color_a there is, from 0 to 1; the rest is color_b. Units of place.at: cells, noise's largest features, scratches, rings, grains of leather, flakes.
double procedure_value(const scene::Texture& texture, const TexturePlace& place);

// Flakes in paint: cells about points, one in each unit of space, jittered (Worley 1996, "A Cellular Texture Basis Function"), each of them a mirror with a slope of its own, of which each component has a
// standard deviation of the texture's strength (as Ershov, Kolchin and Myszkowski 2001, "Rendering Pearlescent Appearance Based on Paint-Composition Modelling", distribute flakes). Where the footprint
// covers several, they are seen together: slopes fade to none, and hidden_slopes is what of their variance, in both directions, the surface's roughness has to stand for.
Vec3 flake_slope(const scene::Texture& texture, const TexturePlace& place);
double hidden_slopes(const scene::Texture& texture, const TexturePlace& place);

}  // namespace crescente::render
