// A transform made step by step.
#pragma once

#include "math/transform.h"

namespace crescente::math {

// From the identity (share 0) to `whole` (share 1): its translation and its stretch grow evenly, and its rotation turns evenly about one axis, the shorter way (Shoemake
// and Duff 1992, "Matrix Animation and Polar Decomposition"). The determinant of `whole` must be positive; so is then that of every step.
Affine gradual(const Affine& whole, double share);

}  // namespace crescente::math
