// Hashing of 64-bit numbers.
#pragma once

#include <cstdint>

namespace crescente::math {

// A bijection under which numbers that differ little end up far apart (the finalizer of SplitMix64; Steele, Lea and Flood 2014, "Fast
// Splittable Pseudorandom Number Generators", figure 16).
constexpr std::uint64_t mix_bits(std::uint64_t v) {
    v = (v ^ (v >> 30)) * 0xbf58476d1ce4e5b9;
    v = (v ^ (v >> 27)) * 0x94d049bb133111eb;
    return v ^ (v >> 31);
}

}  // namespace crescente::math
