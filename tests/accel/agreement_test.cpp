// Every accelerator gives the hits of the oracle to the bit, on scenes and rays that are hard for it.
#include <gtest/gtest.h>

#include "accel/comparison.h"

namespace crescente::accel::testing {
namespace {

constexpr std::size_t nearest_rays = 50000, shadow_rays = 30000, chunk = 1000;

class Agreement : public ::testing::TestWithParam<Recipe> {};

TEST_P(Agreement, NearestHits) {
    const TestScene scene = make_scene(GetParam());
    const auto oracle = make_linear(scene.instances);
    const std::vector<Ray> rays = random_rays(scene, nearest_rays, scene.seed, *oracle);
    const std::vector<Hit> expected = nearest(*oracle, rays);
    EXPECT_GT(std::count_if(expected.begin(), expected.end(), [](const Hit& hit) { return hit.found(); }), std::ptrdiff_t{nearest_rays / 20});
    for (const auto& [name, make] : factories()) {
        const auto accelerator = make(scene.instances);
        ASSERT_NE(accelerator, nullptr) << name;
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            std::vector<Hit> actual(rays.size());
            TestCounts counts;
            for (std::size_t i = 0; i < rays.size(); i += chunk) {
                accelerator->nearest(std::span(rays).subspan(i, chunk), std::span(actual).subspan(i, chunk), coherence, counts);
            }
            const auto ask = [=](const Accelerator& a, const Ray& ray) { return nearest(a, {&ray, 1}, coherence)[0]; };
            const std::string found = disagreements<Hit>(scene, make, rays, expected, actual, ask);
            EXPECT_TRUE(found.empty()) << name << (coherence == Coherence::coherent ? ", coherent\n" : ", incoherent\n") << found;
            EXPECT_GT(counts.shape_tests, 0u);
            EXPECT_LT(counts.shape_tests, rays.size() * scene.instances.size() * 1000);
        }
    }
}

TEST_P(Agreement, Shadows) {
    const TestScene scene = make_scene(GetParam());
    const auto oracle = make_linear(scene.instances);
    const std::vector<Ray> rays = random_rays(scene, shadow_rays, scene.seed + 1, *oracle);
    const std::vector<Shadow> expected = shadow(*oracle, rays);
    for (const auto& [name, make] : factories()) {
        const auto accelerator = make(scene.instances);
        ASSERT_NE(accelerator, nullptr) << name;
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            const std::vector<Shadow> actual = shadow(*accelerator, rays, coherence);
            const auto ask = [=](const Accelerator& a, const Ray& ray) { return shadow(a, {&ray, 1}, coherence)[0]; };
            const std::string found = disagreements<Shadow>(scene, make, rays, expected, actual, ask);
            EXPECT_TRUE(found.empty()) << name << (coherence == Coherence::coherent ? ", coherent\n" : ", incoherent\n") << found;
            std::size_t false_occluders = 0;
            for (std::size_t i = 0; i < rays.size(); i += 37) {
                if (actual[i].occluder.found()) false_occluders += !is_occluder(actual[i].occluder, scene.instances, rays[i]);
            }
            EXPECT_EQ(false_occluders, 0u) << name;
        }
    }
}

// Pictures from a few places, the first one along an axis: rays of a packet have a common origin, and in the middle they differ in the signs of
// their directions or run exactly along the axis.
TEST_P(Agreement, CameraPackets) {
    const TestScene scene = make_scene(GetParam());
    const auto oracle = make_linear(scene.instances);
    Random random(scene.seed + 2);
    std::vector<Ray> rays;
    for (int view = 0; view < 4; ++view) {
        const Vec3 forward = view == 0 ? Vec3{0, 0, -1} : random.direction();
        const Vec3 right = perpendicular(forward), up = cross(right, forward);
        const Vec3 eye = scene.center - forward * (scene.radius * (view == 1 ? 0.1 : 2.0));
        for (int y = -20; y <= 20; ++y) {
            for (int x = -20; x <= 20; ++x) rays.push_back(ray_through(eye, normalize(forward + right * (x * 0.025) + up * (y * 0.025))));
        }
    }
    const std::vector<Hit> expected = nearest(*oracle, rays);
    const std::vector<Shadow> expected_shadows = shadow(*oracle, rays);
    for (const auto& [name, make] : factories()) {
        const auto accelerator = make(scene.instances);
        ASSERT_NE(accelerator, nullptr) << name;
        const auto ask = [](const Accelerator& a, const Ray& ray) { return nearest(a, {&ray, 1}, Coherence::coherent)[0]; };
        const auto ask_shadow = [](const Accelerator& a, const Ray& ray) { return shadow(a, {&ray, 1}, Coherence::coherent)[0]; };
        const auto found = disagreements<Hit>(scene, make, rays, expected, nearest(*accelerator, rays, Coherence::coherent), ask);
        EXPECT_TRUE(found.empty()) << name << "\n" << found;
        const auto shadows = shadow(*accelerator, rays, Coherence::coherent);
        const auto found_shadows = disagreements<Shadow>(scene, make, rays, expected_shadows, shadows, ask_shadow);
        EXPECT_TRUE(found_shadows.empty()) << name << "\n" << found_shadows;
    }
}

std::vector<Recipe> recipes() {
    const Vec3 far_out{1e6, -1e6, 1e6};
    std::vector<Recipe> all;
    std::uint64_t seed = 100;
    for (const char* name : {"shapes_of_all_kinds", "instanced_meshes", "instanced_breps", "coincident"}) {
        all.push_back({name, seed++, 1, {}});
        all.push_back({name, seed++, 1, far_out});
        all.push_back({name, seed++, 1e-3, {}});
        all.push_back({name, seed++, 1e3, {}});
        all.push_back({name, seed++, 1e3, far_out});
    }
    all.push_back({"one_mesh", seed++, 1e3, {}});
    for (const char* name : {"shapes_on_a_plane", "one_mesh", "tiny_in_huge", "flattened", "modelled_far_away"}) {
        all.push_back({name, seed++, 1, {}});
        all.push_back({name, seed++, 1, far_out});
    }
    return all;
}

std::string test_name(const ::testing::TestParamInfo<Recipe>& info) {
    const Recipe& recipe = info.param;
    std::string name = recipe.name + (recipe.offset == Vec3{} ? "" : "_far_out");
    if (recipe.scale != 1) name += recipe.scale < 1 ? "_small" : "_large";
    return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, Agreement, ::testing::ValuesIn(recipes()), test_name);

}  // namespace
}  // namespace crescente::accel::testing
