// Powers of what lies between 0 and 1, as cosines do, for one double or eight, to the same bits.
#pragma once

#include <bit>
#include <cstdint>
#include <utility>

#include "math/lanes.h"

namespace crescente::math {

// Mantissa (1 to 2) and exponent of a positive normal number.
inline std::pair<double, double> binary_parts(double x) {
    const auto bits = std::bit_cast<std::int64_t>(x);
    return {std::bit_cast<double>((bits & 0xfffffffffffff) | 0x3ff0000000000000), static_cast<double>((bits >> 52) - 1023)};
}
inline std::pair<Lanes, Lanes> binary_parts(const Lanes& x) {
    const auto bits = reinterpret_cast<LaneMask>(x);
    return {reinterpret_cast<Lanes>((bits & 0xfffffffffffff) | 0x3ff0000000000000), __builtin_convertvector((bits >> 52) - 1023, Lanes)};
}

// 2 to the power of a whole number from -1022 to 1023.
inline double power_of_two(double whole) { return std::bit_cast<double>((static_cast<std::int64_t>(whole) + 1023) << 52); }
inline Lanes power_of_two(const Lanes& whole) { return reinterpret_cast<Lanes>((__builtin_convertvector(whole, LaneMask) + 1023) << 52); }

// base^exponent for 0 <= base <= 1 (and a little over, as rounding makes it) and exponent >= 0, to 1e-13 * (1 + exponent) of itself; 0^0 = 1; 0 below
// 1e-300. The logarithm by the series of its inverse hyperbolic tangent, the exponential by its own series (Abramowitz and Stegun 1964, 4.1.27 and 4.2.1).
template <class T>
T power(const T& base, const T& exponent) {
    constexpr double log2_e = 1.4426950408889634, ln_2 = 0.6931471805599453, sqrt_2 = 1.4142135623730951, rounds = 0x1.8p52;
    auto [m, e] = binary_parts(base);
    const auto high = m > sqrt_2;
    m = high ? 0.5 * m : m;
    e = high ? e + 1.0 : e;
    const T s = (m - 1.0) / (m + 1.0), z = s * s;
    const T log2_m = (2 * log2_e) * s * (1.0 + z * (1.0 / 3 + z * (1.0 / 5 + z * (1.0 / 7 + z * (1.0 / 9 + z * (1.0 / 11 + z * (1.0 / 13 + z * (1.0 / 15))))))));
    const T y = exponent * (e + log2_m), lowest = T{} - 1000.0;
    const T clear = y > lowest ? y : lowest;
    const T whole = (clear + rounds) - rounds, x = ln_2 * (clear - whole);
    const T series = 1.0 + x * (1.0 + x * (1.0 / 2 + x * (1.0 / 6 + x * (1.0 / 24 + x * (1.0 / 120 + x * (1.0 / 720 + x * (1.0 / 5040 + x * (1.0 / 40320 +
                     x * (1.0 / 362880 + x * (1.0 / 3628800 + x * (1.0 / 39916800)))))))))));
    const T result = y > lowest ? series * power_of_two(whole) : T{};
    return base > 0.0 ? result : exponent > 0.0 ? T{} : T{} + 1.0;
}

}  // namespace crescente::math
