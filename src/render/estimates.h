// What levels that sample know of the light at a node: sums of samples by group of lights, kept at the node. Strength and colour of a group stand outside of its
// sums, so that changing them asks for no sample.
#pragma once

#include <cstddef>
#include <cstdint>

#include "math/color.h"

namespace crescente::render {

using namespace math;

struct Tile;
struct World;

// The light of one group at one node, from so many samples as Tile::samples says.
struct Estimate {
    Rgb diffuse, glossy;       // sums of radiance to the viewer, by part of the material, for a group of scale 1; of catchers: as render/catcher.h says
    std::uint32_t spread = 0;  // until the pilot is complete: sum of squared luminances; from then on how the pilot's samples were spread
};
static_assert(sizeof(Estimate) == 28);

// The first samples of every node: they show how many more it needs (two-stage sampling after Stein 1945, "A Two-Sample Test for a Linear Hypothesis Whose
// Power is Independent of the Variance"). What they showed is kept, so that an edit that keeps samples comes to the decisions of a fresh render.
inline constexpr std::uint32_t pilot = 16;
inline constexpr std::uint32_t fewest_to_tell = 4;  // how noisy they are, before

// Groups that estimates are kept for: those of World::emitters, and one for the light of all lamps without extent that comes by way of other surfaces.
std::size_t estimate_groups(const World& world);
Rgb scale_of_group(const World& world, std::size_t group);

// Adds sample number `index` of a node, counted from 0, to the sums.
void add_sample(Estimate& estimate, std::uint32_t index, Rgb diffuse, Rgb glossy);

// What the samples of a node say, which must have some: radiance to the viewer, by part of the material.
struct SampledParts {
    Rgb diffuse, glossy;
    float deviation = -1;  // of the luminance over single samples; negative: too few to tell
};
SampledParts sampled_parts(const World& world, const Tile& tile, std::uint32_t node);
Rgb sampled_radiance(const World& world, const Tile& tile, std::uint32_t node);

// Samples for which the error of pixels by the noise of a node, and of those of the node's like in all their corners, is below the settings' noise, relative to
// how bright the node is in the pixel. depth: SplitDepth::place of the node's root. Infinite: there are too few to tell.
double samples_wanted(const World& world, const Tile& tile, std::uint32_t node, unsigned depth);

// Samples that a node whose pilot is complete should have in all: what it wants, as a power of two times the pilot's, up to the settings' bound.
std::uint32_t samples_needed(const World& world, const Tile& tile, std::uint32_t node, unsigned depth);

// How bright an estimate's pilot was, and how its samples were spread about that: luminances, added over all groups as if these erred together.
struct Spread {
    float mean = 0, deviation = 0;
};
Spread spread_of(const World& world, const Estimate* estimates, std::uint32_t samples);
Spread spread_of(const Estimate& estimate, std::uint32_t samples);  // of one

// The same for samples spread like this, of light that weighs so much in a pixel, which is the mean of so many; and as a power of two times the pilot's, up to
// the settings' bound.
double samples_wanted(const World& world, const Spread& spread, double influence, double mean_of);
std::uint32_t samples_needed(const World& world, double wanted);

}  // namespace crescente::render
