// The answer for a ray depends on the ray and the scene alone: not on its companions, on threads, nor on which build of the structure is asked.
#include <thread>

#include <gtest/gtest.h>

#include "accel/comparison.h"

namespace crescente::accel::testing {
namespace {

std::size_t differences(std::span<const Hit> a, std::span<const Hit> b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += !same(a[i], b[i]);
    return count;
}

std::size_t differences(std::span<const Shadow> a, std::span<const Shadow> b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i) count += !same(a[i], b[i]);
    return count;
}

class Batches : public ::testing::TestWithParam<std::string> {
protected:
    Batches() : scene(make_scene({GetParam(), 7, 1, {}})), rays(random_rays(scene, 6000, 8, *make_linear(scene.instances))) {}

    TestScene scene;
    std::vector<Ray> rays;
};

// Rays in packets of every size and both coherences, and in shuffled company.
TEST_P(Batches, AnyCompanionsAnyCoherence) {
    for (const auto& [name, make] : factories()) {
        const auto accelerator = make(scene.instances);
        const std::vector<Hit> expected = nearest(*accelerator, rays);
        const std::vector<Shadow> expected_shadows = shadow(*accelerator, rays);
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            for (std::size_t size = 1; size <= 40; ++size) {
                std::vector<Hit> hits;
                std::vector<Shadow> shadows;
                for (std::size_t i = 0; i < rays.size(); i += size) {
                    const auto batch = std::span(rays).subspan(i, std::min(size, rays.size() - i));
                    const auto own = nearest(*accelerator, batch, coherence);
                    const auto own_shadows = shadow(*accelerator, batch, coherence);
                    hits.insert(hits.end(), own.begin(), own.end());
                    shadows.insert(shadows.end(), own_shadows.begin(), own_shadows.end());
                }
                ASSERT_EQ(differences(expected, hits), 0u) << name << ", batches of " << size;
                ASSERT_EQ(differences(expected_shadows, shadows), 0u) << name << ", batches of " << size;
            }
        }
        Random random(9);
        std::vector<std::size_t> order(rays.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
        std::vector<Ray> shuffled;
        for (const std::size_t i : order) shuffled.push_back(rays[i]);
        const std::vector<Hit> shuffled_hits = nearest(*accelerator, shuffled, Coherence::coherent);
        std::vector<Hit> hits(rays.size());
        for (std::size_t i = 0; i < order.size(); ++i) hits[order[i]] = shuffled_hits[i];
        EXPECT_EQ(differences(expected, hits), 0u) << name << ", shuffled";
    }
}

TEST_P(Batches, SecondBuild) {
    const auto first = embree(scene.instances);
    const std::vector<Hit> expected = nearest(*first, rays);
    for (int build = 1; build <= 3; ++build) {
        const auto second = embree(scene.instances);
        ASSERT_NE(second, nullptr);
        EXPECT_EQ(differences(expected, nearest(*second, rays, Coherence::coherent)), 0u) << "build " << build;
        EXPECT_EQ(differences(shadow(*first, rays), shadow(*second, rays, Coherence::coherent)), 0u) << "build " << build;
    }
}

TEST_P(Batches, ManyThreads) {
    for (const auto& [name, make] : factories()) {
        const auto accelerator = make(scene.instances);
        const std::vector<Hit> expected = nearest(*accelerator, rays);
        const std::vector<Shadow> expected_shadows = shadow(*accelerator, rays);
        std::vector<std::size_t> wrong(4, 1);
        {
            std::vector<std::jthread> threads;
            for (std::size_t k = 0; k < wrong.size(); ++k) {
                threads.emplace_back([&, k] {
                    const Coherence coherence = k % 2 ? Coherence::coherent : Coherence::incoherent;
                    wrong[k] = differences(expected, nearest(*accelerator, rays, coherence)) +
                               differences(expected_shadows, shadow(*accelerator, rays, coherence));
                });
            }
        }
        for (const std::size_t count : wrong) EXPECT_EQ(count, 0u) << name;
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Batches, ::testing::Values("shapes_of_all_kinds", "instanced_meshes", "one_mesh", "coincident"),
                         [](const auto& scene_name) { return scene_name.param; });

}  // namespace
}  // namespace crescente::accel::testing
