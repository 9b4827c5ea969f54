// The certified intersection of a ray with a leaf, after the family of Toth 1985 ("On ray tracing parametric surfaces": uniqueness first, then
// Newton), Nishita, Sederberg, Kakimoto 1990 (the projected net and exclusion by its hull) and Srijuntongsiri, Vavasis 2006 (arXiv cs/0608090:
// subdivision of the preconditioned Bernstein form).
//
// The ray is two planes; the signed distances of the control points, times the weights, are the Bernstein coefficients of two functions f, g
// of (u, v) that both vanish where the ray meets the surface. On a box of parameters, scaled to [0, 1]^2:
//  1. f or g has coefficients of one sign only: no root.
//  2. (a, b) = the inverse of the mean Jacobian times (f, g), near to (u - u*, v - v*): exclusion as before, now by a tight parallelogram.
//  3. With a_u >= l11 > 0, |a_v| <= k12, |b_u| <= k21, b_v >= l22 > 0 from the coefficients of the derivatives, and l11 l22 > k12 k21, (a, b) is
//     one to one: between two points it changes by a matrix of means of these, whose determinant is positive. So there is one root at most, and
//     Newton's method, kept inside the box, finds it or ends at the border. There, at u = 0 say, a root in the box would need
//     a <= |b| k12 / l22: from 0 = a + a_u du + a_v dv, 0 = b + b_u du + b_v dv with du >= 0. If that does not hold there is none.
//  4. What is still undecided is halved, and halves are tried again.
// `delta` bounds the rounding of coefficients, so all this holds for the computed numbers too, and boxes overlap by more than rounding can move roots.
//
// The functions are written for T = double and for T = Lanes (one ray a lane) alike, which gives the same bits. For one ray and degrees that
// are known the coefficients themselves are the lanes where only their largest or least matter.
#pragma once

#include <cstdint>
#include <limits>
#include <type_traits>

#include "geometry/bernstein.h"
#include "geometry/ray_view.h"
#include "math/lanes.h"

namespace crescente::geometry {

template <class T>
inline T lesser(const T& a, const T& b) {
    return a < b ? a : b;
}
template <class T>
inline T greater(const T& a, const T& b) {
    return a > b ? a : b;
}
inline bool any(bool mask) { return mask; }
inline bool any(LaneMask mask) { return bits_of(mask) != 0; }

// The number of the kernel compiled for these degrees; 0: the general one.
std::uint8_t patch_kernel_of(int degree_u, int degree_v);

// Degrees known to the compiler, or not.
template <int P, int Q>
struct FixedDegrees {
    static constexpr int u = P, v = Q, count = (P + 1) * (Q + 1), room_u = P + 1, room_v = Q + 1;
    static constexpr int blocks = (count + lane_count - 1) / lane_count;  // of coefficients
    static constexpr int room = (blocks + 1) * lane_count;                // a block more may be read

    // The coefficients k of a block that have a neighbour in the next row, or in the next column, as bits.
    static constexpr unsigned followed(int block, bool along_u) {
        unsigned bits = 0;
        for (int i = 0; i < lane_count; ++i) {
            const int k = block * lane_count + i;
            if (k < count && (along_u ? k < P * (Q + 1) : k % (Q + 1) < Q)) bits |= 1u << i;
        }
        return bits;
    }
};
struct AnyDegrees {
    static constexpr int blocks = 0;
    static constexpr int room_u = max_patch_degree + 1, room_v = room_u, room = room_u * room_v;
    int u, v, count;
};

// Calls `call` with the degrees of a kernel. Those that have kernels of their own, by number; 0: any.
template <class Visit>
auto visit_degrees(std::uint8_t kernel, int degree_u, int degree_v, Visit&& call) {
    switch (kernel) {
        case 1: return call(FixedDegrees<1, 1>{});
        case 2: return call(FixedDegrees<1, 2>{});
        case 3: return call(FixedDegrees<1, 3>{});
        case 4: return call(FixedDegrees<2, 1>{});
        case 5: return call(FixedDegrees<2, 2>{});
        case 6: return call(FixedDegrees<2, 3>{});
        case 7: return call(FixedDegrees<3, 1>{});
        case 8: return call(FixedDegrees<3, 2>{});
        case 9: return call(FixedDegrees<3, 3>{});
        case 10: return call(FixedDegrees<1, 5>{});
        case 11: return call(FixedDegrees<5, 1>{});
        case 12: return call(FixedDegrees<3, 5>{});
        case 13: return call(FixedDegrees<5, 3>{});
        case 14: return call(FixedDegrees<5, 5>{});
    }
    return call(AnyDegrees{degree_u, degree_v, (degree_u + 1) * (degree_v + 1)});
}

// Control points about the leaf's center, by component.
struct LeafPoints {
    const double *x, *y, *z, *w;  // w: null for weights of 1
};

// A ray about the leaf's center.
template <class T>
struct PatchRay {
    Point3<T> origin, direction;  // direction: of unit length
    Point3<T> across, up;         // perpendicular to it and each other
    T speed;                      // length of the ray's own direction
    T delta;                      // bound on the rounding of coefficients

    // reach: of the leaf's coordinates about the center, or of what they are rounded from.
    PatchRay(const Point3<T>& from, const Point3<T>& along, math::Vec3 center, double reach) {
        const T size = greater(greater(absolute(along.x), absolute(along.y)), absolute(along.z));
        const T scale = 1.0 / size;  // so that lengths neither overflow nor vanish
        const T x = along.x * scale, y = along.y * scale, z = along.z * scale;
        const T length = square_root(x * x + y * y + z * z);
        const T inverse = 1.0 / length;
        direction = {x * inverse, y * inverse, z * inverse};
        speed = length * size;
        origin = {from.x - center.x, from.y - center.y, from.z - center.z};
        // Duff et al. 2017, "Building an Orthonormal Basis, Revisited".
        const T sign = direction.z < 0.0 ? T{} - 1.0 : T{} + 1.0;
        const T a = -1.0 / (sign + direction.z), b = direction.x * direction.y * a;
        across = {1.0 + sign * direction.x * direction.x * a, sign * b, -sign * direction.x};
        up = {b, sign + direction.y * direction.y * a, -direction.y};
        delta = (reach + greater(greater(absolute(origin.x), absolute(origin.y)), absolute(origin.z))) * (16 * std::numeric_limits<double>::epsilon());
    }

    PatchRay() = default;
    // One of eight.
    PatchRay<double> lane(int i) const {
        const auto of = [i](const Point3<T>& p) { return Point3<double>{p.x[i], p.y[i], p.z[i]}; };
        PatchRay<double> one;
        one.origin = of(origin), one.direction = of(direction), one.across = of(across), one.up = of(up), one.speed = speed[i], one.delta = delta[i];
        return one;
    }

    // Whether all are numbers, and such that no product overflows.
    auto usable() const {
        constexpr double most = 1e100;
        return (speed > 0.0) & (speed < HUGE_VAL) & (delta < most) & (absolute(origin.x) < most) & (absolute(origin.y) < most) & (absolute(origin.z) < most);
    }
};

inline Lanes load_lanes(const double* from) {
    Lanes lanes;
    __builtin_memcpy(&lanes, from, sizeof lanes);
    return lanes;
}

// Distances of the control points from the plane through the ray with this normal, times the weights.
template <class D, class T>
void project(D degrees, const LeafPoints& points, const Point3<T>& origin, const Point3<T>& normal, T* distances) {
    const auto &o = origin, &n = normal;
    const T to_plane = -fused_multiply_add(n.x, o.x, fused_multiply_add(n.y, o.y, n.z * o.z));
    if constexpr (std::is_same_v<T, double> && D::blocks > 0) {
        constexpr Lanes none{};
        const Lanes nx = none + n.x, ny = none + n.y, nz = none + n.z;
        for (int block = 0; block < D::blocks; ++block) {
            const int k = block * lane_count;
            const Lanes sum = fused_multiply_add(nx, load_lanes(points.x + k), fused_multiply_add(ny, load_lanes(points.y + k), nz * load_lanes(points.z + k)));
            const Lanes distance = sum + (points.w ? to_plane * load_lanes(points.w + k) : none + to_plane);
            __builtin_memcpy(distances + k, &distance, sizeof distance);
        }
        return;
    }
    const T none = T{};
    for (int k = 0; k < degrees.count; ++k) {
        const T sum = fused_multiply_add(n.x, none + points.x[k], fused_multiply_add(n.y, none + points.y[k], n.z * (none + points.z[k])));
        distances[k] = sum + (points.w ? to_plane * points.w[k] : to_plane);
    }
}

// The last block filled up, so that it can be looked at whole.
template <class D>
void pad(D degrees, double* values) {
    for (int k = degrees.count; k < D::blocks * lane_count; ++k) values[k] = values[0];
}
template <class D>
void pad(D, Lanes*) {}

// Whether all values are above `delta` or all are below -delta.
template <class D, class T>
decltype(T{} < T{}) one_sided(D degrees, const T* values, const T& delta) {
    if constexpr (std::is_same_v<T, double> && D::blocks > 0) {
        unsigned above = 0xff, below = 0xff;
        for (int block = 0; block < D::blocks; ++block) {
            const Lanes here = load_lanes(values + block * lane_count);
            above &= bits_of(here > delta), below &= bits_of(here < -delta);
        }
        return above == 0xff || below == 0xff;
    }
    T least = values[0], most = values[0];
    for (int k = 1; k < degrees.count; ++k) least = lesser(values[k], least), most = greater(values[k], most);
    return (least > delta) | (most < -delta);
}

template <class T>
struct ValueAndSlopes {
    T value, u, v;
};

// Of the polynomial with these coefficients, given the Bernstein polynomials.
template <class D, class T>
ValueAndSlopes<T> evaluate(D degrees, const T* coefficients, const T* bu, const T* su, const T* bv, const T* sv) {
    if (degrees.u < 1 || degrees.v < 1) __builtin_unreachable();
    const int columns = degrees.v + 1;
    T value[D::room_v], slope[D::room_v];
    for (int j = 0; j < columns; ++j) value[j] = coefficients[j] * bu[0], slope[j] = coefficients[j] * su[0];
    for (int i = 1; i <= degrees.u; ++i) {
        const T* row = coefficients + i * columns;
        for (int j = 0; j < columns; ++j) value[j] = fused_multiply_add(row[j], bu[i], value[j]), slope[j] = fused_multiply_add(row[j], su[i], slope[j]);
    }
    ValueAndSlopes<T> sum{value[0] * bv[0], slope[0] * bv[0], value[0] * sv[0]};
    for (int j = 1; j < columns; ++j) {
        sum.value = fused_multiply_add(value[j], bv[j], sum.value);
        sum.u = fused_multiply_add(slope[j], bv[j], sum.u);
        sum.v = fused_multiply_add(value[j], sv[j], sum.v);
    }
    return sum;
}

// How much (a, b) may bend: lower bounds of a_u and b_v, upper bounds of |a_v| and |b_u|.
template <class T>
struct Spread {
    T l11 = T{} + HUGE_VAL, k12{}, k21{}, l22 = T{} + HUGE_VAL;
};

template <class D, class T>
Spread<T> spread_of(D degrees, const T* a, const T* b) {
    const int columns = degrees.v + 1;
    Spread<T> k;
    if constexpr (std::is_same_v<T, double> && D::blocks > 0) {
        constexpr Lanes none{};
        Spread<Lanes> most;
        for (int block = 0; block < D::blocks; ++block) {
            const int first = block * lane_count;
            const Lanes a0 = load_lanes(a + first), b0 = load_lanes(b + first);
            if (const unsigned lanes = D::followed(block, true)) {
                const Lanes da = load_lanes(a + first + columns) - a0, db = load_lanes(b + first + columns) - b0;
                most.l11 = lesser(blend(lanes, da, none + HUGE_VAL), most.l11);
                most.k21 = greater(blend(lanes, absolute(db), none), most.k21);
            }
            const unsigned lanes = D::followed(block, false);
            const Lanes da = load_lanes(a + first + 1) - a0, db = load_lanes(b + first + 1) - b0;
            most.k12 = greater(blend(lanes, absolute(da), none), most.k12);
            most.l22 = lesser(blend(lanes, db, none + HUGE_VAL), most.l22);
        }
        k = {least(most.l11, 0xff), greatest(most.k12, 0xff), greatest(most.k21, 0xff), least(most.l22, 0xff)};
    } else {
        for (int i = 0; i < degrees.u; ++i) {
            for (int j = i * columns; j < (i + 1) * columns; ++j) {
                k.l11 = lesser(a[j + columns] - a[j], k.l11);
                k.k21 = greater(absolute(b[j + columns] - b[j]), k.k21);
            }
        }
        for (int i = 0; i <= degrees.u; ++i) {
            for (int j = i * columns; j < i * columns + degrees.v; ++j) {
                k.k12 = greater(absolute(a[j + 1] - a[j]), k.k12);
                k.l22 = lesser(b[j + 1] - b[j], k.l22);
            }
        }
    }
    k.l11 *= degrees.u, k.k21 *= degrees.u, k.k12 *= degrees.v, k.l22 *= degrees.v;
    return k;
}

// Of the control points about the middle.
template <class D, class T>
T middle_of(D degrees, const T* values) {
    const int i = degrees.u / 2, j = degrees.v / 2, columns = degrees.v + 1, down = (degrees.u & 1) * columns, right = degrees.v & 1;
    const T* from = values + i * columns + j;
    return ((from[0] + from[right]) + (from[down] + from[down + right])) * 0.25;
}

template <class T>
struct Attempt {
    using Mask = decltype(T{} < T{});
    Mask excluded, found;  // neither: undecided
    T u, v;                // of the root found, in the box's [0, 1]^2
    T turn;                // sign: of the Jacobian
};

// Steps 1 to 3 for the box with the coefficients f, g. Lanes outside `wanted` are not tried.
template <class D, class T>
Attempt<T> attempt(D degrees, const T* f, const T* g, const T& delta, typename Attempt<T>::Mask wanted) {
    constexpr double certain = 0.9, least_slope = 0.02;  // apart from 1 and 0 by more than what the overlap of boxes can add
    Attempt<T> result{};
    result.excluded = one_sided(degrees, f, delta) | one_sided(degrees, g, delta);
    if (!any(wanted & (!result.excluded))) return result;

    const int columns = degrees.v + 1, last = degrees.u * columns;
    T fu{}, fv{}, gu{}, gv{};
    for (int j = 0; j < columns; ++j) fu += f[last + j] - f[j], gu += g[last + j] - g[j];
    for (int i = 0; i <= last; i += columns) fv += f[i + degrees.v] - f[i], gv += g[i + degrees.v] - g[i];
    const double mean_u = 1.0 / columns, mean_v = 1.0 / (degrees.u + 1);
    fu *= mean_u, gu *= mean_u, fv *= mean_v, gv *= mean_v;
    result.turn = fu * gv - fv * gu;
    const T inverse = 1.0 / result.turn;
    const T m11 = gv * inverse, m12 = -fv * inverse, m21 = -gu * inverse, m22 = fu * inverse;

    T a[D::room], b[D::room];
    if constexpr (std::is_same_v<T, double> && D::blocks > 0) {
        for (int k = 0; k < D::blocks * lane_count; k += lane_count) {
            const Lanes here_f = load_lanes(f + k), here_g = load_lanes(g + k);
            const Lanes here_a = fused_multiply_add(Lanes{} + m11, here_f, m12 * here_g), here_b = fused_multiply_add(Lanes{} + m21, here_f, m22 * here_g);
            __builtin_memcpy(a + k, &here_a, sizeof here_a);
            __builtin_memcpy(b + k, &here_b, sizeof here_b);
        }
    } else {
        for (int k = 0; k < degrees.count; ++k) {
            a[k] = fused_multiply_add(m11, f[k], m12 * g[k]);
            b[k] = fused_multiply_add(m21, f[k], m22 * g[k]);
        }
    }
    const T blur_a = delta * (2.0 * (absolute(m11) + absolute(m12))), blur_b = delta * (2.0 * (absolute(m21) + absolute(m22)));
    result.excluded |= one_sided(degrees, a, blur_a) | one_sided(degrees, b, blur_b);
    if (!any(wanted & (!result.excluded))) return result;

    const auto [l11, k12, k21, l22] = spread_of(degrees, a, b);
    constexpr double least_overlap = 1e-11, precise = 1e-8, too_blurred = 0.01;
    auto active = wanted & (!result.excluded) & (l11 > least_slope) & (l22 > least_slope) & (k12 * k21 < certain * (l11 * l22)) & (blur_a < too_blurred) & (blur_b < too_blurred);
    const T low_u = -least_overlap - 2.0 * blur_a, high_u = 1.0 - low_u, low_v = -least_overlap - 2.0 * blur_b, high_v = 1.0 - low_v;
    // Newton's convergence is quadratic: after a step below `precise` the error is below rounding, if the step itself was not rounded much.
    const auto sharp = (blur_a < 1e-6) & (blur_b < 1e-6);
    const T lean_a = k12 / l22, lean_b = k21 / l11;
    T u = lesser(greater(0.5 - middle_of(degrees, a), low_u), high_u), v = lesser(greater(0.5 - middle_of(degrees, b), low_v), high_v);
    for (int step = 0; step < 10 && any(active); ++step) {
        T bu[D::room_u], su[D::room_u], bv[D::room_v], sv[D::room_v];
        bernstein(degrees.u, u, bu, su);
        bernstein(degrees.v, v, bv, sv);
        // On f and g themselves: a and b lose digits where the surface is seen at a flat angle.
        const ValueAndSlopes<T> at_f = evaluate(degrees, f, bu, su, bv, sv), at_g = evaluate(degrees, g, bu, su, bv, sv);
        const T at_a = fused_multiply_add(m11, at_f.value, m12 * at_g.value), at_b = fused_multiply_add(m21, at_f.value, m22 * at_g.value);
        const T reach_a = fused_multiply_add(absolute(at_b), lean_a, blur_a), reach_b = fused_multiply_add(absolute(at_a), lean_b, blur_b);
        const auto outside = active & (((u == low_u) & (at_a > reach_a)) | ((u == high_u) & (-at_a > reach_a)) |
                                       ((v == low_v) & (at_b > reach_b)) | ((v == high_v) & (-at_b > reach_b)));
        result.excluded |= outside;
        active &= !outside;

        const T scale = 1.0 / (at_f.u * at_g.v - at_f.v * at_g.u);
        const T free_u = u - (at_g.v * at_f.value - at_f.v * at_g.value) * scale, free_v = v - (at_f.u * at_g.value - at_g.u * at_f.value) * scale;
        const T next_u = lesser(greater(free_u, low_u), high_u), next_v = lesser(greater(free_v, low_v), high_v);
        const auto kept = ((next_u != free_u) | (next_v != free_v));
        const T stride = greater(absolute(next_u - u), absolute(next_v - v));
        const auto here = (absolute(at_f.value) <= delta) & (absolute(at_g.value) <= delta);
        const auto arrived = active & (here | (sharp & (!kept) & (stride <= precise)));
        const auto stepping = active & (sharp | (!here));
        u = stepping ? next_u : u, v = stepping ? next_v : v;
        result.found |= arrived;
        // At rest at the border, yet neither found nor excluded: undecided.
        active &= !(arrived | (kept & (stride == 0.0)));
    }
    result.u = u, result.v = v;
    return result;
}

// The ray's parameter at (u, v) of the leaf's [0, 1]^2.
template <class D, class T>
T parameter_at(D degrees, const LeafPoints& points, const PatchRay<T>& ray, const T& u, const T& v) {
    if (degrees.u < 1 || degrees.v < 1) __builtin_unreachable();
    T bu[D::room_u], su[D::room_u], bv[D::room_v], sv[D::room_v];
    bernstein(degrees.u, u, bu, su);
    bernstein(degrees.v, v, bv, sv);
    const int columns = degrees.v + 1;
    const auto sum_of = [&](const double* values) {
        T row[D::room_v];
        for (int j = 0; j < columns; ++j) row[j] = values[j] * bu[0];
        for (int i = 1; i <= degrees.u; ++i) {
            for (int j = 0; j < columns; ++j) row[j] = fused_multiply_add(T{} + values[i * columns + j], bu[i], row[j]);
        }
        T result = row[0] * bv[0];
        for (int j = 1; j < columns; ++j) result = fused_multiply_add(row[j], bv[j], result);
        return result;
    };
    Point3<T> sum{sum_of(points.x), sum_of(points.y), sum_of(points.z)};
    if (points.w) {
        const T inverse = 1.0 / sum_of(points.w);
        sum.x *= inverse, sum.y *= inverse, sum.z *= inverse;
    }
    const auto &o = ray.origin, &d = ray.direction;
    return ((sum.x - o.x) * d.x + (sum.y - o.y) * d.y + (sum.z - o.z) * d.z) / ray.speed;
}

}  // namespace crescente::geometry
