#include "math/power.h"

#include <gtest/gtest.h>

#include <random>

namespace crescente::math {
namespace {

TEST(Power, AgreesWithTheStandardLibraryAndInLanes) {
    std::mt19937_64 random(3);
    std::uniform_real_distribution<double> share(0, 1), size(-3, 5);
    for (int i = 0; i < 100000; ++i) {
        Lanes base, exponent;
        for (int k = 0; k < lane_count; ++k) {
            base[k] = i % 3 ? share(random) : 1 - 1e-3 * share(random);
            exponent[k] = i % 5 ? std::exp2(size(random) * 3) : k;
        }
        const Lanes powers = power(base, exponent);
        for (int k = 0; k < lane_count; ++k) {
            const double expected = std::pow(base[k], exponent[k]);
            ASSERT_EQ(powers[k], power<double>(base[k], exponent[k])) << base[k] << '^' << exponent[k];
            if (expected < 1e-300) ASSERT_LT(powers[k], 1e-299) << base[k] << '^' << exponent[k];
            else ASSERT_NEAR(powers[k], expected, 1e-13 * (1 + exponent[k]) * expected) << base[k] << '^' << exponent[k];
        }
    }
}

TEST(Power, OfTheEnds) {
    EXPECT_EQ(power<double>(0, 3), 0);
    EXPECT_EQ(power<double>(0, 0), 1);
    EXPECT_EQ(power<double>(1, 1e6), 1);
    EXPECT_EQ(power<double>(0.25, 0), 1);
    EXPECT_EQ(power<double>(0.5, 1e6), 0);
    EXPECT_NEAR(power<double>(std::nextafter(1.0, 2.0), 100), 1, 1e-12);
}

}  // namespace
}  // namespace crescente::math
