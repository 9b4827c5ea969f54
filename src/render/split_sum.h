// Reflectance of a rough surface for all the light that comes from, or goes to, one direction: the integral of its ggx lobe with the
// height-correlated Smith term, split into a part that scales with f0 and one that does not (Karis 2013, "Real Shading in Unreal Engine 4").
#pragma once

#include <algorithm>
#include <array>

#include "math/lanes.h"

namespace crescente::render {

// Reflectance = scale * f0 + bias; scale and bias >= 0, their sum <= 1 (less for rough surfaces: light that goes on between facets is missing).
struct SplitSum {
    float scale = 0, bias = 0;

    double missing() const { return std::max(0.0, 1 - double(scale) - bias); }
    bool operator==(const SplitSum&) const = default;
};

// The sums of one roughness at cosines (i / 24)^2 to the normal, close together where grazing light makes them steep.
using SplitSums = std::array<SplitSum, 25>;

// alpha: of ggx, > 0. The sums are within 0.015 of the integrals at cosines over 0.02, and within 0.04 below.
SplitSums split_sums(double alpha);
// The same from a table over perceptual roughness (the root of alpha), interpolated: within 0.002, and a thousand times as fast; for surfaces that are of another roughness everywhere.
SplitSums tabled_split_sums(double alpha);

// Of a surface that is rougher along one of its directions than across, where they depend on the azimuth too: mean + lean * cos(2 azimuth), which is exact along and across, and
// between them within 0.02.
struct GrainSums {
    SplitSums mean, lean;
};
GrainSums grain_sums(double alpha_along, double alpha_across);
GrainSums tabled_grain_sums(double alpha_along, double alpha_across);  // as tabled_split_sums

// Those of a mirror: nothing is missing.
SplitSums smooth_split_sums();

// At a cosine from 0 to 1, by linear interpolation.
SplitSum split_sum(const SplitSums& sums, double cosine);

// The same for eight sums, each at its own cosine, to the bit. Lanes whose bit is not set have any value.
struct SplitSumLanes {
    math::FloatLanes scale{}, bias{};
};
SplitSumLanes split_sum(const SplitSums* const (&sums)[math::lane_count], unsigned lanes, const math::Lanes& cosine);

// The sums of a rough surface between two media that both let light through, with Fresnel's equations for its facets: scale is the share that it reflects, bias
// the share that it transmits. eta: index behind over index in front, for light from the front.
SplitSums glass_sums(double alpha, double eta);

// Mean of scale * a + bias * b over all light that meets the surface, each direction by its cosine. Exact for the interpolated sums.
double mean_of_sums(const SplitSums& sums, double a = 1, double b = 1);

// What is missing from the sums, 1 - scale - bias, as a density to draw cosines from: by cell between the cosines, the share of cells up to it. All 0 if nothing is.
using MissingCells = std::array<float, std::tuple_size_v<SplitSums> - 1>;
MissingCells missing_cells(const SplitSums& sums);

// A cosine for a number in [0, 1), and the density (1/sr) of directions at a cosine, about even turned about the normal.
double draw_cosine(const MissingCells& cells, double u);
double density_of_cosine(const MissingCells& cells, double cosine);

}  // namespace crescente::render
