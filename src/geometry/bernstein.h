// Bernstein polynomials and the cutting of rational Bézier patches (de Casteljau's algorithm; Farin 2002, "Curves and Surfaces for CAGD",
// sections 4, 5 and 15).
#pragma once

#include <vector>

#include "geometry/bezier_patch.h"

namespace crescente::geometry {

inline constexpr int max_patch_degree = 25;  // of either parameter

// B_i(s) of the degree, and their derivatives. T: double, or a vector of doubles.
template <class T>
inline void bernstein(int degree, const T& s, T* value, T* slope) {
    const T r = 1.0 - s;
    value[0] = T{} + 1.0;
    for (int d = 1; d < degree; ++d) {  // of degree - 1
        T carried = T{};
        for (int i = 0; i < d; ++i) {
            const T old = value[i];
            value[i] = carried + r * old;
            carried = s * old;
        }
        value[d] = carried;
    }
    T before = T{};
    for (int i = 0; i <= degree; ++i) {
        const T here = i < degree ? value[i] : T{};
        slope[i] = static_cast<double>(degree) * (before - here);
        value[i] = s * before + r * here;
        before = here;
    }
}

inline ControlPoint between(const ControlPoint& a, const ControlPoint& b, double s) {
    if (s == 0.5) return {(a.weighted + b.weighted) * 0.5, (a.weight + b.weight) * 0.5};
    return {a.weighted * (1 - s) + b.weighted * s, a.weight * (1 - s) + b.weight * s};
}

// Turns `count` points, `stride` apart, into those of the part before s; those of the part behind go to `behind`, in the same layout. s outside
// [0, 1] makes the first part longer than the whole.
inline void cut(ControlPoint* points, ControlPoint* behind, int count, int stride, double s) {
    for (int level = 0; level < count; ++level) {
        behind[(count - 1 - level) * stride] = points[(count - 1) * stride];
        for (int i = count - 1; i > level; --i) points[i * stride] = between(points[(i - 1) * stride], points[i * stride], s);
    }
}

enum class Way { u, v };

// Cuts the patch across the way at s (0 to 1 over its range); it keeps the part before s, the part behind is returned. Ranges are cut alike.
inline BezierPatch cut_off(BezierPatch& patch, Way way, double s) {
    BezierPatch behind = patch;
    const int rows = patch.degree_u + 1, columns = patch.degree_v + 1;
    if (way == Way::u) {
        for (int j = 0; j < columns; ++j) cut(&patch.points[j], &behind.points[j], rows, columns, s);
        patch.u1 = behind.u0 = patch.u0 + (patch.u1 - patch.u0) * s;
    } else {
        for (int i = 0; i < rows; ++i) cut(&patch.points[i * columns], &behind.points[i * columns], columns, 1, s);
        patch.v1 = behind.v0 = patch.v0 + (patch.v1 - patch.v0) * s;
    }
    return behind;
}

}  // namespace crescente::geometry
