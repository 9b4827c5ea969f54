// Whether directions are drawn with the density that is told of them (Pearson's chi-square test).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "accel/random_scenes.h"

namespace crescente::render::testing {

using namespace math;

// The share of normal deviates above this is p: what a chi-square sum with k degrees of freedom comes to (Wilson and Hilferty 1931).
inline double deviate_of(double chi_square, double freedom) {
    const double a = 2 / (9 * freedom);
    return (std::cbrt(chi_square / freedom) - (1 - a)) / std::sqrt(a);
}

// Directions within the angle of this cosine of an axis, in cells of equal solid angle.
struct DirectionCells {
    Vec3 axis;
    double cosine;
    int rings = 16, sectors = 24;

    Vec3 direction(double ring, double sector) const {  // shares of all rings and of the turn
        const double c = 1 - (1 - cosine) * ring, s = std::sqrt(std::max(0.0, 1 - c * c)), angle = 2 * pi * sector;
        const Vec3 u = perpendicular(axis), v = cross(axis, u);
        return normalize(axis * c + u * (s * std::cos(angle)) + v * (s * std::sin(angle)));
    }
    // Negative: outside.
    int cell(Vec3 d) const {
        const Vec3 u = perpendicular(axis), v = cross(axis, u);
        const double c = dot(d, axis);
        if (c < cosine - 1e-12) return -1;
        const double angle = std::atan2(dot(d, v), dot(d, u)) / (2 * pi);
        const int ring = std::clamp(static_cast<int>((1 - c) / (1 - cosine) * rings), 0, rings - 1);
        return ring * sectors + std::clamp(static_cast<int>((angle < 0 ? angle + 1 : angle) * sectors), 0, sectors - 1);
    }
    double solid_angle() const { return 2 * pi * (1 - cosine) / (rings * sectors); }
    std::size_t count() const { return static_cast<std::size_t>(rings * sectors); }
};

// `sample` draws a direction, or nothing, from the generator; `pdf` is its density. `total`: what the density integrates to.
inline void expect_density(const DirectionCells& cells, const std::function<std::optional<Vec3>(accel::testing::Random&)>& sample,
                           const std::function<double(Vec3)>& pdf, double total = 1, std::uint64_t seed = 1) {
    constexpr int samples = 100000, side = 24;  // of each cell, side * side points are looked at
    std::vector<double> expected(cells.count()), found(cells.count());
    double integral = 0;
    for (int ring = 0; ring < cells.rings; ++ring) {
        for (int sector = 0; sector < cells.sectors; ++sector) {
            double sum = 0;
            for (int i = 0; i < side * side; ++i) {
                sum += pdf(cells.direction((ring + (i % side + 0.5) / side) / cells.rings, (sector + (i / side + 0.5) / side) / cells.sectors));
            }
            expected[static_cast<std::size_t>(ring * cells.sectors + sector)] = sum / (side * side) * cells.solid_angle();
            integral += sum / (side * side) * cells.solid_angle();
        }
    }
    EXPECT_NEAR(integral, total, 0.004 * total) << "the density over all directions";

    accel::testing::Random random(seed);
    for (int i = 0; i < samples; ++i) {
        const auto d = sample(random);
        if (!d) continue;
        const int cell = cells.cell(*d);
        ASSERT_GE(cell, 0) << "a direction outside of what the test looks at";
        ++found[static_cast<std::size_t>(cell)];
    }
    // The cells that expect least are merged until each expects enough.
    std::vector<std::size_t> order(cells.count());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
    constexpr double least = 30;
    double chi_square = 0, e = 0, f = 0;
    int freedom = -1;
    for (const std::size_t i : order) {
        e += expected[i] * samples, f += found[i];
        if (e < least) continue;
        chi_square += (f - e) * (f - e) / e;
        ++freedom;
        e = f = 0;
    }
    EXPECT_LT(f, least + 6 * std::sqrt(least)) << "directions where there should be none";
    ASSERT_GT(freedom, 8);
    EXPECT_LT(deviate_of(chi_square, freedom), 4) << "chi-square " << chi_square << " of " << freedom << " degrees of freedom";
}

}  // namespace crescente::render::testing
