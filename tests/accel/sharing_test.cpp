// A shape of many parts that is shown many times is stored once.
#include <gtest/gtest.h>

#include "accel/random_scenes.h"

namespace crescente::accel::testing {
namespace {

std::size_t bytes_of(const geometry::Shape& shape, int times) {
    std::vector<Instance> instances;
    for (int i = 0; i < times; ++i) instances.emplace_back(shape, Affine::translation({2.0 * i, 0, 0}), true);
    const auto embree = make_embree(instances);
    EXPECT_TRUE(embree);
    return embree ? (*embree)->bytes() : 0;
}

TEST(Sharing, PartsAreStoredOnce) {
    const geometry::Shape block = drilled_block(1e-7);
    ASSERT_GT(geometry::parts(block), 8u);
    EXPECT_EQ(bytes_of(block, 2), bytes_of(block, 200));
    EXPECT_EQ(bytes_of(sphere_mesh(8, 10), 2), bytes_of(sphere_mesh(8, 10), 200));
    // A shape of one part is as large as an instance: each has its own box.
    EXPECT_LT(bytes_of(geometry::Sphere{}, 2), bytes_of(geometry::Sphere{}, 200));
}

// An accelerator that takes over what one before knew of shapes finds what one from scratch finds, also where a shape was given another form.
TEST(Sharing, WhatIsTakenFromTheAcceleratorBeforeStillHolds) {
    geometry::Shape changing = sphere_mesh(8, 10), lasting = sphere_mesh(20, 20);
    const auto instances_at = [&](double x) {
        return std::vector<Instance>{{changing, Affine::translation({x, 0, 0}), true}, {lasting, Affine::translation({0, x, 0}), true},
                                     {lasting, Affine::translation({0, x, 3}), true}};
    };
    const std::vector<Instance> first = instances_at(2), second = instances_at(-2), third = instances_at(1);
    auto before = make_embree(first);
    ASSERT_TRUE(before);
    auto moved = make_embree(second, before->get());
    ASSERT_TRUE(moved);
    before->reset();
    const auto agrees = [](const Accelerator& embree, const std::vector<Instance>& instances) {
        Random random(3);
        std::vector<Ray> rays(3000);
        for (Ray& ray : rays) ray.origin = random.in_cube(4), ray.direction = random.direction();
        std::vector<Hit> hits(rays.size()), expected(rays.size());
        TestCounts counts;
        embree.nearest(rays, hits, Coherence::incoherent, counts);
        make_linear(instances)->nearest(rays, expected, Coherence::incoherent, counts);
        std::size_t found = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            EXPECT_TRUE(hits[i].t == expected[i].t && hits[i].instance == expected[i].instance && hits[i].primitive == expected[i].primitive);
            found += hits[i].found();
        }
        EXPECT_GT(found, 100u);
    };
    agrees(**moved, second);
    changing = sphere_mesh(5, 7);
    const geometry::Shape* reshaped[] = {&changing};
    auto other = make_embree(third, moved->get(), reshaped);
    ASSERT_TRUE(other);
    agrees(**other, third);
}

}  // namespace
}  // namespace crescente::accel::testing
