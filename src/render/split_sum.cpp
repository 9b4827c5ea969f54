#include "render/split_sum.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "math/vec.h"
#include "math/vec_lanes.h"

namespace crescente::render {
namespace {

using namespace math;

constexpr double last = std::tuple_size_v<SplitSums> - 1;

SplitSum split_sum_at(double alpha, double cosine) {
    constexpr std::uint32_t samples = 64;
    const auto lambda = [alpha](double c) { return 0.5 * (std::sqrt(1 + alpha * alpha * (1 - c * c) / (c * c)) - 1); };
    const Vec3 viewer{std::sqrt(1 - cosine * cosine), 0, cosine};
    const Vec3 stretched = normalize(Vec3{alpha * viewer.x, 0, viewer.z}), across{0, 1, 0}, along = cross(stretched, across);
    double scale = 0, bias = 0;
    for (std::uint32_t i = 0; i < samples; ++i) {
        std::uint32_t reversed = 0;  // radical inverse: Hammersley's points
        for (std::uint32_t bit = 0; bit < 6; ++bit) reversed |= (i >> bit & 1) << (5 - bit);
        const double r = std::sqrt((i + 0.5) / samples), phi = 2 * pi * (reversed + 0.5) / samples;
        const double t1 = r * std::cos(phi), s = 0.5 * (1 + stretched.z), t2 = (1 - s) * std::sqrt(1 - t1 * t1) + s * r * std::sin(phi);
        const Vec3 visible = across * t1 + along * t2 + stretched * std::sqrt(std::max(0.0, 1 - t1 * t1 - t2 * t2));
        const Vec3 half = normalize(Vec3{alpha * visible.x, alpha * visible.y, std::max(1e-9, visible.z)});
        const double v_h = std::clamp(dot(viewer, half), 0.0, 1.0), n_l = 2 * v_h * half.z - viewer.z;
        if (n_l <= 0) continue;
        const double passed = (1 + lambda(cosine)) / (1 + lambda(cosine) + lambda(n_l)), m = 1 - v_h, fresnel = m * m * m * m * m;
        scale += passed * (1 - fresnel);
        bias += passed * fresnel;
    }
    return {static_cast<float>(scale / samples), static_cast<float>(bias / samples)};
}

}  // namespace

SplitSums split_sums(double alpha) {
    SplitSums sums;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double root = static_cast<double>(i) / last;
        sums[i] = split_sum_at(alpha, std::max(1e-4, root * root));
    }
    return sums;
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
