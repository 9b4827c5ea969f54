#include "math/polynomial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "math/bracketed_root.h"
#include "math/exact.h"

namespace crescente::math {
namespace {

std::vector<double> roots_of(const std::vector<double>& c, double low, double high) {
    double roots[32];
    const int count = real_roots(c, low, high, roots);
    return {roots, roots + count};
}

// Coefficients, lowest first, of the product of (x - root).
std::vector<double> from_roots(const std::vector<double>& roots) {
    std::vector<long double> c{1};
    for (const double r : roots) {
        c.insert(c.begin(), 0);
        for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] -= r * c[i + 1];
    }
    return {c.begin(), c.end()};
}

TEST(Polynomial, known_roots) {
    EXPECT_EQ(roots_of({-2, 1}, -10, 10), (std::vector<double>{2}));
    EXPECT_EQ(roots_of({-4, 0, 1}, -10, 10), (std::vector<double>{-2, 2}));
    EXPECT_EQ(roots_of({-4, 0, 1}, 0, 10), (std::vector<double>{2}));
    EXPECT_EQ(roots_of({4, 0, 1}, -10, 10), (std::vector<double>{}));
    EXPECT_EQ(roots_of({1, -2, 1}, -10, 10), (std::vector<double>{1}));  // a touch
    EXPECT_EQ(roots_of({0, 0, 0, 1}, -1, 1), (std::vector<double>{0}));
    EXPECT_EQ(roots_of({-4, 0, 1, 0, 0}, -10, 10), (std::vector<double>{-2, 2}));  // leading zeros
    EXPECT_EQ(roots_of({-2, 1}, 2, 2), (std::vector<double>{2}));
}

TEST(Polynomial, hostile_input) {
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(roots_of({}, 0, 1).empty());
    EXPECT_TRUE(roots_of({0, 0, 0}, 0, 1).empty());
    EXPECT_TRUE(roots_of({5}, 0, 1).empty());
    EXPECT_TRUE(roots_of({inf, 1}, 0, 1).empty());
    EXPECT_TRUE(roots_of({1, 1}, -inf, 1).empty());
    EXPECT_TRUE(roots_of({1, 1}, 1, -1).empty());
    EXPECT_TRUE(roots_of({1, std::nan("")}, -1, 1).empty());
    EXPECT_TRUE(roots_of(std::vector<double>(40, 1.0), -2, 2).empty());  // too high a degree
    double one[1];
    EXPECT_EQ(real_roots(std::vector<double>{-4, 0, 1}, -10, 10, one), 1);
    EXPECT_EQ(one[0], -2);
}

TEST(Polynomial, random_roots_are_found) {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> number(-2, 2);
    for (int i = 0; i < 20000; ++i) {
        const int degree = 1 + i % 8;
        std::vector<double> expected(degree);
        for (double& r : expected) r = number(random);
        std::sort(expected.begin(), expected.end());
        bool apart = true;
        for (int k = 1; k < degree; ++k) apart &= expected[k] - expected[k - 1] > 0.02;
        if (!apart) continue;
        const auto found = roots_of(from_roots(expected), -2, 2);
        ASSERT_EQ(found.size(), expected.size());
        for (int k = 0; k < degree; ++k) ASSERT_NEAR(found[k], expected[k], 1e-4);
    }
}

// The error bound of evaluate holds against long double.
TEST(Polynomial, running_error_bound) {
    std::mt19937_64 random(2);
    std::uniform_real_distribution<double> number(-3, 3);
    for (int i = 0; i < 100000; ++i) {
        std::vector<double> c(2 + i % 12);
        for (double& v : c) v = number(random);
        const double x = number(random);
        long double exact = 0;
        for (std::size_t k = c.size(); k-- > 0;) exact = exact * x + c[k];
        const BoundedValue v = evaluate(c, x);
        ASSERT_LE(std::abs(exact - v.value), v.error + 1e-18L * std::abs(exact) * c.size());
        ASSERT_LT(v.error, 1e-8);
    }
}

TEST(BracketedRoot, comes_to_an_end_for_awkward_functions) {
    const auto step = [](double x) { return ValueAndSlope{x < 0.1 ? -1.0 : 1.0, 0.0}; };
    EXPECT_NEAR(bracketed_root(step, -1, 1, true, 0), 0.1, 1e-15);
    const auto cube_root = [](double x) { return ValueAndSlope{std::cbrt(x - 0.3), 1 / (3 * std::pow(std::cbrt(x - 0.3), 2))}; };
    EXPECT_NEAR(bracketed_root(cube_root, -1, 1, true, 1), 0.3, 1e-15);
    const auto flat = [](double x) { return ValueAndSlope{std::pow(x - 0.7, 9), 9 * std::pow(x - 0.7, 8)}; };
    EXPECT_NEAR(bracketed_root(flat, 0, 1, true, 0), 0.7, 1e-15);
    const auto liar = [](double x) { return ValueAndSlope{x - 0.25, std::nan("")}; };
    EXPECT_NEAR(bracketed_root(liar, 0, 1, true, 1), 0.25, 1e-15);
}

TEST(Exact, comparison_of_products_matches_wide_integers) {
    std::mt19937_64 random(3);
    const auto number = [&] { return static_cast<double>(static_cast<std::int64_t>(random() >> 11)); };  // 53 bits
    for (int i = 0; i < 200000; ++i) {
        const double a = number(), b = number();
        double c = a, d = b;
        if (i % 3 == 0) c = a + 1, d = b - 1;  // products that differ late
        if (i % 3 == 1) c = number(), d = number();
        const __int128 left = __int128(a) * __int128(b), right = __int128(c) * __int128(d);
        ASSERT_EQ(product_greater(a, b, c, d), left > right);
        ASSERT_EQ(product_greater(c, d, a, b), right > left);
        const double difference = difference_of_products(a, b, c, d);
        ASSERT_NEAR(difference, static_cast<double>(left - right), 4e-16 * std::abs(difference));
    }
}

}  // namespace
}  // namespace crescente::math
