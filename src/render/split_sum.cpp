#include "render/split_sum.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "math/vec_lanes.h"
#include "render/fresnel.h"
#include "render/microfacets.h"

namespace crescente::render {
namespace {

constexpr double last = std::tuple_size_v<SplitSums> - 1;

// Means over the facets that are seen at each of the cosines. what(v_h, passed) says what one facet adds: v_h is the cosine between its normal and the viewer,
// passed(w) the share of what leaves it for w that other facets let through.
//
// A facet's normal depends on two numbers in [0, 1] (Microfacets::sample_seen). The first is an angle: evenly spaced ones do well. Of the second, the steep facets at
// its end weigh most in the error; the substitution 1 - u2 = (1 - t)^3 (1 + 3 t) crowds the points there.
template <class What>
SplitSums means_over_facets(const Microfacets& facets, int angles, int tilts, const What& what) {
    SplitSums sums;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double root = static_cast<double>(i) / last, cosine = std::max(1e-4, root * root);
        const Vec3 viewer{std::sqrt(1 - cosine * cosine), 0, cosine};
        const double hidden = facets.hidden(viewer);
        double scale = 0, bias = 0, weights = 0;
        for (int k = 0; k < tilts; ++k) {
            const double t = (k + 0.5) / tilts, rest = 1 - t, weight = t * rest * rest, u2 = 1 - rest * rest * rest * (1 + 3 * t);
            for (int j = 0; j < angles; ++j) {
                const Vec3 h = facets.sample_seen(viewer, 0.5 * (j + 0.5) / angles, u2);  // the other half is its mirror image
                const double v_h = std::clamp(dot(viewer, h), 0.0, 1.0);
                const auto passed = [&](Vec3 w) { return (1 + hidden) / (1 + hidden + facets.hidden(w)); };
                const auto [a, b] = what(viewer, h, v_h, passed);
                scale += a * weight, bias += b * weight, weights += weight;
            }
        }
        sums[i] = {static_cast<float>(scale / weights), static_cast<float>(bias / weights)};
    }
    return sums;
}

SplitSums sums_of(const Microfacets& facets, int angles, int tilts) {
    return means_over_facets(facets, angles, tilts, [](Vec3 v, Vec3 h, double v_h, const auto& passed) {
        const Vec3 l = h * (2 * v_h) - v;
        if (l.z <= 0) return std::pair{0.0, 0.0};
        const double p = passed(l), fresnel = fifth_power(1 - v_h);
        return std::pair{p * (1 - fresnel), p * fresnel};
    });
}

void add_weighted(SplitSums& sum, const SplitSums& one, float weight) {
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i].scale += weight * one[i].scale, sum[i].bias += weight * one[i].bias;
}

double fourth_power(double x) { return x * x * x * x; }

// Twice the integral over a cell of e, linear in s, times the cosine s^2: that of 4 s^3 (a + b s) over s.
double over_cell(std::size_t i, double e0, double e1) {
    const double s0 = static_cast<double>(i) / last, s1 = static_cast<double>(i + 1) / last, b = (e1 - e0) * last, a = e0 - b * s0;
    return a * (fourth_power(s1) - fourth_power(s0)) + b * 0.8 * (fourth_power(s1) * s1 - fourth_power(s0) * s0);
}

}  // namespace

SplitSums split_sums(double alpha) { return sums_of(Microfacets{alpha, alpha}, 8, 16); }

GrainSums grain_sums(double alpha_along, double alpha_across) {
    // What is seen along x, and with the roughnesses exchanged what is seen along y.
    const SplitSums along = sums_of(Microfacets{alpha_along, alpha_across}, 16, 24), across = sums_of(Microfacets{alpha_across, alpha_along}, 16, 24);
    GrainSums sums;
    for (std::size_t i = 0; i < along.size(); ++i) {
        sums.mean[i] = {0.5f * (along[i].scale + across[i].scale), 0.5f * (along[i].bias + across[i].bias)};
        sums.lean[i] = {0.5f * (along[i].scale - across[i].scale), 0.5f * (along[i].bias - across[i].bias)};
    }
    return sums;
}

SplitSums smooth_split_sums() {
    SplitSums sums;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double root = static_cast<double>(i) / last, fresnel = fifth_power(1 - root * root);
        sums[i] = {static_cast<float>(1 - fresnel), static_cast<float>(fresnel)};
    }
    return sums;
}

SplitSums glass_sums(double alpha, double eta) {
    return means_over_facets(Microfacets{alpha, alpha}, 12, 32, [eta](Vec3 v, Vec3 h, double v_h, const auto& passed) {
        const double fresnel = fresnel_dielectric(v_h, eta), sin2 = (1 - v_h * v_h) / (eta * eta);
        const Vec3 l = h * (2 * v_h) - v;
        std::pair<double, double> shares{l.z > 0 ? fresnel * passed(l) : 0, 0};
        if (sin2 < 1) {
            const Vec3 through = h * (v_h / eta - std::sqrt(1 - sin2)) - v / eta;
            if (through.z < 0) shares.second = (1 - fresnel) * passed(through);
        }
        return shares;
    });
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

SplitSums tabled_split_sums(double alpha) {
    constexpr std::size_t steps = 128;
    static const std::vector<SplitSums> table = [] {
        std::vector<SplitSums> rows;
        for (std::size_t i = 0; i <= steps; ++i) {
            const double roughness = static_cast<double>(i) / steps;
            rows.push_back(split_sums(std::max(1e-3, roughness * roughness)));
        }
        return rows;
    }();
    const double place = std::sqrt(std::clamp(alpha, 0.0, 1.0)) * steps;
    const auto i = std::min(static_cast<std::size_t>(place), steps - 1);
    const auto t = static_cast<float>(place - static_cast<double>(i));
    SplitSums sums;
    for (std::size_t k = 0; k < sums.size(); ++k) {
        const SplitSum &a = table[i][k], &b = table[i + 1][k];
        sums[k] = {a.scale + (b.scale - a.scale) * t, a.bias + (b.bias - a.bias) * t};
    }
    return sums;
}

GrainSums tabled_grain_sums(double alpha_along, double alpha_across) {
    constexpr std::size_t roughnesses = 16, stretches = 8;
    static const std::vector<GrainSums> table = [] {
        std::vector<GrainSums> rows;
        for (std::size_t i = 0; i <= roughnesses; ++i) {
            const double roughness = static_cast<double>(i) / roughnesses, across = std::max(1e-3, roughness * roughness);
            for (std::size_t k = 0; k <= stretches; ++k) {
                const double stretch = static_cast<double>(k) / stretches;
                rows.push_back(grain_sums(across + (1 - across) * stretch * stretch, across));
            }
        }
        return rows;
    }();
    const double stretch2 = alpha_across < 1 ? (alpha_along - alpha_across) / (1 - alpha_across) : 0;
    const double x = std::sqrt(std::clamp(alpha_across, 0.0, 1.0)) * roughnesses, y = std::sqrt(std::clamp(stretch2, 0.0, 1.0)) * stretches;
    const auto i = std::min(static_cast<std::size_t>(x), roughnesses - 1), k = std::min(static_cast<std::size_t>(y), stretches - 1);
    const auto s = static_cast<float>(x - static_cast<double>(i)), t = static_cast<float>(y - static_cast<double>(k));
    GrainSums sums{};
    for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t b = 0; b < 2; ++b) {
            const GrainSums& one = table[(i + a) * (stretches + 1) + k + b];
            const float weight = (a ? s : 1 - s) * (b ? t : 1 - t);
            add_weighted(sums.mean, one.mean, weight), add_weighted(sums.lean, one.lean, weight);
        }
    }
    return sums;
}

SplitSum split_sum(const SplitSums& sums, double cosine) {
    const double place = last * std::sqrt(std::clamp(cosine, 0.0, 1.0));
    const auto i = std::min(static_cast<std::size_t>(place), sums.size() - 2);
    const auto t = static_cast<float>(place - static_cast<double>(i));
    return {sums[i].scale + (sums[i + 1].scale - sums[i].scale) * t, sums[i].bias + (sums[i + 1].bias - sums[i].bias) * t};
}

SplitSumLanes split_sum(const SplitSums* const (&sums)[lane_count], unsigned lanes, const Lanes& cosine) {
    const Lanes zero{}, one = zero + 1.0;
    const Lanes place = last * square_root(lesser(greater(cosine, zero), one));
    Lanes first{};
    SplitSumLanes low, high;
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        const auto i = std::min(static_cast<int>(place[lane]), static_cast<int>(last) - 1);
        const SplitSum* entry = sums[lane]->data() + i;
        first[lane] = i;
        low.scale[lane] = entry[0].scale, low.bias[lane] = entry[0].bias, high.scale[lane] = entry[1].scale, high.bias[lane] = entry[1].bias;
    }
    const FloatLanes t = to_floats(place - first);
    return {low.scale + (high.scale - low.scale) * t, low.bias + (high.bias - low.bias) * t};
}

}  // namespace crescente::render
