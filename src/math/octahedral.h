// Unit vectors in four bytes: the octahedral map (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit
// Vectors"), 16 bits a coordinate. The decoded vector is within 1e-4 radians of the encoded one.
#pragma once

#include <cstdint>

#include "math/vec_lanes.h"

namespace crescente::math {

// The map's square, both coordinates from -1 to 1, unfolded from a unit vector and back.
template <class T>
struct OctahedralPoint {
    T a, b;
};

template <class T>
inline OctahedralPoint<T> to_octahedral(const VecOf<T>& n) {
    const T scale = 1.0 / (absolute(n.x) + absolute(n.y) + absolute(n.z));
    const T a = n.x * scale, b = n.y * scale, one = T{} + 1.0;
    const auto below = n.z < 0.0;
    const T folded_a = (1.0 - absolute(b)) * (a >= 0.0 ? one : -one), folded_b = (1.0 - absolute(a)) * (b >= 0.0 ? one : -one);
    return {below ? folded_a : a, below ? folded_b : b};
}

template <class T>
inline VecOf<T> from_octahedral(const OctahedralPoint<T>& p) {
    const T one = T{} + 1.0, z = 1.0 - absolute(p.a) - absolute(p.b);
    const auto below = z < 0.0;
    const T unfolded_a = (1.0 - absolute(p.b)) * (p.a >= 0.0 ? one : -one), unfolded_b = (1.0 - absolute(p.a)) * (p.b >= 0.0 ? one : -one);
    return normalize(VecOf<T>{below ? unfolded_a : p.a, below ? unfolded_b : p.b, z});
}

inline constexpr double octahedral_scale = 32767;  // steps from 0 to 1

inline std::uint32_t pack_octahedral(double a, double b) {
    const auto steps = [](double v) {
        return static_cast<std::uint32_t>(static_cast<std::int32_t>(v * octahedral_scale + (v < 0 ? -0.5 : 0.5)) & 0xffff);
    };
    return steps(a) | steps(b) << 16;
}
inline double octahedral_a(std::uint32_t code) { return static_cast<std::int16_t>(code & 0xffff); }
inline double octahedral_b(std::uint32_t code) { return static_cast<std::int16_t>(code >> 16); }

inline std::uint32_t encode_direction(Vec3 n) {
    const OctahedralPoint<double> p = to_octahedral(vec_of(n));
    return pack_octahedral(p.a, p.b);
}
inline Vec3 decode_direction(std::uint32_t code) { return vec3(from_octahedral(OctahedralPoint<double>{octahedral_a(code) / octahedral_scale, octahedral_b(code) / octahedral_scale})); }

}  // namespace crescente::math
