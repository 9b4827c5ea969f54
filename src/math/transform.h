// Affine transforms and their inverses.
#pragma once

#include "math/bounds.h"
#include "math/vec.h"

namespace crescente::math {

// p -> x p.x + y p.y + z p.z + origin: the columns of a 3x4 matrix.
struct Affine {
    Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1}, origin{0, 0, 0};

    constexpr Vec3 point(Vec3 p) const { return x * p.x + y * p.y + z * p.z + origin; }
    constexpr Vec3 vector(Vec3 v) const { return x * v.x + y * v.y + z * v.z; }
    // The product of the transposed linear part with n. With the inverse transform this carries normals (unnormalised).
    constexpr Vec3 transposed(Vec3 n) const { return {dot(x, n), dot(y, n), dot(z, n)}; }
    constexpr double determinant() const { return dot(cross(x, y), z); }
    constexpr bool operator==(const Affine&) const = default;

    static Affine translation(Vec3 t);
    static Affine scaling(Vec3 s);
    // Right-handed rotation by angle (radians) about axis (any length but zero).
    static Affine rotation(Vec3 axis, double angle);
};

// a * b applies b first.
constexpr Affine operator*(const Affine& a, const Affine& b) {
    return {a.vector(b.x), a.vector(b.y), a.vector(b.z), a.point(b.origin)};
}

// The inverse; entries are not finite if the linear part is singular.
Affine inverse(const Affine& a);

// The box of the transformed box (Arvo 1990, "Transforming axis-aligned bounding boxes"). Unbounded stays unbounded.
Bounds transform(const Affine& a, const Bounds& box);

}  // namespace crescente::math
