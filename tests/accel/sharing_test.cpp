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

}  // namespace
}  // namespace crescente::accel::testing
