#include "math/polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "math/bracketed_root.h"

namespace crescente::math {

BoundedValue evaluate(std::span<const double> c, double x) {
    if (c.empty()) return {};
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    double value = c.back(), mu = std::abs(value) / 2;
    for (std::size_t i = c.size() - 1; i-- > 0;) {
        value = value * x + c[i];
        mu = mu * std::abs(x) + std::abs(value);
    }
    return {value, unit * (2 * mu - std::abs(value))};
}

namespace {

// A strict sign: zero where rounding could have chosen it.
int sign_of(BoundedValue v) { return v.value > v.error ? 1 : v.value < -v.error ? -1 : 0; }

}  // namespace

int real_roots(std::span<const double> c, double low, double high, std::span<double> roots) {
    while (!c.empty() && c.back() == 0) c = c.first(c.size() - 1);
    if (c.size() < 2 || c.size() > max_polynomial_degree + 1 || !(low <= high)) return 0;
    if (!std::isfinite(low) || !std::isfinite(high)) return 0;
    if (!std::all_of(c.begin(), c.end(), [](double v) { return std::isfinite(v); })) return 0;
    const int degree = static_cast<int>(c.size()) - 1;

    // derivatives[k]: the k-th derivative's coefficients.
    std::array<std::array<double, max_polynomial_degree + 1>, max_polynomial_degree + 1> derivatives{};
    std::copy(c.begin(), c.end(), derivatives[0].begin());
    for (int k = 1; k < degree; ++k) {
        for (int i = 0; i <= degree - k; ++i) derivatives[k][i] = derivatives[k - 1][i + 1] * (i + 1);
    }

    std::array<double, max_polynomial_degree + 2> stops{}, found{};
    int count = 0;  // of roots of the derivative one order up
    for (int k = degree - 1; k >= 0; --k) {
        const std::span<const double> p{derivatives[k].data(), static_cast<std::size_t>(degree - k + 1)};
        const auto both = [&](double x) {
            ValueAndSlope v{p.back(), 0};
            for (std::size_t i = p.size() - 1; i-- > 0;) {
                v.slope = v.slope * x + v.value;
                v.value = v.value * x + p[i];
            }
            return v;
        };
        stops[0] = low;
        std::copy_n(found.begin(), count, stops.begin() + 1);
        stops[count + 1] = high;
        const int intervals = count + 1;
        count = 0;
        const auto add = [&](double x) {
            if (count < degree - k && (count == 0 || found[count - 1] < x)) found[count++] = x;
        };
        int before = sign_of(evaluate(p, stops[0]));
        if (before == 0) add(stops[0]);
        for (int i = 0; i < intervals; ++i) {
            const int after = sign_of(evaluate(p, stops[i + 1]));
            if (before * after < 0) add(bracketed_root(both, stops[i], stops[i + 1], before < 0, 0.5 * (stops[i] + stops[i + 1])));
            if (after == 0) add(stops[i + 1]);
            before = after;
        }
    }
    count = std::min(count, static_cast<int>(roots.size()));
    std::copy_n(found.begin(), count, roots.begin());
    return count;
}

}  // namespace crescente::math
