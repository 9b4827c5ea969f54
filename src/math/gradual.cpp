#include "math/gradual.h"

namespace crescente::math {
namespace {

Affine linear_part(const Affine& a) { return {a.x, a.y, a.z, {}}; }
Affine transposed(const Affine& a) { return {{a.x.x, a.y.x, a.z.x}, {a.x.y, a.y.y, a.z.y}, {a.x.z, a.y.z, a.z.z}, {}}; }
Affine mix(const Affine& a, const Affine& b, double share) {
    const auto column = [share](Vec3 p, Vec3 q) { return p * (1 - share) + q * share; };
    return {column(a.x, b.x), column(a.y, b.y), column(a.z, b.z), column(a.origin, b.origin)};
}

// The rotation nearest to a transform (Higham 1986, "Computing the Polar Decomposition": Newton's iteration, which converges quadratically).
Affine nearest_rotation(const Affine& a) {
    Affine q = linear_part(a);
    for (int i = 0; i < 60; ++i) {
        const Affine next = mix(q, transposed(inverse(q)), 0.5);
        const double step = std::max({length(next.x - q.x), length(next.y - q.y), length(next.z - q.z)});
        q = next;
        if (step < 1e-15) break;
    }
    return q;
}

// The rotation about the same axis by a share of the angle, up to half a turn.
Affine share_of_rotation(const Affine& q, double share) {
    // The unit quaternion by its largest component (Shepperd 1978, "Quaternion from Rotation Matrix").
    const double trace = q.x.x + q.y.y + q.z.z;
    const double squares[4] = {1 + trace, 1 + 2 * q.x.x - trace, 1 + 2 * q.y.y - trace, 1 + 2 * q.z.z - trace};  // four times w, x, y, z squared
    const Vec3 odd{q.y.z - q.z.y, q.z.x - q.x.z, q.x.y - q.y.x};                                                  // four times w times (x, y, z)
    const double xy = q.y.x + q.x.y, yz = q.z.y + q.y.z, zx = q.x.z + q.z.x;
    const int largest = static_cast<int>(std::max_element(squares, squares + 4) - squares);
    double w = squares[0];
    Vec3 axis = odd;
    if (largest == 1) w = odd.x, axis = {squares[1], xy, zx};
    if (largest == 2) w = odd.y, axis = {xy, squares[2], yz};
    if (largest == 3) w = odd.z, axis = {zx, yz, squares[3]};
    if (w < 0) w = -w, axis = -axis;
    const double sine = length(axis);
    return sine > 0 ? Affine::rotation(axis, 2 * std::atan2(sine, w) * share) : Affine{};
}

}  // namespace

Affine gradual(const Affine& whole, double share) {
    Affine step;
    if (linear_part(whole) != Affine{}) {
        const Affine rotation = nearest_rotation(whole), stretch = transposed(rotation) * linear_part(whole);
        step = share_of_rotation(rotation, share) * mix(Affine{}, stretch, share);
    }
    step.origin = whole.origin * share;
    return step;
}

}  // namespace crescente::math
