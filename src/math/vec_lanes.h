// Vectors of three components of any kind: one vector (T = double), or eight side by side (T = Lanes). What is written for T gives the same
// bits for both, and for Vec3.
#pragma once

#include "math/lanes.h"
#include "math/vec.h"

namespace crescente::math {

template <class T>
struct VecOf {
    T x, y, z;
};
using Vec3Lanes = VecOf<Lanes>;

template <class T>
inline VecOf<T> operator+(const VecOf<T>& a, const VecOf<T>& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
template <class T>
inline VecOf<T> operator-(const VecOf<T>& a, const VecOf<T>& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
template <class T>
inline VecOf<T> operator-(const VecOf<T>& a) { return {-a.x, -a.y, -a.z}; }
template <class T, class S>
inline VecOf<T> operator*(const VecOf<T>& a, const S& s) { return {a.x * s, a.y * s, a.z * s}; }
template <class T>
inline VecOf<T> operator/(const VecOf<T>& a, const T& s) { return {a.x / s, a.y / s, a.z / s}; }
template <class T>
inline T dot(const VecOf<T>& a, const VecOf<T>& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T>
inline VecOf<T> cross(const VecOf<T>& a, const VecOf<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
inline T length(const VecOf<T>& a) { return square_root(dot(a, a)); }
template <class T>
inline VecOf<T> normalize(const VecOf<T>& a) { return a / length(a); }

template <class T>
inline T greater(const T& a, const T& b) { return a > b ? a : b; }
template <class T>
inline T lesser(const T& a, const T& b) { return a < b ? a : b; }
template <class T>
inline T largest_component(const VecOf<T>& a) { return greater(absolute(a.x), greater(absolute(a.y), absolute(a.z))); }

// a where true, else b.
inline Vec3Lanes select(const LaneMask& mask, const Vec3Lanes& a, const Vec3Lanes& b) {
    return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

// a where the lane's bit is set, else b.
inline Vec3Lanes blend(unsigned lanes, const Vec3Lanes& a, const Vec3Lanes& b) {
    return {blend(lanes, a.x, b.x), blend(lanes, a.y, b.y), blend(lanes, a.z, b.z)};
}

inline VecOf<double> vec_of(Vec3 v) { return {v.x, v.y, v.z}; }
inline Vec3 vec3(const VecOf<double>& v) { return {v.x, v.y, v.z}; }
inline Vec3Lanes broadcast(Vec3 v) { return {Lanes{} + v.x, Lanes{} + v.y, Lanes{} + v.z}; }
inline Vec3 lane(const Vec3Lanes& v, int i) { return {v.x[i], v.y[i], v.z[i]}; }
inline void set_lane(Vec3Lanes& v, int i, Vec3 value) { v.x[i] = value.x, v.y[i] = value.y, v.z[i] = value.z; }

}  // namespace crescente::math
