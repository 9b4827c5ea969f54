// Eight doubles computed on at once. The same formula written for T = double and T = Lanes gives the same bits: every operation here is
// rounded alone and correctly in both.
#pragma once

#include <cmath>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace crescente::math {

inline constexpr int lane_count = 8;
using Lanes = double __attribute__((vector_size(lane_count * sizeof(double))));
using LaneMask = decltype(Lanes{} < Lanes{});  // all bits set where true

inline double square_root(double x) { return std::sqrt(x); }
inline double fused_multiply_add(double a, double b, double c) { return std::fma(a, b, c); }

inline Lanes square_root(Lanes x) {
#if defined(__AVX512F__)
    return reinterpret_cast<Lanes>(_mm512_maskz_sqrt_pd(0xff, reinterpret_cast<__m512d>(x)));
#else
    Lanes result{};
    for (int i = 0; i < lane_count; ++i) result[i] = std::sqrt(x[i]);
    return result;
#endif
}

inline Lanes fused_multiply_add(Lanes a, Lanes b, Lanes c) {
#if defined(__AVX512F__)
    return reinterpret_cast<Lanes>(_mm512_fmadd_pd(reinterpret_cast<__m512d>(a), reinterpret_cast<__m512d>(b), reinterpret_cast<__m512d>(c)));
#else
    Lanes result{};
    for (int i = 0; i < lane_count; ++i) result[i] = std::fma(a[i], b[i], c[i]);
    return result;
#endif
}

// The true lanes as bits, lane 0 lowest.
inline unsigned bits_of(LaneMask mask) {
#if defined(__AVX512DQ__)
    return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
#else
    unsigned bits = 0;
    for (int i = 0; i < lane_count; ++i) bits |= mask[i] ? 1u << i : 0u;
    return bits;
#endif
}

}  // namespace crescente::math
