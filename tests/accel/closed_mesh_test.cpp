// No ray passes between the triangles of a closed mesh.
#include <gtest/gtest.h>

#include "accel/comparison.h"

namespace crescente::accel::testing {
namespace {

// A sphere of 19,800 triangles under a transform; rays from inside at its vertices and edge midpoints, and through the poles where
// a hundred triangles meet.
class ClosedMesh : public ::testing::TestWithParam<std::tuple<std::string, Affine>> {
protected:
    ClosedMesh() : shape(sphere_mesh(100, 100, 0.05)), instances{{shape, std::get<Affine>(GetParam()), true}} {}

    std::vector<Ray> rays_from_inside(std::size_t limit) const {
        const auto& mesh = std::get<geometry::Mesh>(shape);
        Random random(3);
        std::vector<Vec3> targets;
        for (const Vec3& p : mesh.positions) targets.push_back(p);
        for (const auto& [a, b, c] : mesh.triangles) {
            for (const auto& [i, j] : {std::pair{a, b}, {b, c}, {c, a}}) {
                const double f = random.chance(0.5) ? 0.5 : random.uniform();
                targets.push_back(mesh.positions[i] * (1 - f) + mesh.positions[j] * f);
            }
        }
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < targets.size() && rays.size() < limit; ++i) {
            const Vec3 from = instances[0].to_world.point(i % 2 ? Vec3{} : random.in_cube(0.5));
            rays.push_back(ray_through(from, normalize(instances[0].to_world.point(targets[i]) - from)));
        }
        for (int axis = 0; axis < 3; ++axis) {
            for (const double sign : {-1.0, 1.0}) {
                Vec3 direction;
                direction[axis] = sign;
                rays.push_back(ray_through(instances[0].to_world.origin, direction));
            }
        }
        return rays;
    }

    geometry::Shape shape;
    std::vector<Instance> instances;
};

TEST_P(ClosedMesh, NeverLeaks) {
    const std::vector<Ray> rays = rays_from_inside(100000);
    ASSERT_GT(rays.size(), 60000u);
    for (const auto& [name, make] : factories()) {
        const auto accelerator = make(instances);
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            const std::vector<Hit> hits = nearest(*accelerator, rays, coherence);
            std::size_t leaks = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (hits[i].found()) continue;
                if (++leaks <= 3) ADD_FAILURE() << name << ": nothing on " << text(rays[i]);
            }
            EXPECT_EQ(leaks, 0u) << name;
        }
    }
}

// The same from afar: a ray at a vertex from outside crosses a closed surface an even number of times.
TEST_P(ClosedMesh, CrossedAnEvenNumberOfTimesFromAfar) {
    instances[0].opaque = false;
    const auto& mesh = std::get<geometry::Mesh>(shape);
    const double size = max_component(abs(instances[0].to_world.vector({1, 1, 1})));
    for (const double distance : {3.0, 1e3, 1e6}) {
        Random random(4);
        std::vector<Ray> rays;
        for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
            const Vec3 direction = random.direction();
            rays.push_back(ray_through(instances[0].to_world.point(mesh.positions[i]) - direction * (distance * size), direction));
        }
        for (const auto& [name, make] : factories()) {
            const std::vector<Shadow> shadows = shadow(*make(instances), rays, Coherence::coherent);
            std::size_t odd = 0;
            for (std::size_t i = 0; i < rays.size(); ++i) {
                if (shadows[i].crossings.size() % 2 == 0) continue;
                if (++odd <= 3) ADD_FAILURE() << name << ": " << text(shadows[i]) << " on " << text(rays[i]);
            }
            EXPECT_EQ(odd, 0u) << name << " from " << distance;
        }
    }
}

Affine turned(double scale, Vec3 offset) {
    return Affine::translation(offset) * Affine::rotation({1, 2, 3}, 1) * Affine::scaling({scale, scale * 0.6, -scale});
}

INSTANTIATE_TEST_SUITE_P(Places, ClosedMesh,
                         ::testing::Values(std::tuple{std::string("at_the_origin"), Affine{}}, std::tuple{std::string("turned"), turned(1, {})},
                                           std::tuple{std::string("small"), turned(1e-3, {1, 2, 3})},
                                           std::tuple{std::string("far_out"), turned(1, {1e6, -1e6, 1e6})}),
                         [](const auto& place) { return std::get<std::string>(place.param); });

}  // namespace
}  // namespace crescente::accel::testing
