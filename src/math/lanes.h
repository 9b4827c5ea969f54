// Eight doubles computed on at once. The same formula written for T = double and T = Lanes gives the same bits: every operation here is
// rounded alone and correctly in both.
#pragma once

#include <cmath>
#include <limits>

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

namespace crescente::math {

inline constexpr int lane_count = 8;
using Lanes = double __attribute__((vector_size(lane_count * sizeof(double))));
using FloatLanes = float __attribute__((vector_size(lane_count * sizeof(float))));
using LaneMask = decltype(Lanes{} < Lanes{});  // all bits set where true

inline double absolute(double x) { return std::abs(x); }
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

inline Lanes rounded_up_to_integer(Lanes x) {
#if defined(__AVX512F__)
    return reinterpret_cast<Lanes>(_mm512_maskz_roundscale_pd(0xff, reinterpret_cast<__m512d>(x), _MM_FROUND_TO_POS_INF | _MM_FROUND_NO_EXC));
#else
    for (int i = 0; i < lane_count; ++i) x[i] = std::ceil(x[i]);
    return x;
#endif
}

// A function of one double, lane after lane.
inline double lane_by_lane(double x, auto&& f) { return f(x); }
inline Lanes lane_by_lane(Lanes x, auto&& f) {
    for (int i = 0; i < lane_count; ++i) x[i] = f(x[i]);
    return x;
}

inline Lanes absolute(Lanes x) { return reinterpret_cast<Lanes>(reinterpret_cast<LaneMask>(x) & 0x7fffffffffffffff); }

// Eight rows become eight columns.
inline void transpose(Lanes (&rows)[lane_count]) {
    Lanes pairs[lane_count], quads[lane_count];
    for (int i = 0; i < lane_count; i += 2) {
        pairs[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        pairs[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
    for (int i = 0; i < lane_count; i += 4) {
        for (int k = 0; k < 2; ++k) {
            quads[i + k] = __builtin_shufflevector(pairs[i + k], pairs[i + k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
            quads[i + k + 2] = __builtin_shufflevector(pairs[i + k], pairs[i + k + 2], 2, 3, 10, 11, 6, 7, 14, 15);
        }
    }
    for (int i = 0; i < 4; ++i) {
        rows[i] = __builtin_shufflevector(quads[i], quads[i + 4], 0, 1, 2, 3, 8, 9, 10, 11);
        rows[i + 4] = __builtin_shufflevector(quads[i], quads[i + 4], 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

// a where the lane's bit is set, else b.
inline Lanes blend(unsigned lanes, const Lanes& a, const Lanes& b) {
#if defined(__AVX512F__)
    return reinterpret_cast<Lanes>(_mm512_mask_blend_pd(static_cast<__mmask8>(lanes), reinterpret_cast<__m512d>(b), reinterpret_cast<__m512d>(a)));
#else
    Lanes result = b;
    for (int i = 0; i < lane_count; ++i) result[i] = lanes >> i & 1 ? a[i] : b[i];
    return result;
#endif
}

inline FloatLanes blend(unsigned lanes, const FloatLanes& a, const FloatLanes& b) {
#if defined(__AVX512F__) && defined(__AVX512VL__)
    return reinterpret_cast<FloatLanes>(_mm256_mask_blend_ps(static_cast<__mmask8>(lanes), reinterpret_cast<__m256>(b), reinterpret_cast<__m256>(a)));
#else
    FloatLanes result = b;
    for (int i = 0; i < lane_count; ++i) result[i] = lanes >> i & 1 ? a[i] : b[i];
    return result;
#endif
}

// Each rounded to the nearest, as static_cast does.
inline FloatLanes to_floats(const Lanes& x) { return __builtin_convertvector(x, FloatLanes); }
inline Lanes to_doubles(const FloatLanes& x) { return __builtin_convertvector(x, Lanes); }

// Of the lanes whose bit is set; infinite if there is none.
inline double least(const Lanes& x, unsigned lanes) {
    Lanes low = blend(lanes, x, Lanes{} + std::numeric_limits<double>::infinity());
    const auto fold = [&low](const Lanes& other) { low = other < low ? other : low; };
    fold(__builtin_shufflevector(low, low, 4, 5, 6, 7, 0, 1, 2, 3));
    fold(__builtin_shufflevector(low, low, 2, 3, 0, 1, 6, 7, 4, 5));
    fold(__builtin_shufflevector(low, low, 1, 0, 3, 2, 5, 4, 7, 6));
    return low[0];
}
inline double greatest(const Lanes& x, unsigned lanes) { return -least(-x, lanes); }

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

inline LaneMask mask_of(unsigned lanes) {
#if defined(__AVX512DQ__)
    return reinterpret_cast<LaneMask>(_mm512_movm_epi64(static_cast<__mmask8>(lanes)));
#else
    LaneMask mask{};
    for (int i = 0; i < lane_count; ++i) mask[i] = lanes >> i & 1 ? -1 : 0;
    return mask;
#endif
}

}  // namespace crescente::math
