// An edge-aware filter of sampled light on the grid of pixel corners: the à-trous wavelet transform (Dammertz, Sewtz, Hanika and Lensch 2010, "Edge-Avoiding À-Trous
// Wavelet Transform for fast Global Illumination Filtering"), led by variance (Schied et al. 2017, "Spatiotemporal Variance-Guided Filtering", section 4.2).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/color.h"
#include "parallel/pool.h"

namespace crescente::render {

using namespace math;

// What stops the filter at a corner: light is not taken across borders of surfaces, creases and steps.
struct Guide {
    std::array<float, 3> position{}, normal{};  // m, relative to the viewer; unit
    std::uint32_t surface = nothing;            // points of different ones have nothing to tell each other
    float aim = 0;                              // variance from which on the point is left as it is; of shares, the part of its own
    float roughness = 1;                        // of what is glossy: how far (radians, about) a reflected direction may turn and still see the same

    static constexpr std::uint32_t nothing = 0xffffffff;
};

// Light at a corner, without the colour that the surface gives it. Luminance: of both parts together.
struct FilteredLight {
    Rgb diffuse, glossy;
    float luminance = 0;
    float variance = -1;  // of that luminance; negative, and always of shares: not known, to be found from the neighbours
};

// How alike two surfaces are, 0 to 1, for light to be taken from one to the other.
struct Alikeness {
    float diffuse = 0, glossy = 0;
};
Alikeness alikeness(const Guide& a, const Guide& b);

// The same for two lights whose variances are known: how likely they are one, but for noise.
float likelihood(const FilteredLight& a, const FilteredLight& b);

// Of light that a catcher gets, as as_caught() has it: what arrives of it.
float share_of(Rgb caught);

struct GuidedGrid {
    int width = 0, height = 0;
    bool shares = false;  // the diffuse light is that of catchers (render/catcher.h): its luminance is the share of it that arrives
    std::vector<Guide> guides;
    std::vector<FilteredLight> light;
};

inline constexpr int filter_reach = 33;  // no corner further away, in either direction, has a say

// Replaces the light at all points whose variance is above their aim. The same for any number of threads.
void filter(GuidedGrid& grid, parallel::Pool& pool);

}  // namespace crescente::render
