// Whatever was done to a draft, its edits make the scene what the draft is.
#include "scene/draft.h"

#include <random>

#include <gtest/gtest.h>

namespace crescente::scene {
namespace {

Scene some_scene() {
    Scene scene;
    scene.camera = Camera{};
    for (int i = 0; i < 4; ++i) {
        const std::string name = "n" + std::to_string(i);
        scene.shapes.push_back({name, geometry::Sphere{}});
        scene.materials.push_back({name, PhysicalMaterial{}});
        scene.nodes.push_back({name, {}, ShapeId{static_cast<std::uint32_t>(i)}, {}, {}, true});
        scene.roots.push_back({static_cast<std::uint32_t>(i)});
        scene.lights.emplace_back().name = name;
    }
    return scene;
}

TEST(Draft, EditsMakeTheSceneWhatTheDraftIs) {
    std::mt19937 random(7);
    const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
    for (int round = 0; round < 500; ++round) {
        Scene scene = some_scene();
        const Scene before = scene;
        Draft draft(before);
        const std::size_t steps = below(12);
        for (std::size_t step = 0; step < steps; ++step) {
            const double value = static_cast<double>(random() % 1000);
            switch (below(11)) {
                case 0: std::get<PhysicalMaterial>(draft.materials.change(below(draft.materials.size())).model).ior = value; break;
                case 1: draft.materials.add({"new", PhysicalMaterial{}}); break;
                case 2: std::get<geometry::Sphere>(draft.shapes.change(below(draft.shapes.size())).shape).radius = value; break;
                case 3: draft.shapes.add({"new", geometry::Sphere{}}); break;
                case 4: draft.nodes.change(below(draft.nodes.size())).transform.origin.x = value; break;
                case 5: draft.roots.push_back({draft.nodes.add({})}); break;
                case 6: draft.roots.erase(draft.roots.begin()); draft.roots.push_back({0}); break;
                case 7: draft.lights.insert(draft.lights.begin() + static_cast<std::ptrdiff_t>(below(draft.lights.size() + 1)), Light{})->intensity = value; break;
                case 8: if (!draft.lights.empty()) draft.lights.erase(draft.lights.begin() + static_cast<std::ptrdiff_t>(below(draft.lights.size()))); break;
                case 9: if (!draft.lights.empty()) draft.lights[below(draft.lights.size())].intensity = value; break;
                default: draft.camera->position.x = value, draft.environment.emplace().strength = value, draft.settings.depth = 3; break;
            }
        }
        apply_unchecked(draft.edits(), scene);
        EXPECT_EQ(scene.lights, draft.lights);
        EXPECT_EQ(scene.roots, draft.roots);
        EXPECT_EQ(scene.camera, draft.camera);
        EXPECT_EQ(scene.environment, draft.environment);
        EXPECT_EQ(scene.settings, draft.settings);
        ASSERT_EQ(scene.nodes.size(), draft.nodes.size());
        for (std::size_t i = 0; i < scene.nodes.size(); ++i) EXPECT_EQ(scene.nodes[i].transform, draft.nodes[i].transform);
        ASSERT_EQ(scene.materials.size(), draft.materials.size());
        for (std::size_t i = 0; i < scene.materials.size(); ++i) EXPECT_EQ(scene.materials[i].model, draft.materials[i].model);
        ASSERT_EQ(scene.shapes.size(), draft.shapes.size());
        for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
            EXPECT_EQ(std::get<geometry::Sphere>(scene.shapes[i].shape).radius, std::get<geometry::Sphere>(draft.shapes[i].shape).radius);
        }
    }
}

TEST(Draft, NothingDoneIsNoEdit) {
    const Scene scene = some_scene();
    EXPECT_TRUE(Draft(scene).edits().empty());
}

TEST(Draft, OneLightTakenAwayIsOneEdit) {
    const Scene scene = some_scene();
    Draft draft(scene);
    draft.lights.erase(draft.lights.begin() + 1);
    const auto edits = draft.edits();
    ASSERT_EQ(edits.size(), 1u);
    EXPECT_EQ(std::get<RemoveLight>(edits[0]).light, 1u);
}

}  // namespace
}  // namespace crescente::scene
