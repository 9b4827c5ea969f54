// Polygons and meshes: nothing passes between neighbours, a ray on an edge or vertex belongs to one of them.
#include <gtest/gtest.h>

#include <numeric>

#include "geometry/mesh.h"
#include "geometry/polygon.h"
#include "geometry/shape_check.h"

namespace crescente::geometry::test {
namespace {

// A closed bumpy ball of latitude and longitude, every vertex shared.
Mesh ball(int rings, int sectors, std::uint64_t seed, double size, Vec3 center) {
    Random random(seed);
    Mesh mesh;
    const auto place = [&](double v, double u) {
        const double r = size * random.between(0.8, 1.2);
        mesh.positions.push_back(center + Vec3{std::cos(v) * std::cos(u), std::sin(v), -std::cos(v) * std::sin(u)} * r);
    };
    place(-pi / 2, 0);
    for (int i = 1; i < rings; ++i) {
        for (int k = 0; k < sectors; ++k) place(-pi / 2 + pi * i / rings, 2 * pi * k / sectors);
    }
    place(pi / 2, 0);
    const auto index = [&](int ring, int k) {
        if (ring == 0) return 0u;
        return ring == rings ? std::uint32_t(mesh.positions.size() - 1) : std::uint32_t(1 + (ring - 1) * sectors + k % sectors);
    };
    for (int i = 0; i < rings; ++i) {
        for (int k = 0; k < sectors; ++k) {
            if (i > 0) mesh.triangles.push_back({index(i, k), index(i, k + 1), index(i + 1, k)});
            if (i + 1 < rings) mesh.triangles.push_back({index(i, k + 1), index(i + 1, k + 1), index(i + 1, k)});
        }
    }
    return mesh;
}

// The same surface as polygons of one triangle each, to hold Polygon to the same.
std::vector<Polygon> polygons_of(const Mesh& mesh) {
    std::vector<Polygon> polygons;
    for (const auto& t : mesh.triangles) polygons.push_back({{{mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]}}});
    return polygons;
}

// Rays that a closed surface around the origin's neighbourhood cannot let pass: from inside, exactly at vertices and points of edges.
TEST(Watertight, closed_mesh_and_polygons) {
    for (const double offset : {0.0, 1e6}) {
        for (const double size : {1e-3, 1.0, 1e3}) {
            const Vec3 center = Vec3{1, -0.7, 0.3} * (offset * size);
            const Mesh mesh = ball(9, 12, 5, size, center);
            const std::vector<Polygon> polygons = polygons_of(mesh);
            Random random(6);
            for (int i = 0; i < 3000; ++i) {
                const auto& t = mesh.triangles[random.bits() % mesh.triangles.size()];
                const Vec3 a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
                const double s = i % 3 == 0 ? 0 : random.unit(), r = i % 3 == 2 ? random.unit() : 0;
                const Vec3 target = a + (b - a) * s + (c - a) * ((1 - s) * r);
                Ray ray;
                const bool from_inside = i % 2 == 0;
                ray.origin = center + (from_inside ? random.inside_cube() * (0.3 * size) : random.direction() * (4 * size));
                if (i % 5 == 0) ray.origin = center;
                if (i % 7 == 0) ray.origin = {target.x, from_inside ? center.y : target.y, center.z + (from_inside ? 0 : 4 * size)};
                const bool inside = length(ray.origin - center) < 0.5 * size;
                ray.direction = target - ray.origin;
                if (i % 7 == 0) ray.direction = from_inside ? Vec3{0, ray.direction.y, ray.direction.z} : Vec3{0, 0, -1};
                const auto hits = all_hits(mesh, ray);
                if (inside) {
                    ASSERT_EQ(hits.size() % 2, 1u) << i;
                } else if (length(ray.origin - center) > 1.5 * size) {
                    ASSERT_EQ(hits.size() % 2, 0u) << i;
                }
                std::size_t count = 0;
                for (const Polygon& polygon : polygons) count += polygon.intersect(0, ray).has_value();
                ASSERT_EQ(count, hits.size()) << i;
            }
        }
    }
}

TEST(Watertight, two_triangles_of_a_square) {
    const Mesh square{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
    Random random(8);
    for (int i = 0; i < 100000; ++i) {
        const double s = random.between(1e-3, 1 - 1e-3);
        Ray ray;
        ray.origin = {random.between(-3, 3), random.between(-3, 3), random.between(1, 2)};
        ray.direction = Vec3{s, s, 0} - ray.origin;  // at the diagonal
        ASSERT_EQ(all_hits(square, ray).size(), 1u);
    }
    for (int i = 1; i < 64; ++i) {  // exactly on the diagonal, without any rounding
        ASSERT_EQ(all_hits(square, Ray{{i / 64.0, i / 64.0, 1}, {0, 0, -1}}).size(), 1u);
    }
}

TEST(Mesh, triangles_without_area_are_never_hit) {
    const Mesh flat{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0.1, 0.2, 0.3}, {0.2, 0.4, 0.6}, {0.4, 0.8, 1.2}},
                    {{0, 1, 2}, {0, 0, 1}, {1, 1, 1}, {3, 4, 5}, {5, 4, 3}}, {}, {}};
    Random random(9);
    for (int i = 0; i < 20000; ++i) {
        Ray ray;
        ray.origin = random.inside_cube() * 4;
        const Vec3 target = i % 2 ? Vec3{random.between(0, 2), 0, 0} : Vec3{0.1, 0.2, 0.3} * random.between(1, 4);
        ray.direction = target - ray.origin;
        ASSERT_TRUE(all_hits(flat, ray).empty());
    }
    check_hostile_rays(flat);
}

// Hits and surface points against the plane in long double; narrow triangles far from the origin included.
TEST(Mesh, hits_are_on_the_triangle) {
    Random random(10);
    for (int i = 0; i < 100000; ++i) {
        const double offset = i % 3 == 0 ? 0 : i % 3 == 1 ? 10 : 1e6, narrow = i % 2 ? 1 : 1e-3;
        Mesh mesh;
        const Vec3 place = random.inside_cube() * offset, along = random.direction();
        const Vec3 a = place, b = place + along, c = place + along * random.unit() + random.direction() * narrow;
        mesh.positions = {a, b, c};
        mesh.triangles = {{0, 1, 2}};
        const Exact ab{(long double)b.x - a.x, (long double)b.y - a.y, (long double)b.z - a.z};
        const Exact ac{(long double)c.x - a.x, (long double)c.y - a.y, (long double)c.z - a.z};
        const Exact n{ab.y * ac.z - ab.z * ac.y, ab.z * ac.x - ab.x * ac.z, ab.x * ac.y - ab.y * ac.x};
        const long double area = std::hypot(n.x, n.y, n.z);
        const auto off = [&](Exact p) { return std::abs((p.x - a.x) * n.x + (p.y - a.y) * n.y + (p.z - a.z) * n.z) / area; };
        const double u = random.between(0.01, 0.99), v = random.between(0.01, 0.99 * (1 - u));
        const Vec3 target = a + (b - a) * u + (c - a) * v;
        Ray ray;
        ray.direction = random.direction();
        const double far = random.between(1, 5);
        ray.origin = target - ray.direction * far;
        const double incidence = static_cast<double>(std::abs((n.x * ray.direction.x + n.y * ray.direction.y + n.z * ray.direction.z) / area));
        if (incidence < 0.05) continue;
        const auto hit = mesh.intersect(0, ray);
        if (!hit) {
            ASSERT_TRUE(offset > 100 && narrow < 1);  // narrower than the coordinates' steps can tell
            continue;
        }
        const double blur = eps * (offset + far + 2);
        ASSERT_NEAR(hit->t, far, 64 * blur / incidence / static_cast<double>(area));
        const SurfacePoint point = mesh.surface(0, ray.at(hit->t));
        ASSERT_LE(off(exact(point.position)), point.error);
        ASSERT_NEAR(length(point.normal), 1, 4 * eps);
        ASSERT_NEAR(point.u, u, 64 * blur / incidence / static_cast<double>(area * area));
        ASSERT_TRUE(point.u >= 0 && point.v >= 0 && point.u + point.v <= 1);
    }
}

TEST(Mesh, shading_normals_and_slots) {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, {7}};
    const SurfacePoint point = mesh.surface(0, {0.25, 0.25, 1e-12});
    EXPECT_EQ(point.normal, (Vec3{0, 0, 1}));
    EXPECT_NEAR(point.shading_normal.z, 0.5 / std::sqrt(0.375), 1e-15);
    EXPECT_EQ(point.slot, 7u);
    EXPECT_EQ(point.u, 0.25);
    EXPECT_EQ(point.v, 0.25);
    mesh.normals = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    EXPECT_EQ(mesh.surface(0, {0.25, 0.25, 0}).shading_normal, point.normal);
}

// A comb (not convex) with a square hole, in any plane.
TEST(Polygon, not_convex_with_hole) {
    const std::vector<std::pair<double, double>> outline{{0, 0}, {6, 0}, {6, 4}, {5, 4}, {5, 2}, {4, 2}, {4, 4}, {0, 4}};
    const std::vector<std::pair<double, double>> hole{{1, 1}, {1, 3}, {3, 3}, {3, 1}};
    const auto inside = [](double x, double y) {
        const bool outer = x > 0 && x < 6 && y > 0 && y < 4 && !(x > 4 && x < 5 && y > 2);
        return outer && !(x > 1 && x < 3 && y > 1 && y < 3);
    };
    Random random(11);
    for (int round = 0; round < 50; ++round) {
        const Vec3 n = random.direction(), e = perpendicular(n), f = cross(n, e), o = random.inside_cube() * (round % 2 ? 1e6 : 1.0);
        Polygon polygon;
        for (const auto* loop : {&outline, &hole}) {
            auto& points = polygon.loops.emplace_back();
            for (const auto& [x, y] : *loop) points.push_back(o + e * x + f * y);
        }
        // The plane that the rounded points mean.
        const auto& first = polygon.loops[0];
        const auto from_first = [&](Vec3 p) {
            return Exact{(long double)p.x - first[0].x, (long double)p.y - first[0].y, (long double)p.z - first[0].z};
        };
        Exact m{0, 0, 0};
        for (std::size_t k = 2; k < first.size(); ++k) {
            const Exact a = from_first(first[k - 1]), b = from_first(first[k]);
            m = {m.x + a.y * b.z - a.z * b.y, m.y + a.z * b.x - a.x * b.z, m.z + a.x * b.y - a.y * b.x};
        }
        const auto off = [&](Vec3 p) {
            const Exact q = from_first(p);
            return std::abs(q.x * m.x + q.y * m.y + q.z * m.z) / std::hypot(m.x, m.y, m.z);
        };
        const double blur = eps * (length(o) + 20);
        for (int i = 0; i < 2000; ++i) {
            const double x = random.between(-1, 7), y = random.between(-1, 5);
            const Vec3 target = o + e * x + f * y, d = random.direction();
            if (std::abs(dot(d, n)) < 0.05) continue;
            const double near_line = std::min({std::abs(x - std::round(x)), std::abs(y - std::round(y))});
            if (near_line < 100 * blur / std::abs(dot(d, n))) continue;
            const Ray ray{target - d * 10.0, d};
            const auto hit = polygon.intersect(0, ray);
            ASSERT_EQ(hit.has_value(), inside(x, y)) << x << ' ' << y;
            if (!hit) continue;
            ASSERT_NEAR(hit->t, 10, 100 * blur / std::abs(dot(d, n)));
            const SurfacePoint point = polygon.surface(0, ray.at(hit->t));
            ASSERT_LE(off(point.position), point.error);
            ASSERT_NEAR(point.u, x, 1e3 * blur);
            ASSERT_NEAR(point.v, y, 1e3 * blur);
            ASSERT_NEAR(dot(point.normal, n), 1, 1e-7);
            ASSERT_LE(length(point.position - target), 200 * blur / std::abs(dot(d, n)));
        }
    }
}

// A plane tiled by squares, hit exactly on edges and corners from above and askew: one tile each.
TEST(Polygon, tiles_share_their_edges) {
    std::vector<Polygon> tiles;
    for (int x = 0; x < 4; ++x) {
        for (int z = 0; z < 4; ++z) {
            const double a = x * 0.25, b = z * 0.25;
            tiles.push_back({{{{a, 0, b}, {a, 0, b + 0.25}, {a + 0.25, 0, b + 0.25}, {a + 0.25, 0, b}}}});
        }
    }
    Random random(12);
    for (int i = 0; i < 20000; ++i) {
        const Vec3 target{(1 + random.bits() % 3) * 0.25, 0, i % 2 ? (1 + random.bits() % 3) * 0.25 : random.between(0.01, 0.99)};
        Ray ray{{target.x, 1, target.z}, {0, -1, 0}};
        if (i % 4 > 1) {
            ray.origin = Vec3{0.5, 2, 0.5} + random.inside_cube();
            ray.direction = target - ray.origin;
        }
        int count = 0;
        for (const Polygon& tile : tiles) count += tile.intersect(0, ray).has_value();
        ASSERT_EQ(count, 1);
    }
}

TEST(Polygon, degenerate_ones_are_never_hit) {
    const Polygon none{}, empty{{{}}}, line{{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}}}, two{{{{0, 0, 0}, {1, 1, 0}}}};
    for (const Polygon* polygon : {&none, &empty, &line, &two}) {
        check_hostile_rays(*polygon);
        Random random(13);
        for (int i = 0; i < 1000; ++i) {
            const Vec3 o = random.inside_cube() * 3;
            ASSERT_FALSE(polygon->intersect(0, Ray{o, Vec3{random.between(0, 1), 0, 0} - o}));
        }
    }
    EXPECT_TRUE(none.bounds().empty());
}

}  // namespace
}  // namespace crescente::geometry::test
