#include "math/transform.h"

namespace crescente::math {

Affine Affine::translation(Vec3 t) {
    Affine a;
    a.origin = t;
    return a;
}

Affine Affine::scaling(Vec3 s) { return {{s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}, {}}; }

Affine Affine::rotation(Vec3 axis, double angle) {
    const Vec3 n = normalize(axis);
    const double c = std::cos(angle), s = std::sin(angle);
    const auto turn = [&](Vec3 v) { return v * c + cross(n, v) * s + n * (dot(n, v) * (1.0 - c)); };  // Rodrigues
    return {turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1}), {}};
}

Affine inverse(const Affine& a) {
    const double d = 1.0 / a.determinant();
    const Vec3 rx = cross(a.y, a.z) * d, ry = cross(a.z, a.x) * d, rz = cross(a.x, a.y) * d;  // rows of the inverse
    Affine result{{rx.x, ry.x, rz.x}, {rx.y, ry.y, rz.y}, {rx.z, ry.z, rz.z}, {}};
    result.origin = -result.vector(a.origin);
    return result;
}

Bounds transform(const Affine& a, const Bounds& box) {
    if (box.empty()) return box;
    if (!box.bounded()) return Bounds::everything();
    Bounds result{a.origin, a.origin};
    const Vec3 columns[3] = {a.x, a.y, a.z};
    for (int axis = 0; axis < 3; ++axis) {
        const Vec3 p = columns[axis] * box.lower[axis], q = columns[axis] * box.upper[axis];
        result.lower += min(p, q);
        result.upper += max(p, q);
    }
    return result;
}

}  // namespace crescente::math
