#include "render/split_sum.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "render/fresnel.h"
#include "render/microfacets.h"

namespace crescente::render {
namespace {

constexpr double last = last_cosine;

// The facets that are seen at each of the cosines, each with its share of all light from there: what(cell, share, viewer, normal, v_h, passed), v_h the cosine between the facet's normal and the viewer,
// passed(w) the share of what leaves it for w that other facets let through.
//
// A facet's normal depends on two numbers in [0, 1] (Microfacets::sample_seen). The first is an angle: evenly spaced ones do well. Of the second, the steep facets at
// its end weigh most in the error; the substitution 1 - u2 = (1 - t)^3 (1 + 3 t) crowds the points there.
template <class What>
void for_each_facet(const Microfacets& facets, int angles, int tilts, const What& what) {
    double weights = 0;
    for (int k = 0; k < tilts; ++k) {
        const double t = (k + 0.5) / tilts, rest = 1 - t;
        weights += angles * t * rest * rest;
    }
    for (std::size_t i = 0; i < std::tuple_size_v<SplitSums>; ++i) {
        const double cosine = std::max(1e-4, tabled_cosine(i));
        const Vec3 viewer{std::sqrt(1 - cosine * cosine), 0, cosine};
        const double hidden = facets.hidden(viewer);
        const auto passed = [&](Vec3 w) { return (1 + hidden) / (1 + hidden + facets.hidden(w)); };
        for (int k = 0; k < tilts; ++k) {
            const double t = (k + 0.5) / tilts, rest = 1 - t, share = t * rest * rest / weights, u2 = 1 - rest * rest * rest * (1 + 3 * t);
            for (int j = 0; j < angles; ++j) {
                const Vec3 h = facets.sample_seen(viewer, 0.5 * (j + 0.5) / angles, u2);  // the other half is its mirror image
                what(i, share, viewer, h, std::clamp(dot(viewer, h), 0.0, 1.0), passed);
            }
        }
    }
}

FacetSums sums_of(const Microfacets& facets, int angles, int tilts) {
    CosineTable<double> scale{}, bias{};
    CosineTable<CosineTable<double>> shares{};
    for_each_facet(facets, angles, tilts, [&](std::size_t from, double share, Vec3 v, Vec3 h, double v_h, const auto& passed) {
        const Vec3 l = h * (2 * v_h) - v;
        if (l.z <= 0) return;
        const double reflected = share * passed(l), fresnel = fifth_power(1 - v_h);
        scale[from] += reflected * (1 - fresnel), bias[from] += reflected * fresnel;
        const auto [by, t] = step_at(std::sqrt(v_h), shares.size());
        shares[by][from] += reflected * (1 - double{t}), shares[by + 1][from] += reflected * double{t};
    });
    FacetSums sums{};
    for (std::size_t i = 0; i < sums.sums.size(); ++i) {
        sums.sums[i] = {static_cast<float>(scale[i]), static_cast<float>(bias[i])};
        for (std::size_t by = 0; by < sums.shares.size(); ++by) sums.shares[by][i] = static_cast<float>(shares[by][i]);
    }
    return sums;
}

constexpr double fourth_power(double x) { return x * x * x * x; }

// Of each cell of the table: where it begins, in the root s of the cosine, and how much the fourth and the fifth power of s rise in it.
struct Cell {
    double begin, fourth, fifth;
};
constexpr std::array<Cell, std::tuple_size_v<SplitSums> - 1> cells = [] {
    std::array<Cell, std::tuple_size_v<SplitSums> - 1> all{};
    for (std::size_t i = 0; i < all.size(); ++i) {
        const double s0 = static_cast<double>(i) / last, s1 = static_cast<double>(i + 1) / last;
        all[i] = {s0, fourth_power(s1) - fourth_power(s0), fourth_power(s1) * s1 - fourth_power(s0) * s0};
    }
    return all;
}();

// Twice the integral over a cell of e, linear in s, times the cosine s^2: that of 4 s^3 (a + b s) over s.
double over_cell(std::size_t i, double e0, double e1) {
    const double b = (e1 - e0) * last, a = e0 - b * cells[i].begin;
    return a * cells[i].fourth + b * 0.8 * cells[i].fifth;
}

}  // namespace

CosineTable<float> reflectance(const FacetShares& shares, const CosineTable<float>& law) {
    CosineTable<float> sum{};
    for (std::size_t by = 0; by < shares.size(); ++by) {
        for (std::size_t from = 0; from < sum.size(); ++from) sum[from] += shares[by][from] * law[by];
    }
    return sum;
}

FacetSums facet_sums(double alpha) { return sums_of(Microfacets{alpha, alpha}, 8, 16); }

GrainSums grain_sums(double alpha_along, double alpha_across) {
    // What is seen along x, and with the roughnesses exchanged what is seen along y.
    const FacetSums along = sums_of(Microfacets{alpha_along, alpha_across}, 16, 24), across = sums_of(Microfacets{alpha_across, alpha_along}, 16, 24);
    GrainSums sums;
    sums.mean = between(along, across, 0.5f);
    for (std::size_t i = 0; i < along.sums.size(); ++i) {
        sums.lean.sums[i] = (along.sums[i] - across.sums[i]) * 0.5f;
        for (std::size_t k = 0; k < along.shares.size(); ++k) sums.lean.shares[i][k] = (along.shares[i][k] - across.shares[i][k]) * 0.5f;
    }
    return sums;
}

FacetSums smooth_facet_sums() {
    FacetSums sums{};
    for (std::size_t i = 0; i < sums.sums.size(); ++i) {
        const double fresnel = fifth_power(1 - tabled_cosine(i));
        sums.sums[i] = {static_cast<float>(1 - fresnel), static_cast<float>(fresnel)};
        sums.shares[i][i] = 1;
    }
    return sums;
}

SplitSums glass_sums(double alpha, double eta) {
    CosineTable<double> reflected{}, transmitted{};
    for_each_facet(Microfacets{alpha, alpha}, 12, 32, [&](std::size_t from, double share, Vec3 v, Vec3 h, double v_h, const auto& passed) {
        const double fresnel = fresnel_dielectric(v_h, eta), sin2 = (1 - v_h * v_h) / (eta * eta);
        const Vec3 l = h * (2 * v_h) - v;
        if (l.z > 0) reflected[from] += share * fresnel * passed(l);
        if (sin2 >= 1) return;
        const Vec3 through = h * (v_h / eta - std::sqrt(1 - sin2)) - v / eta;
        if (through.z < 0) transmitted[from] += share * (1 - fresnel) * passed(through);
    });
    SplitSums sums;
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] = {static_cast<float>(reflected[i]), static_cast<float>(transmitted[i])};
    return sums;
}

double mean_over_light(const CosineTable<float>& values) {
    double mean = 0;
    for (std::size_t i = 0; i + 1 < values.size(); ++i) mean += over_cell(i, values[i], values[i + 1]);
    return mean;
}

double mean_of_sums(const SplitSums& sums, double scale, double bias) {
    double mean = 0;
    for (std::size_t i = 0; i + 1 < sums.size(); ++i) mean += over_cell(i, scale * sums[i].scale + bias * sums[i].bias, scale * sums[i + 1].scale + bias * sums[i + 1].bias);
    return mean;
}

MissingCells missing_cells(const SplitSums& sums) {
    std::array<double, std::tuple_size_v<MissingCells>> upto;
    double whole = 0;
    for (std::size_t i = 0; i < upto.size(); ++i) upto[i] = whole += over_cell(i, sums[i].missing(), sums[i + 1].missing());
    MissingCells cells{};
    for (std::size_t i = 0; whole > 0 && i < cells.size(); ++i) cells[i] = static_cast<float>(upto[i] / whole);
    return cells;
}

double draw_cosine(const MissingCells& cells, double u) {
    // Even in the square of the cosine, in a cell: by the cosine.
    const auto i = static_cast<std::size_t>(std::min(std::upper_bound(cells.begin(), cells.end(), u), cells.end() - 1) - cells.begin());
    const double below = i == 0 ? 0 : cells[i - 1], t = std::clamp((u - below) / (cells[i] - below), 0.0, 1.0);
    return std::sqrt(fourth_power(i / last) + t * (fourth_power((i + 1) / last) - fourth_power(i / last)));
}

double density_of_cosine(const MissingCells& cells, double cosine) {
    const auto i = std::min(static_cast<std::size_t>(last * std::sqrt(std::clamp(cosine, 0.0, 1.0))), cells.size() - 1);
    const double share = double(cells[i]) - (i == 0 ? 0 : cells[i - 1]);
    return share * cosine / (pi * (fourth_power((i + 1) / last) - fourth_power(i / last)));
}

std::span<const FacetSums> facet_sums_by_roughness() {
    constexpr std::size_t steps = 128;
    static const std::vector<FacetSums> rows = [] {
        std::vector<FacetSums> all;
        for (std::size_t i = 0; i <= steps; ++i) {
            const double roughness = static_cast<double>(i) / steps;
            all.push_back(facet_sums(std::max(1e-3, roughness * roughness)));
        }
        return all;
    }();
    return rows;
}

FacetSums tabled_facet_sums(double alpha) { return row_at(facet_sums_by_roughness(), std::sqrt(std::clamp(alpha, 0.0, 1.0))); }

GrainSums tabled_grain_sums(double alpha_along, double alpha_across) {
    constexpr std::size_t roughnesses = 16, stretches = 8;
    static const std::vector<std::vector<GrainSums>> table = [] {
        std::vector<std::vector<GrainSums>> all(roughnesses + 1);
        for (std::size_t i = 0; i <= roughnesses; ++i) {
            const double roughness = static_cast<double>(i) / roughnesses, across = std::max(1e-3, roughness * roughness);
            for (std::size_t k = 0; k <= stretches; ++k) {
                const double stretch = static_cast<double>(k) / stretches;
                all[i].push_back(grain_sums(across + (1 - across) * stretch * stretch, across));
            }
        }
        return all;
    }();
    const double stretch = std::sqrt(alpha_across < 1 ? std::clamp((alpha_along - alpha_across) / (1 - alpha_across), 0.0, 1.0) : 0);
    const auto [i, t] = step_at(std::sqrt(std::clamp(alpha_across, 0.0, 1.0)), table.size());
    return between(row_at(table[i], stretch), row_at(table[i + 1], stretch), t);
}

}  // namespace crescente::render
