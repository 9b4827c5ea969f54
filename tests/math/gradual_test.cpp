#include "math/gradual.h"

#include <gtest/gtest.h>

#include <random>

namespace crescente::math {
namespace {

double difference(const Affine& a, const Affine& b) {
    return std::max({length(a.x - b.x), length(a.y - b.y), length(a.z - b.z), length(a.origin - b.origin)});
}

TEST(Gradual, BeginsAndEndsAtTheWhole) {
    std::mt19937_64 random{3};
    const auto number = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    for (int i = 0; i < 1000; ++i) {
        const Vec3 axis{number(-1, 1), number(-1, 1), number(-1, 1)}, other{number(-1, 1), number(-1, 1), 1};
        const Affine stretch = Affine::rotation(other, 1) * Affine::scaling({number(0.2, 3), number(0.2, 3), number(0.2, 3)}) * Affine::rotation(other, -1);
        const Affine whole = Affine::translation({number(-9, 9), number(-9, 9), number(-9, 9)}) * Affine::rotation(axis, number(-3, 3)) * stretch;
        EXPECT_LT(difference(gradual(whole, 1), whole), 1e-12);
        EXPECT_LT(difference(gradual(whole, 0), Affine{}), 1e-15);
        for (const double share : {0.2, 0.5, 0.9}) EXPECT_GT(gradual(whole, share).determinant(), 0);
    }
}

TEST(Gradual, TurnsEvenlyAboutOneAxis) {
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, -2, 0.5}}) {
        for (const double angle : {-3.1, -1.0, 1e-9, 0.5, 2.0, 3.0}) {
            EXPECT_LT(difference(gradual(Affine::rotation(axis, angle), 0.25), Affine::rotation(axis, angle / 4)), 1e-12) << angle;
        }
    }
    // Half a turn, either way.
    const Affine quarter = gradual(Affine::rotation({0, 1, 0}, pi), 0.5);
    EXPECT_NEAR(std::abs(quarter.x.z), 1, 1e-12);
    EXPECT_NEAR(quarter.y.y, 1, 1e-12);
}

TEST(Gradual, MovesAndStretchesEvenly) {
    EXPECT_EQ(gradual(Affine::translation({2, -4, 8}), 0.25), Affine::translation({0.5, -1, 2}));
    EXPECT_LT(difference(gradual(Affine::scaling({3, 0.5, 1}), 0.5), Affine::scaling({2, 0.75, 1})), 1e-15);
}

}  // namespace
}  // namespace crescente::math
