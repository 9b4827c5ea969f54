// What the options of kay-kajiya save, by counters.
#include <gtest/gtest.h>

#include "accel/comparison.h"

namespace crescente::accel::testing {
namespace {

class KayKajiyaCounts : public ::testing::Test {
protected:
    TestCounts counts_of(const Accelerator& accelerator) const {
        std::vector<Hit> hits(rays.size());
        TestCounts counts;
        accelerator.nearest(rays, hits, Coherence::incoherent, counts);
        return counts;
    }
    TestCounts counts_with(KayKajiyaOptions options) const { return counts_of(*make_kay_kajiya(scene.instances, options)); }

    TestScene scene = make_scene({"one_mesh", 1, 1, {}});
    std::vector<Ray> rays = [this] {
        Random random(2);
        std::vector<Ray> result;
        for (int i = 0; i < 5000; ++i) {
            const Vec3 origin = random.in_cube(3);
            result.push_back(ray_through(origin, normalize(random.in_cube(0.5) - origin)));
        }
        return result;
    }();
};

TEST_F(KayKajiyaCounts, LinearTriesEveryPart) {
    const TestCounts counts = counts_of(*make_linear(scene.instances));
    EXPECT_EQ(counts.box_tests, 0u);
    EXPECT_EQ(counts.shape_tests, rays.size() * geometry::parts(scene.shapes[0]));
}

TEST_F(KayKajiyaCounts, TheHierarchyTriesAFewParts) {
    const TestCounts counts = counts_with({true, true});
    EXPECT_LT(counts.shape_tests, rays.size() * 10);
    EXPECT_LT(counts.box_tests, rays.size() * 50);
}

TEST_F(KayKajiyaCounts, OctantRejectionSavesSlabTests) {
    EXPECT_LT(counts_with({true, false}).box_tests, counts_with({false, false}).box_tests);
    EXPECT_LT(counts_with({true, true}).box_tests, counts_with({false, true}).box_tests);
}

TEST_F(KayKajiyaCounts, TheQueueSavesPartTests) {
    EXPECT_LT(counts_with({true, true}).shape_tests, counts_with({true, false}).shape_tests);
    EXPECT_LT(counts_with({false, true}).shape_tests, counts_with({false, false}).shape_tests);
}

TEST_F(KayKajiyaCounts, BytesGrowWithTheParts) {
    const std::size_t parts = geometry::parts(scene.shapes[0]);
    const auto accelerator = make_kay_kajiya(scene.instances, {});
    EXPECT_GE(accelerator->bytes(), parts * 8);
    EXPECT_LE(accelerator->bytes(), 1000 + parts * (8 + 2 * 56));
}

}  // namespace
}  // namespace crescente::accel::testing
