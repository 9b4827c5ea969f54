#include "math/transform.h"

#include <gtest/gtest.h>

#include <random>

namespace crescente::math {
namespace {

struct Numbers {
    std::mt19937_64 random{7};
    double operator()(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); }
    Vec3 vector(double a, double b) {
        const double x = (*this)(a, b), y = (*this)(a, b), z = (*this)(a, b);
        return {x, y, z};
    }
    Affine affine() {
        const Vec3 axis = vector(0.1, 1), size = vector(0.2, 4), place = vector(-50, 50);
        return Affine::translation(place) * Affine::rotation(axis, (*this)(-4, 4)) * Affine::scaling(size) *
               Affine::rotation({axis.y, -axis.x, 1}, (*this)(-4, 4));
    }
};

TEST(Transform, inverse_takes_points_back) {
    Numbers number;
    for (int i = 0; i < 10000; ++i) {
        const Affine a = number.affine(), b = inverse(a);
        const Vec3 p = number.vector(-10, 10);
        ASSERT_LE(length(b.point(a.point(p)) - p), 1e-11);
        ASSERT_LE(length((b * a).point(p) - p), 1e-11);
        ASSERT_NEAR(a.determinant() * b.determinant(), 1, 1e-12);
    }
    EXPECT_FALSE(is_finite(inverse(Affine::scaling({1, 0, 1})).y));
}

TEST(Transform, composition_applies_the_right_one_first) {
    const Affine move = Affine::translation({1, 0, 0}), grow = Affine::scaling({2, 2, 2});
    EXPECT_EQ((grow * move).point({0, 0, 0}), (Vec3{2, 0, 0}));
    EXPECT_EQ((move * grow).point({0, 0, 0}), (Vec3{1, 0, 0}));
    const Vec3 turned = Affine::rotation({0, 1, 0}, pi / 2).point({1, 0, 0});  // right-handed: x to -z
    EXPECT_NEAR(turned.z, -1, 1e-15);
    EXPECT_NEAR(turned.x, 0, 1e-15);
}

TEST(Transform, normals_stay_perpendicular) {
    Numbers number;
    for (int i = 0; i < 10000; ++i) {
        const Affine a = number.affine();
        const Vec3 n = normalize(number.vector(-1, 1)), t = perpendicular(n);
        const Vec3 carried = inverse(a).transposed(n);
        ASSERT_NEAR(dot(normalize(carried), normalize(a.vector(t))), 0, 1e-13);
        ASSERT_GT(dot(carried, a.vector(n)), 0);
    }
}

TEST(Transform, boxes_hold_the_corners_and_no_more) {
    Numbers number;
    for (int i = 0; i < 10000; ++i) {
        const Affine a = number.affine();
        Bounds box;
        box.include(number.vector(-5, 5));
        box.include(number.vector(-5, 5));
        Bounds corners;
        for (int k = 0; k < 8; ++k) corners.include(a.point(box.corner(k)));
        const Bounds carried = transform(a, box);
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_NEAR(carried.lower[axis], corners.lower[axis], 1e-12);
            ASSERT_NEAR(carried.upper[axis], corners.upper[axis], 1e-12);
        }
    }
    EXPECT_TRUE(transform(Affine{}, Bounds{}).empty());
    EXPECT_FALSE(transform(Affine::scaling({0, 1, 1}), Bounds::everything()).bounded());
}

TEST(Bounds, empty_bounded_everything) {
    Bounds box;
    EXPECT_TRUE(box.empty());
    EXPECT_FALSE(box.bounded());
    box.include(Vec3{1, 2, 3});
    EXPECT_FALSE(box.empty());
    EXPECT_TRUE(box.bounded());
    EXPECT_EQ(box.diagonal(), (Vec3{0, 0, 0}));
    box.include(Bounds{{-1, 0, 0}, {0, 5, 4}});
    EXPECT_EQ(box.lower, (Vec3{-1, 0, 0}));
    EXPECT_EQ(box.upper, (Vec3{1, 5, 4}));
    EXPECT_EQ(box.center(), (Vec3{0, 2.5, 2}));
    EXPECT_EQ(box.largest_coordinate(), 5);
    box.include(Bounds{});
    EXPECT_EQ(box.upper, (Vec3{1, 5, 4}));
    EXPECT_FALSE(Bounds::everything().bounded());
    EXPECT_FALSE(Bounds::everything().empty());
}

TEST(Vec3, perpendicular_is_a_unit_vector_at_right_angles) {
    Numbers number;
    for (int i = 0; i < 10000; ++i) {
        const Vec3 n = normalize(number.vector(-1, 1));
        ASSERT_NEAR(dot(n, perpendicular(n)), 0, 1e-15);
        ASSERT_NEAR(length(perpendicular(n)), 1, 1e-15);
    }
    for (const Vec3 n : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{0, 1, 0}}) ASSERT_NEAR(dot(n, perpendicular(n)), 0, 1e-16);
}

}  // namespace
}  // namespace crescente::math
