// Unit vectors in four bytes: the octahedral map (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit
// Vectors"), 16 bits a coordinate. The decoded vector is within 1e-4 radians of the encoded one.
#pragma once

#include <cstdint>

#include "math/vec.h"

namespace crescente::math {

inline std::uint32_t encode_direction(Vec3 n) {
    const double s = 1.0 / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    double a = n.x * s, b = n.y * s;
    if (n.z < 0) {
        const double folded = (1 - std::abs(b)) * (a >= 0 ? 1 : -1);
        b = (1 - std::abs(a)) * (b >= 0 ? 1 : -1);
        a = folded;
    }
    const auto quantise = [](double v) { return static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(v * 32767)) & 0xffff); };
    return quantise(a) | quantise(b) << 16;
}

inline Vec3 decode_direction(std::uint32_t code) {
    const auto value = [](std::uint32_t bits) { return static_cast<std::int16_t>(bits & 0xffff) / 32767.0; };
    Vec3 n{value(code), value(code >> 16), 0};
    n.z = 1 - std::abs(n.x) - std::abs(n.y);
    if (n.z < 0) {
        const double unfolded = (1 - std::abs(n.y)) * (n.x >= 0 ? 1 : -1);
        n.y = (1 - std::abs(n.x)) * (n.y >= 0 ? 1 : -1);
        n.x = unfolded;
    }
    return normalize(n);
}

}  // namespace crescente::math
