// Reflectance of a rough surface for all the light that comes from, or goes to, one direction: the integral of its ggx lobe with the
// height-correlated Smith term, split into a part that scales with f0 and one that does not (Karis 2013, "Real Shading in Unreal Engine 4").
#pragma once

#include <array>

#include "math/lanes.h"

namespace crescente::render {

// Reflectance = scale * f0 + bias; scale and bias >= 0, their sum <= 1 (less for rough surfaces: light that goes on between facets is lost).
struct SplitSum {
    float scale = 0, bias = 0;
    bool operator==(const SplitSum&) const = default;
};

// The sums of one roughness at cosines (i / 16)^2 to the normal, close together where grazing light makes them steep.
using SplitSums = std::array<SplitSum, 17>;

// alpha: of ggx, > 0. Visible normals are sampled evenly (Heitz 2018); the sums are within 0.03 of the integrals.
SplitSums split_sums(double alpha);
// The same from a table over perceptual roughness (the root of alpha), interpolated: within 0.002, and a thousand times as fast; for surfaces that are of another roughness everywhere.
SplitSums tabled_split_sums(double alpha);

// At a cosine from 0 to 1, by linear interpolation.
SplitSum split_sum(const SplitSums& sums, double cosine);

// The same for eight sums, each at its own cosine, to the bit. Lanes whose bit is not set have any value.
struct SplitSumLanes {
    math::FloatLanes scale{}, bias{};
};
SplitSumLanes split_sum(const SplitSums* const (&sums)[math::lane_count], unsigned lanes, const math::Lanes& cosine);

}  // namespace crescente::render
