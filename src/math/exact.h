// Sums and comparisons of products without cancellation, by error-free transformations. std::fma is asked for by name: it gives the
// same bits on every machine, where a contraction of the compiler's choosing would not.
#pragma once

#include <cmath>

#include "math/vec_lanes.h"

namespace crescente::math {

// a b - c d to within 1.5 units in the last place (Kahan's method; Jeannerod, Louvet, Muller 2013, "Further analysis of Kahan's
// algorithm for the accurate computation of 2x2 determinants").
template <class T>
inline T difference_of_products(const T& a, const T& b, const T& c, const T& d) {
    const T cd = c * d;
    return fused_multiply_add(a, b, T(-cd)) + fused_multiply_add(T(-c), d, cd);
}

// Whether a b > c d, exactly (barring underflow): rounding is monotonic, so products that round differently are in that order; for
// products that round alike the rounding errors, which are doubles themselves, decide.
inline bool product_greater(double a, double b, double c, double d) {
    const double ab = a * b, cd = c * d;
    if (ab != cd) return ab > cd;
    return std::fma(a, b, -ab) > std::fma(c, d, -cd);
}

// The cross product with each component accurate to within 1.5 units in the last place.
template <class T>
inline VecOf<T> exact_cross(const VecOf<T>& a, const VecOf<T>& b) {
    return {difference_of_products(a.y, b.z, a.z, b.y), difference_of_products(a.z, b.x, a.x, b.z),
            difference_of_products(a.x, b.y, a.y, b.x)};
}
inline Vec3 exact_cross(Vec3 a, Vec3 b) { return vec3(exact_cross(vec_of(a), vec_of(b))); }

}  // namespace crescente::math
