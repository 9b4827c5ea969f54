// A set of bicubic patches, each given by 16 points in one of the usual bases.
#pragma once

#include <array>
#include <vector>

#include "geometry/patch_shape.h"

namespace crescente::geometry {

// How 16 points make a patch; rows run along u. hermite: the corners with their tangents and twists,
// [P00 P01 V00 V01, P10 P11 V10 V11, U00 U01 UV00 UV01, U10 U11 UV10 UV11], where V is the derivative along v (Foley, van Dam 1990, section 11.3).
enum class PatchBasis { bezier, b_spline, hermite, catmull_rom };

struct Bicubic : PatchShape<Bicubic> {
    PatchBasis basis = PatchBasis::bezier;
    std::vector<std::array<Vec3, 16>> points;     // of each patch
    std::vector<std::array<double, 16>> weights;  // of each patch: positive; empty: all 1. Not for hermite

    // Over u and v from 0 to 1 each.
    Expected<std::vector<BezierPatch>> patches() const;
    static const FieldTable<Bicubic>& fields();
};

}  // namespace crescente::geometry
