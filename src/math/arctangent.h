// The angle of a point in the plane, for one double or eight, to the same bits.
#pragma once

#include "math/lanes.h"
#include "math/vec.h"

namespace crescente::math {

// As std::atan2 for finite numbers, to about an ulp; 0 at the origin. The rational approximation of the Cephes library (Moshier 1989, "Methods and
// Programs for Mathematical Functions", atan.c): of ratios up to 0.66, to which others are turned by 45 or 90 degrees.
template <class T>
T arctangent2(const T& y, const T& x) {
    constexpr double rest_of_quarter = 3.061616997868382943065e-17, rest_of_half = 6.123233995736765886130e-17;  // of pi / 4 and pi / 2 in double
    const T none{}, across = absolute(x), up = absolute(y);
    const auto steep = up > across;
    const T small = steep ? across : up, large = steep ? up : across;
    const auto diagonal = small > 0.66 * large;
    const T below = diagonal ? small + large : large;
    const T ratio = (diagonal ? small - large : small) / (below > 0.0 ? below : none + 1.0);
    const T z = ratio * ratio;
    const T p = (((-8.750608600031904122785e-1 * z - 1.615753718733365076637e1) * z - 7.500855792314704667340e1) * z - 1.228866684490136173410e2) * z -
                6.485021904942025371773e1;
    const T q = ((((z + 2.485846490142306297962e1) * z + 1.650270098316988542046e2) * z + 4.328810604912902668951e2) * z + 4.853903996359136964868e2) * z +
                1.945506571482613964425e2;
    const T rise = ratio * (z * p / q) + ratio;
    const T eighth = diagonal ? (pi / 4) + (rise + rest_of_quarter) : rise;
    const T quarter = steep ? (pi / 2) - (eighth - rest_of_half) : eighth;
    const T half = x < 0.0 ? pi - (quarter - 2 * rest_of_half) : quarter;
    return y < 0.0 ? -half : half;
}

}  // namespace crescente::math
