// Scenes and rays at the edge of what makes sense: the accelerators still agree, and nothing crashes or hangs.
#include <gtest/gtest.h>

#include "accel/comparison.h"

namespace crescente::accel::testing {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();

std::vector<Ray> probes() {
    Random random(5);
    std::vector<Ray> rays;
    for (int i = 0; i < 2000; ++i) rays.push_back(ray_through(random.in_cube(2), random.direction()));
    for (int axis = 0; axis < 3; ++axis) {
        for (int i = 0; i < 100; ++i) {
            Vec3 direction;
            direction[axis] = i % 2 ? 1 : -1;
            rays.push_back(ray_through(random.in_cube(2), direction));
        }
    }
    return rays;
}

void expect_agreement(std::span<const Instance> instances, std::span<const Ray> rays) {
    const auto oracle = make_linear(instances);
    const auto expected = nearest(*oracle, rays);
    const auto expected_shadows = shadow(*oracle, rays);
    for (const auto& [name, make] : factories()) {
        const auto accelerator = make(instances);
        ASSERT_NE(accelerator, nullptr) << name;
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            const auto actual = nearest(*accelerator, rays, coherence);
            const auto shadows = shadow(*accelerator, rays, coherence);
            for (std::size_t i = 0; i < rays.size(); ++i) {
                ASSERT_TRUE(same(expected[i], actual[i]))
                    << name << ": linear " << text(expected[i]) << ", other " << text(actual[i]) << " on " << text(rays[i]);
                ASSERT_TRUE(same(expected_shadows[i], shadows[i]))
                    << name << ": linear " << text(expected_shadows[i]) << ", other " << text(shadows[i]) << " on " << text(rays[i]);
            }
        }
    }
}

TEST(OddInput, NothingInTheScene) { expect_agreement({}, probes()); }

TEST(OddInput, NoRays) {
    const geometry::Shape sphere = geometry::Sphere{1};
    const std::vector<Instance> instances{{sphere, Affine{}, true}};
    expect_agreement(instances, {});
}

TEST(OddInput, OnlyAPlane) {
    const geometry::Shape plane = geometry::Plane{};
    for (const bool opaque : {true, false}) {
        const std::vector<Instance> instances{{plane, Affine::rotation({1, 2, 3}, 1), opaque}};
        expect_agreement(instances, probes());
        EXPECT_TRUE(nearest(*make_linear(instances), probes())[0].found() || nearest(*make_linear(instances), probes())[1].found());
    }
}

TEST(OddInput, EmptyMesh) {
    const geometry::Shape mesh = geometry::Mesh{}, sphere = geometry::Sphere{1};
    expect_agreement(std::vector<Instance>{{mesh, Affine{}, true}}, probes());
    expect_agreement(std::vector<Instance>{{mesh, Affine{}, true}, {sphere, Affine{}, false}, {mesh, Affine{}, true}}, probes());
}

TEST(OddInput, DegenerateTriangles) {
    geometry::Mesh mesh = sphere_mesh(4, 6);
    const auto n = static_cast<std::uint32_t>(mesh.triangles.size());
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto [a, b, c] = mesh.triangles[i];
        mesh.triangles.push_back({a, a, a});
        mesh.triangles.push_back({a, b, b});
    }
    mesh.positions.insert(mesh.positions.end(), {{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}});  // on one line
    const auto first = static_cast<std::uint32_t>(mesh.positions.size() - 3);
    mesh.triangles.push_back({first, first + 1, first + 2});
    const geometry::Shape shape = mesh;
    for (const bool opaque : {true, false}) {
        expect_agreement(std::vector<Instance>{{shape, Affine{}, opaque}}, probes());
        expect_agreement(std::vector<Instance>{{shape, Affine{}, opaque}, {shape, Affine::rotation({1, 1, 1}, 1), !opaque}}, probes());
    }
}

TEST(OddInput, VerticesThatAreNoNumbers) {
    geometry::Mesh mesh = sphere_mesh(6, 8);
    mesh.positions[5] = {nan, 0, 0};
    mesh.positions[9] = {nan, nan, nan};
    mesh.triangles.push_back({9, 9, 9});
    const geometry::Shape shape = mesh, sphere = geometry::Sphere{0.5};
    expect_agreement(std::vector<Instance>{{shape, Affine{}, false}, {sphere, Affine{}, true}}, probes());
    expect_agreement(std::vector<Instance>{{shape, Affine{}, true}, {sphere, Affine{}, true}, {shape, Affine::scaling({2, 2, 2}), true}}, probes());
}

TEST(OddInput, VerticesFarBeyondTheRest) {
    for (const double far_out : {1e12, 1e30, 1e80, 1e200, infinity}) {
        geometry::Mesh mesh = sphere_mesh(6, 8);
        mesh.positions[5] = {far_out, 0, 0};
        const geometry::Shape shape = mesh, sphere = geometry::Sphere{0.5};
        SCOPED_TRACE(far_out);
        expect_agreement(std::vector<Instance>{{shape, Affine{}, false}, {sphere, Affine{}, true}}, probes());
        expect_agreement(std::vector<Instance>{{shape, Affine{}, true}, {sphere, Affine{}, true}, {shape, Affine::scaling({2, 2, 2}), true}},
                         probes());
    }
}

TEST(OddInput, FlattenedToNothing) {
    const geometry::Shape box = geometry::Box{}, sphere = geometry::Sphere{0.5}, mesh = sphere_mesh(4, 6);
    const Affine flat = Affine::rotation({1, 2, 3}, 1) * Affine::scaling({1, 0, 1});
    expect_agreement(std::vector<Instance>{{box, flat, true}, {sphere, flat, true}, {mesh, flat, false}, {mesh, flat, true}}, probes());
    expect_agreement(std::vector<Instance>{{box, flat, true}, {sphere, Affine{}, true}, {mesh, flat, true}, {mesh, Affine{}, false}}, probes());
    const Affine point = Affine::scaling({0, 0, 0});
    expect_agreement(std::vector<Instance>{{box, point, true}, {sphere, Affine{}, true}, {mesh, point, true}}, probes());
}

TEST(OddInput, OnePointInSpace) {
    const geometry::Shape sphere = geometry::Sphere{1e-9};
    std::vector<Ray> rays;
    Random random(6);
    for (int i = 0; i < 500; ++i) {
        const Vec3 direction = random.direction();
        rays.push_back(ray_through(Vec3{1e3, 1e3, 1e3} - direction * random.uniform(1e-9, 1e3), direction));
    }
    expect_agreement(std::vector<Instance>{{sphere, Affine::translation({1e3, 1e3, 1e3}), true}}, rays);
}

TEST(OddInput, RangesBehindTheOriginAndBackwards) {
    const geometry::Shape sphere = geometry::Sphere{1}, box = geometry::Box{}, mesh = sphere_mesh(6, 8), plane = geometry::Plane{};
    std::vector<Ray> rays = probes();
    Random random(7);
    for (Ray& ray : rays) {
        switch (random.below(4)) {
            case 0: ray.t_min = -random.uniform(0, 4), ray.t_max = 0; break;
            case 1: ray.t_min = 2, ray.t_max = 1; break;
            case 2: ray.t_min = ray.t_max = random.uniform(0, 3); break;
            default: ray.t_min = -infinity; break;
        }
    }
    expect_agreement(std::vector<Instance>{{sphere, Affine::scaling({1, 2, 1}), false}, {box, Affine::rotation({1, 2, 3}, 1), true},
                                           {mesh, Affine::translation({1, 0, 0}), false}, {plane, Affine{}, false}}, rays);
}

// What is hit is undefined; that the call returns is not.
TEST(OddInput, RaysThatAreNoRays) {
    const geometry::Shape sphere = geometry::Sphere{1}, torus = geometry::Torus{}, mesh = sphere_mesh(6, 8), plane = geometry::Plane{};
    std::vector<Instance> instances{{sphere, Affine{}, false}, {torus, Affine{}, true}, {mesh, Affine::translation({1, 0, 0}), false}, {plane, Affine{}, true}};
    instances.emplace_back(mesh, Affine::translation({-1, 0, 0}), true);
    std::vector<Ray> rays;
    const double odd[] = {0, 1, nan, infinity, -infinity, 1e308, -1e-320};
    for (const double a : odd) {
        for (const double b : odd) {
            rays.push_back(ray_through({a, b, 0}, {1, 0, 0}));
            rays.push_back(ray_through({0, 0, 0}, {a, b, 0}));
            rays.push_back(ray_through({b, 0, 0}, {0, a, b}));
            rays.push_back(ray_through({-5, 0, 0}, {1, 0, 0}));
            rays.back().t_min = a, rays.back().t_max = b;
        }
    }
    for (const auto& [name, make] : factories()) {
        const auto accelerator = make(instances);
        for (const Coherence coherence : {Coherence::coherent, Coherence::incoherent}) {
            for (const Hit& hit : nearest(*accelerator, rays, coherence)) EXPECT_TRUE(!hit.found() || hit.instance < instances.size()) << name;
            EXPECT_EQ(shadow(*accelerator, rays, coherence).size(), rays.size()) << name;
        }
    }
}

}  // namespace
}  // namespace crescente::accel::testing
