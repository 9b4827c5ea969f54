// Reflectance of a rough surface for all the light that comes from, or goes to, one direction: the integral of its ggx lobe with the
// height-correlated Smith term, split into a part that scales with f0 and one that does not (Karis 2013, "Real Shading in Unreal Engine 4").
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "render/cosine_table.h"

namespace crescente::render {

// Reflectance = scale * f0 + bias, with Schlick's approximation; scale and bias >= 0, their sum <= 1 (less for rough surfaces: light that goes on between facets is missing).
struct SplitSum {
    float scale = 0, bias = 0;

    float whole() const { return scale + bias; }  // if facets reflect all
    double missing() const { return std::max(0.0, 1 - double(scale) - bias); }
    SplitSum operator+(SplitSum o) const { return {scale + o.scale, bias + o.bias}; }
    SplitSum operator-(SplitSum o) const { return {scale - o.scale, bias - o.bias}; }
    SplitSum operator*(float f) const { return {scale * f, bias * f}; }
    bool operator==(const SplitSum&) const = default;
};

// The sums of one roughness.
using SplitSums = CosineTable<SplitSum>;

// What any other law of reflection comes to: of all light of a direction, at each cosine of the table, the share that is reflected, if all were, by facets whose own cosine to that direction is about one of
// the same table's: facets[by][from].
using FacetShares = CosineTable<CosineTable<float>>;

struct FacetSums {
    SplitSums sums;
    FacetShares shares;
};
inline FacetSums between(const FacetSums& a, const FacetSums& b, float t) { return {between(a.sums, b.sums, t), between(a.shares, b.shares, t)}; }

// Reflectance of the whole surface, of facets that reflect law[i] at the cosines of the table.
CosineTable<float> reflectance(const FacetShares& shares, const CosineTable<float>& law);

// alpha: of ggx, > 0. The sums are within 0.015 of the integrals at cosines over 0.02, and within 0.04 below.
FacetSums facet_sums(double alpha);
// The same from a table over perceptual roughness (the root of alpha), interpolated: within 0.002, and a thousand times as fast; for surfaces that are of another roughness everywhere.
FacetSums tabled_facet_sums(double alpha);
std::span<const FacetSums> facet_sums_by_roughness();  // the rows of that table, from a roughness of 0 to 1

// Of a surface that is rougher along one of its directions than across, where they depend on the azimuth too: mean + lean * cos(2 azimuth), which is exact along and across, and
// between them within 0.02.
struct GrainSums {
    FacetSums mean, lean;
};
inline GrainSums between(const GrainSums& a, const GrainSums& b, float t) { return {between(a.mean, b.mean, t), between(a.lean, b.lean, t)}; }
GrainSums grain_sums(double alpha_along, double alpha_across);
GrainSums tabled_grain_sums(double alpha_along, double alpha_across);  // as tabled_facet_sums

// Those of a mirror: nothing is missing.
FacetSums smooth_facet_sums();

// The sums of a rough surface between two media that both let light through, with Fresnel's equations for its facets: scale is the share that it reflects, bias
// the share that it transmits. eta: index behind over index in front, for light from the front.
SplitSums glass_sums(double alpha, double eta);

// Mean over all light that meets the surface, each direction by its cosine. Exact for the interpolated values.
double mean_over_light(const CosineTable<float>& values);
double mean_of_sums(const SplitSums& sums, double a = 1, double b = 1);  // of scale * a + bias * b

// What is missing from the sums, 1 - scale - bias, as a density to draw cosines from: by cell between the cosines, the share of cells up to it. All 0 if nothing is.
using MissingCells = std::array<float, std::tuple_size_v<SplitSums> - 1>;
MissingCells missing_cells(const SplitSums& sums);

// A cosine for a number in [0, 1), and the density (1/sr) of directions at a cosine, about even turned about the normal.
double draw_cosine(const MissingCells& cells, double u);
double density_of_cosine(const MissingCells& cells, double cosine);

}  // namespace crescente::render
