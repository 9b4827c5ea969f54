#include "math/arctangent.h"

#include <gtest/gtest.h>

#include <random>

namespace crescente::math {
namespace {

TEST(Arctangent, AgreesWithTheStandardLibraryAndInLanes) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> between(-1, 1), power(-12, 12);
    for (int i = 0; i < 200000; ++i) {
        Lanes x, y;
        for (int k = 0; k < lane_count; ++k) {
            x[k] = between(random) * std::exp(power(random)), y[k] = between(random) * std::exp(power(random));
            if (i % 8 == k) (i % 16 < 8 ? x[k] : y[k]) = 0;
            if (i % 32 == k) x[k] = i % 64 < 32 ? y[k] : -y[k];
        }
        const Lanes angles = arctangent2(y, x);
        for (int k = 0; k < lane_count; ++k) {
            const double expected = x[k] == 0 && y[k] == 0 ? 0 : std::atan2(y[k], x[k]);
            ASSERT_NEAR(angles[k], expected, 3 * std::numeric_limits<double>::epsilon() * std::abs(expected)) << y[k] << ' ' << x[k];
            ASSERT_EQ(angles[k], arctangent2<double>(y[k], x[k]));
        }
    }
}

}  // namespace
}  // namespace crescente::math
