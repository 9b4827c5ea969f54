// Studios fit themselves to a model of any size.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/studio.h"
#include "scene/validate.h"

namespace crescente::scene {
namespace {

Scene ball(double radius) {
    Scene scene;
    geometry::Sphere sphere;
    sphere.radius = radius;
    scene.shapes.push_back({"ball", sphere});
    Node node;
    node.name = "ball", node.shape = {0}, node.transform = math::Affine::translation(math::Vec3{3, 2, -1} * radius);
    scene.nodes.push_back(node);
    scene.roots.push_back({0});
    return scene;
}

Scene furnished(double radius, Studio studio) {
    Scene scene = ball(radius);
    add_camera(scene);
    const Placement at(scene);
    add_studio_lights(scene, at, studio);
    add_ground(scene, at, Ground::catcher);
    return scene;
}

TEST(Studio, AllPresetsFitFromAMillimetreToAHundredMetres) {
    for (std::size_t i = 0; i < std::size(studio_names); ++i) {
        SCOPED_TRACE(std::string(studio_names[i]));
        const Scene one = furnished(1, static_cast<Studio>(i));
        EXPECT_TRUE(validate(one, "").empty());
        ASSERT_FALSE(one.lights.empty());
        for (const double size : {5e-4, 50.0}) {
            const Scene other = furnished(size, static_cast<Studio>(i));
            EXPECT_TRUE(validate(other, "").empty());
            ASSERT_EQ(other.lights.size(), one.lights.size());
            EXPECT_LT(length(other.camera->position / size - one.camera->position), 1e-9);
            for (std::size_t l = 0; l < one.lights.size(); ++l) {
                const Light &a = one.lights[l], &b = other.lights[l];
                EXPECT_LT(length(b.position / size - a.position), 1e-9);
                EXPECT_NEAR(visible_area(b) / (size * size), visible_area(a), 1e-9);
                EXPECT_NEAR(b.intensity / (size * size), a.intensity, 1e-9 * a.intensity) << "so that as much arrives";
                EXPECT_LT(std::acos(std::min(1.0, dot(normalize(b.direction), normalize(a.direction)))), 1e-6);
            }
            ASSERT_EQ(other.nodes.size(), 2u);
            EXPECT_NEAR(other.nodes[1].transform.origin.y / size, one.nodes[1].transform.origin.y, 1e-9);
        }
    }
}

TEST(Studio, AddsOnlyWhatIsMissing) {
    Scene scene = ball(1);
    scene.lights.emplace_back().name = "own";
    add_studio(scene);
    EXPECT_TRUE(scene.camera);
    EXPECT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.nodes.size(), 1u);
    EXPECT_FALSE(scene.environment);
    Scene bare = ball(1);
    add_studio(bare);
    EXPECT_GT(bare.lights.size(), 1u);
    EXPECT_EQ(bare.nodes.size(), 2u);
    EXPECT_TRUE(bare.environment && bare.environment->backdrop && bare.environment->lights());
}

}  // namespace
}  // namespace crescente::scene
