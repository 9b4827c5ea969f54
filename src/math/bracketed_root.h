// A root of a function between two points where its signs differ: Newton's method kept inside a shrinking bracket.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace crescente::math {

struct ValueAndSlope {
    double value = 0, slope = 0;
};

// f(x) -> ValueAndSlope, with signs that differ at low < high (both finite). Newton's step is taken while it stays inside the bracket
// and at least halves; otherwise the bracket is halved (Dekker's safeguard), so that any f comes to an end. The result is within a few
// units in the last place of max(|low|, |high|) of a change of sign, and inside [low, high].
template <class Function>
double bracketed_root(const Function& f, double low, double high, bool negative_at_low, double start) {
    const double resolution = 0.5 * std::numeric_limits<double>::epsilon() * std::max(std::abs(low), std::abs(high));
    double x = start > low && start < high ? start : low + 0.5 * (high - low);
    double last_step = high - low;
    // 64 halvings bring any bracket to the resolution of doubles near its larger end; a Newton step between two halvings halves too.
    for (int i = 0; i < 130; ++i) {
        const ValueAndSlope at = f(x);
        if (at.value == 0) return x;
        ((at.value < 0) == negative_at_low ? low : high) = x;
        const double newton = x - at.value / at.slope;
        const double step = std::abs(newton - x);
        if (step <= resolution) return std::clamp(newton, low, high);
        const bool good = newton > low && newton < high && 2 * step <= last_step;
        const double next = good ? newton : low + 0.5 * (high - low);
        if (high - low <= resolution || next <= low || next >= high) return x;
        last_step = std::abs(next - x);
        x = next;
    }
    return x;
}

}  // namespace crescente::math
