// Cases with answers known by hand: parameters, faces, normals, u and v, and the fields' tables.
#include <gtest/gtest.h>

#include "geometry/kinds.h"
#include "geometry/shape_check.h"

namespace crescente::geometry::test {
namespace {

template <class S>
std::vector<double> parameters(const S& shape, Vec3 origin, Vec3 direction) {
    std::vector<double> t;
    for (const ShapeHit& hit : all_hits(shape, Ray{origin, direction})) t.push_back(hit.t);
    return t;
}
using Parameters = std::vector<double>;

TEST(Analytic, sphere) {
    EXPECT_EQ(parameters(Sphere{1}, {0, 0, -3}, {0, 0, 1}), (Parameters{2, 4}));
    EXPECT_EQ(parameters(Sphere{1}, {0, 0, -3}, {0, 0, 0.5}), (Parameters{4, 8}));
    EXPECT_EQ(parameters(Sphere{1}, {0, 0, 0}, {0, 1, 0}), (Parameters{1}));
    EXPECT_EQ(parameters(Sphere{1}, {0, 1, -3}, {0, 0, 1}), (Parameters{}));  // a touch is no crossing
    EXPECT_EQ(parameters(Sphere{0}, {0, 0, -3}, {0, 0, 1}), (Parameters{}));
    const Sphere two{2};
    const SurfacePoint east = two.surface(0, {2, 0, 0}), north = two.surface(0, {0, 2, 0}), front = two.surface(0, {0, 0, 2});
    EXPECT_EQ(east.u, 0);
    EXPECT_EQ(east.v, 0.5);
    EXPECT_EQ(north.v, 1);
    EXPECT_EQ(front.u, 0.75);
    EXPECT_EQ(front.normal, (Vec3{0, 0, 1}));
}

TEST(Analytic, reach_of_a_ray) {
    const Sphere sphere{1};
    EXPECT_EQ(sphere.intersect(0, {{0, 0, -3}, {0, 0, 1}, 2, 10})->t, 4);  // t_min itself is out of reach
    EXPECT_EQ(sphere.intersect(0, {{0, 0, -3}, {0, 0, 1}, 0, 2})->t, 2);   // t_max is in reach
    EXPECT_FALSE(sphere.intersect(0, {{0, 0, -3}, {0, 0, 1}, 0, 1.999}));
    EXPECT_FALSE(sphere.intersect(0, {{0, 0, -3}, {0, 0, 1}, 4, 100}));
}

TEST(Analytic, box_faces) {
    const Box box{{-1, -2, -3}, {1, 2, 3}};
    const Vec3 normals[6] = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
    for (std::uint32_t face = 0; face < 6; ++face) {
        const auto hit = box.intersect(0, Ray{normals[face] * 10, -normals[face]});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->primitive, face);
        EXPECT_EQ(hit->t, 10 - (face / 2 + 1));
        EXPECT_EQ(box.surface(face, normals[face] * (10 - hit->t)).normal, normals[face]);
        EXPECT_EQ(box.surface(face, normals[face] * (10 - hit->t)).u, 0.5);
        EXPECT_EQ(box.intersect(0, Ray{{0, 0, 0}, normals[face]})->primitive, face);
    }
    EXPECT_EQ(parameters(box, {1, 5, 0}, {0, -1, 0}), (Parameters{3, 7}));  // in the plane of a face
    EXPECT_EQ(parameters(box, {1 + 1e-15, 5, 0}, {0, -1, 0}), (Parameters{}));
    EXPECT_EQ(parameters(box, {5, 1, 0}, {0, 0, 0}), (Parameters{}));
    EXPECT_EQ(parameters(Box{{-1, 0, -1}, {1, 0, 1}}, {0, 2, 0}, {0, -1, 0}), (Parameters{2}));  // no thickness: one face
}

TEST(Analytic, cylinder) {
    const Cylinder closed{1, 2, true}, open{1, 2, false};
    EXPECT_EQ(parameters(closed, {-3, 1, 0}, {1, 0, 0}), (Parameters{2, 4}));
    EXPECT_EQ(parameters(closed, {0.5, 5, 0}, {0, -1, 0}), (Parameters{3, 5}));
    EXPECT_EQ(closed.intersect(0, Ray{{0.5, 5, 0}, {0, -1, 0}})->primitive, 2u);
    EXPECT_EQ(closed.intersect(0, Ray{{0.5, -5, 0}, {0, 1, 0}})->primitive, 1u);
    EXPECT_EQ(closed.intersect(0, Ray{{0.5, 1, 0}, {1, 0, 0}})->primitive, 0u);
    EXPECT_EQ(parameters(open, {0.5, 5, 0}, {0, -1, 0}), (Parameters{}));
    EXPECT_EQ(parameters(open, {0, 3.1, 0}, {1, -1, 0}), (Parameters{}));       // over the rim
    EXPECT_EQ(parameters(open, {0, 2.5, 0}, {1, -1, 0}), (Parameters{1}));      // through the open end onto the wall
    EXPECT_EQ(closed.surface(2, {0.5, 2, 0}).normal, (Vec3{0, 1, 0}));
    EXPECT_EQ(closed.surface(0, {1, 0.5, 0}).v, 0.25);
}

TEST(Analytic, cone) {
    const Cone cone{1, 0, 1, true};
    EXPECT_EQ(parameters(cone, {-3, 0.5, 0}, {1, 0, 0}), (Parameters{2.5, 3.5}));
    EXPECT_EQ(parameters(cone, {0, 5, 0}, {0, -1, 0}), (Parameters{4, 5}));  // through the apex, along the axis
    EXPECT_EQ(cone.intersect(0, Ray{{0, 5, 0}, {0, -1, 0}})->primitive, 0u);
    EXPECT_EQ(parameters(cone, {-3, 1, 0}, {1, 0, 0}), (Parameters{}));      // past the apex
    const SurfacePoint side = cone.surface(0, {0.5, 0.5, 0});
    EXPECT_NEAR(side.normal.x, std::sqrt(0.5), 1e-15);
    EXPECT_NEAR(side.normal.y, std::sqrt(0.5), 1e-15);
    EXPECT_TRUE(is_finite(cone.surface(0, {0, 1, 0}).normal));
    // A line of the wall itself, and lines parallel to the wall.
    EXPECT_EQ(parameters(cone, {0, 2, 0}, {1, -1, 0}), (Parameters{}));
    EXPECT_EQ(parameters(cone, {-1, 1.5, 0}, {1, -1, 0}).size(), 2u);
}

TEST(Analytic, torus) {
    const Torus torus{1, 0.25};
    EXPECT_EQ(parameters(torus, {-3, 0, 0}, {1, 0, 0}), (Parameters{1.75, 2.25, 3.75, 4.25}));
    EXPECT_EQ(parameters(torus, {1, 3, 0}, {0, -1, 0}), (Parameters{2.75, 3.25}));
    EXPECT_EQ(parameters(torus, {0, 3, 0}, {0, -1, 0}), (Parameters{}));         // through the hole
    EXPECT_EQ(parameters(torus, {0.75, 3, 0}, {0, -1, 0}), (Parameters{}));      // touches the hole's wall
    EXPECT_EQ(parameters(torus, {-3, 0.25, 0}, {1, 0, 0}), (Parameters{}));      // touches the top twice
    EXPECT_EQ(parameters(Torus{0.5, 1}, {-3, 0, 0}, {1, 0, 0}), (Parameters{1.5, 4.5}));  // spindle: the outer surface alone
    const SurfacePoint top = torus.surface(0, {1, 0.25, 0});
    EXPECT_EQ(top.normal, (Vec3{0, 1, 0}));
    EXPECT_EQ(top.v, 0.25);
    EXPECT_EQ(torus.surface(0, {-0.75, 0, 0}).normal, (Vec3{1, 0, 0}));
    EXPECT_TRUE(is_finite(torus.surface(0, {0, 0, 0}).normal));
}

// Rays at the very grazing height of a torus, from far away: a hit or none, but never one crossing.
TEST(Analytic, torus_grazing) {
    const Torus torus{1, 0.25};
    double y = 0.25;
    for (int i = 0; i < 200; ++i) y = std::nextafter(y, 0);
    int hits = 0;
    for (int i = 0; i < 400; ++i, y = std::nextafter(y, 1)) {
        for (const double far : {3.0, 1e3, 1e6}) {
            const auto t = parameters(torus, {-far, y, 0.3}, {1, 0, 0});
            EXPECT_EQ(t.size() % 2, 0u);
            hits += !t.empty();
        }
    }
    EXPECT_GT(hits, 100);
}

// A tube a million times thinner than its ring.
TEST(Analytic, torus_thin) {
    const Torus wire{1, 1e-6};
    Random random(3);
    for (int i = 0; i < 20000; ++i) {
        const double turn = random.between(0, 2 * pi);
        const Vec3 middle{std::cos(turn), 0, std::sin(turn)};
        const Vec3 d = random.direction();
        const auto hits = all_hits(wire, Ray{middle + random.direction() * 0.5e-6 - d * 3.0, d});
        ASSERT_GE(hits.size(), 2u);
        ASSERT_EQ(hits.size() % 2, 0u);
    }
}

TEST(Analytic, disk_and_plane) {
    const Disk ring{2, 1};
    EXPECT_EQ(parameters(ring, {1.5, 4, 0}, {0, -1, 0}), (Parameters{4}));
    EXPECT_EQ(parameters(ring, {0.5, 4, 0}, {0, -1, 0}), (Parameters{}));
    EXPECT_EQ(parameters(ring, {2.5, 4, 0}, {0, -1, 0}), (Parameters{}));
    EXPECT_EQ(parameters(ring, {2, 4, 0}, {0, -1, 0}), (Parameters{4}));
    EXPECT_EQ(parameters(ring, {1, 4, 0}, {0, -1, 0}), (Parameters{4}));
    EXPECT_EQ(parameters(ring, {-4, 0, 0}, {1, 0, 0}), (Parameters{}));  // in its plane
    EXPECT_EQ(ring.surface(0, {1.5, 1e-9, 0}).normal, (Vec3{0, 1, 0}));
    EXPECT_EQ(ring.surface(0, {1.5, 1e-9, 0}).position, (Vec3{1.5, 0, 0}));
    EXPECT_EQ(parameters(Plane{}, {3, 4, 5}, {0, -2, 0}), (Parameters{2}));
    EXPECT_EQ(parameters(Plane{}, {3, 4, 5}, {1, 0, 0}), (Parameters{}));
    EXPECT_EQ(parameters(Plane{}, {3, 4, 5}, {0, 1, 0}), (Parameters{}));
    EXPECT_FALSE(Plane{}.bounds().bounded());
    EXPECT_FALSE(Plane{}.bounds().empty());
    check_hostile_rays(ring);
    check_hostile_rays(Plane{});
    check_transformed(ring, 2, 2000, 1);
    check_transformed(Plane{}, 1, 2000, 1);
}

TEST(Analytic, fields_read_and_write_every_member) {
    const auto names = [](const auto& table) {
        std::vector<std::string> list;
        for (const auto& f : table) {
            list.push_back(f.info.name);
            EXPECT_FALSE(f.info.doc.empty());
        }
        return list;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(names(Sphere::fields()), (Names{"radius"}));
    EXPECT_EQ(names(Box::fields()), (Names{"lower", "upper"}));
    EXPECT_EQ(names(Cone::fields()), (Names{"base_radius", "top_radius", "height", "capped"}));
    EXPECT_EQ(names(Cylinder::fields()), (Names{"radius", "height", "capped"}));
    EXPECT_EQ(names(Torus::fields()), (Names{"major_radius", "minor_radius"}));
    EXPECT_EQ(names(Disk::fields()), (Names{"radius", "inner_radius"}));
    EXPECT_TRUE(Plane::fields().empty() && Polygon::fields().empty() && Mesh::fields().empty());
    Cone cone;
    Cone::fields()[1].set(cone, 0.25);
    EXPECT_EQ(cone.top_radius, 0.25);
    EXPECT_EQ(std::get<double>(Cone::fields()[1].get(cone)), 0.25);
}

}  // namespace
}  // namespace crescente::geometry::test
