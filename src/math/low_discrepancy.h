// Numbers in [0, 1) that fill a cube evenly, computed from their place in the sequence alone: Sobol's sequence (1967), scrambled after Owen (1995) by hashing
// (Burley 2020, "Practical Hash-based Owen Scrambling"; the permutation with the constants of Vegdahl 2021). No state: whoever asks for the same place gets the
// same numbers.
#pragma once

#include <array>
#include <cstdint>

#include "math/mix_bits.h"

namespace crescente::math {

namespace sobol {

constexpr std::uint32_t reversed(std::uint32_t x) {
    x = (x & 0x55555555) << 1 | (x >> 1 & 0x55555555);
    x = (x & 0x33333333) << 2 | (x >> 2 & 0x33333333);
    x = (x & 0x0f0f0f0f) << 4 | (x >> 4 & 0x0f0f0f0f);
    return __builtin_bswap32(x);
}

// Direction numbers of a dimension, from its primitive polynomial over two elements (degree, inner coefficients as bits) and its first odd numbers. The values
// of the first dimensions are those of Joe and Kuo 2008, "Constructing Sobol Sequences with Better Two-Dimensional Projections".
constexpr std::array<std::uint32_t, 32> directions(int degree, std::uint32_t coefficients, std::array<std::uint32_t, 3> first) {
    std::array<std::uint32_t, 32> v{};
    for (int i = 0; i < 32; ++i) {
        if (i < degree) {
            v[i] = first[i] << (31 - i);
            continue;
        }
        v[i] = v[i - degree] ^ v[i - degree] >> degree;
        for (int k = 1; k < degree; ++k) {
            if (coefficients >> (degree - 1 - k) & 1) v[i] ^= v[i - k];
        }
    }
    return v;
}

// The points of a dimension, by the lower and by the upper byte of a place below 2^16: their exclusive or is the point.
struct Points {
    std::array<std::uint32_t, 256> lower{}, upper{};
    constexpr std::uint32_t at(std::uint32_t place) const { return lower[place & 255] ^ upper[place >> 8]; }
};
constexpr Points points_of(const std::array<std::uint32_t, 32>& directions) {
    Points points;
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        for (std::uint32_t bit = 0; bit < 8; ++bit) {
            if (!(byte >> bit & 1)) continue;
            points.lower[byte] ^= directions[bit], points.upper[byte] ^= directions[bit + 8];
        }
    }
    return points;
}
inline constexpr Points second = points_of(directions(1, 0, {1, 0, 0})), third = points_of(directions(2, 1, {1, 3, 0})),
                        fourth = points_of(directions(3, 1, {1, 3, 1}));

// A permutation of 32-bit numbers in which each bit depends on the bits above it alone.
constexpr std::uint32_t scrambled(std::uint32_t x, std::uint32_t seed) {
    x = reversed(x);
    x ^= x * 0x3d20adea;
    x += seed;
    x *= seed >> 16 | 1;
    x ^= x * 0x05526c56;
    x ^= x * 0x53a22864;
    return reversed(x);
}

}  // namespace sobol

// Four numbers of place `index`, below 2^16, in the sequence that `key` names. Any 2^n places that follow a multiple of 2^n are spread evenly, in each number and in each
// two of them. Sequences of different keys have nothing to do with each other.
constexpr std::array<double, 4> low_discrepancy(std::uint64_t key, std::uint32_t index) {
    const std::uint64_t seeds = mix_bits(key), more = mix_bits(seeds);
    const std::uint32_t i = sobol::scrambled(index, static_cast<std::uint32_t>(seeds)) & 0xffff;  // the order is shuffled as well
    const std::uint32_t scrambles[4] = {static_cast<std::uint32_t>(seeds >> 32), static_cast<std::uint32_t>(more), static_cast<std::uint32_t>(more >> 32),
                                        static_cast<std::uint32_t>(more >> 16)};
    const std::uint32_t points[4] = {sobol::reversed(i), sobol::second.at(i), sobol::third.at(i), sobol::fourth.at(i)};
    std::array<double, 4> numbers{};
    for (int d = 0; d < 4; ++d) numbers[static_cast<std::size_t>(d)] = sobol::scrambled(points[d], scrambles[d]) * 0x1p-32;
    return numbers;
}

}  // namespace crescente::math
