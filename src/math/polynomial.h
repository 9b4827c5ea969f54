// Real polynomials in one variable.
#pragma once

#include <span>

namespace crescente::math {

inline constexpr int max_polynomial_degree = 16;

// A value, and a bound on its own rounding error.
struct BoundedValue {
    double value = 0, error = 0;
};

// c[0] + c[1] x + c[2] x^2 + ... with a running error bound (Higham 2002, "Accuracy and Stability of Numerical Algorithms", alg. 5.1).
BoundedValue evaluate(std::span<const double> c, double x);

// The real roots of c[0] + c[1] x + ... in the finite interval [low, high], ascending; writes at most roots.size() of them and
// returns how many. At most max_polynomial_degree + 1 coefficients; leading zeros are ignored; the zero polynomial and non-finite
// input give 0.
//
// Roots are isolated between the roots of the derivative, found in the same way, degree by degree: in each such interval the
// polynomial is monotonic, so that a change of sign encloses one root, and none is lost. A root that only touches zero is reported
// once, if the value there is zero within its rounding error; roots nearer to each other than that error may be reported as one.
int real_roots(std::span<const double> c, double low, double high, std::span<double> roots);

}  // namespace crescente::math
