#include "math/low_discrepancy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

using namespace crescente::math;

namespace {

// How many of 2^bits points fall into each cell of a grid of 2^across by 2^(bits - across) cells over two of the numbers.
std::vector<int> filled(std::uint64_t key, std::uint32_t first, int bits, int across, std::size_t a, std::size_t b) {
    std::vector<int> cells(std::size_t{1} << bits);
    for (std::uint32_t i = 0; i < 1u << bits; ++i) {
        const auto u = low_discrepancy(key, first + i);
        const auto x = static_cast<std::size_t>(u[a] * (1 << across)), y = static_cast<std::size_t>(u[b] * (1 << (bits - across)));
        ++cells[y << across | x];
    }
    return cells;
}

}  // namespace

TEST(LowDiscrepancy, EveryStripHasItsShare) {
    for (std::uint64_t key = 1; key < 20; ++key) {
        for (std::size_t d = 0; d < 4; ++d) {
            for (const int cell : filled(key, 0, 6, 6, d, (d + 1) % 4)) EXPECT_EQ(cell, 1);
        }
    }
}

// The first two dimensions are a (0, 2)-sequence: every elementary rectangle of 2^n points that follow a multiple of 2^n holds one.
TEST(LowDiscrepancy, FirstTwoFillElementaryRectangles) {
    for (std::uint64_t key = 1; key < 20; ++key) {
        for (int across = 0; across <= 6; ++across) {
            for (const std::uint32_t first : {0u, 64u, 640u}) {
                for (const int cell : filled(key, first, 6, across, 0, 1)) EXPECT_EQ(cell, 1);
            }
        }
    }
}

TEST(LowDiscrepancy, SequencesOfDifferentKeysAreNotAlike) {
    double sum = 0;
    constexpr int count = 4096;
    for (int i = 0; i < count; ++i) {
        const auto key = static_cast<std::uint64_t>(i);
        sum += (low_discrepancy(key, 3)[0] - 0.5) * (low_discrepancy(key + 1, 3)[0] - 0.5);
    }
    EXPECT_LT(std::abs(sum / count), 4 / (12 * std::sqrt(double(count))));  // four deviations of independent products
}

TEST(LowDiscrepancy, IntegratesBetterThanChance) {
    const auto f = [](const std::array<double, 4>& u) { return u[0] * u[1] * u[2] * u[3] * 16; };
    double squares = 0;
    constexpr int points = 256, runs = 200;
    for (std::uint64_t key = 0; key < runs; ++key) {
        double mean = 0;
        for (std::uint32_t i = 0; i < points; ++i) mean += f(low_discrepancy(key, i)) / points;
        squares += (mean - 1) * (mean - 1) / runs;
    }
    const double by_chance = (std::pow(4.0 / 3, 4) - 1) / points;  // variance of the mean of independent points
    EXPECT_LT(squares, by_chance / 10);
}
