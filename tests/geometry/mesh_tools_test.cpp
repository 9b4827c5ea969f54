// Repair, welding and smooth normals.
#include <gtest/gtest.h>

#include <limits>

#include "geometry/mesh_normals.h"
#include "geometry/mesh_repair.h"

namespace crescente::geometry {
namespace {

using Triangle = std::array<std::uint32_t, 3>;
using Normal = std::array<float, 3>;

TEST(MeshRepair, counts_each_reason_and_keeps_the_rest) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {nan, 0, 0}, {0, 0, std::numeric_limits<double>::infinity()}};
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 9}, {0, 1, 5}, {1, 1, 2}, {2, 1, 0}};
    mesh.slots = {1, 2, 3, 4, 5, 6, 7};
    for (int i = 0; i < 21; ++i) mesh.normals.push_back({0, 0, static_cast<float>(i)});
    const MeshRepair found = repair(mesh);
    EXPECT_EQ(found.zero_area, 2u);
    EXPECT_EQ(found.not_finite, 2u);
    EXPECT_EQ(found.out_of_range, 1u);
    EXPECT_EQ(found.triangles(), 5u);
    EXPECT_FALSE(found.normals_dropped || found.slots_dropped);
    EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 0}}));
    EXPECT_EQ(mesh.slots, (std::vector<std::uint16_t>{1, 7}));
    ASSERT_EQ(mesh.normals.size(), 6u);
    EXPECT_EQ(mesh.normals[3][2], 18);
    EXPECT_EQ(repair(mesh).triangles(), 0u);
}

TEST(MeshRepair, drops_what_does_not_fit) {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2}}, {{0, 0, 1}}, {1, 2}};
    const MeshRepair found = repair(mesh);
    EXPECT_TRUE(found.normals_dropped && found.slots_dropped);
    EXPECT_TRUE(mesh.normals.empty() && mesh.slots.empty());
    mesh.normals.assign(4, {0, 0, std::numeric_limits<float>::quiet_NaN()});
    EXPECT_TRUE(repair(mesh).normals_dropped);
}

// Normals by position must not be taken for normals by corner when the number of triangles shrinks to fit.
TEST(MeshRepair, keeps_the_layout_of_normals_apart) {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{1, 2, 0}, {0, 0, 1}}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {}};
    repair(mesh);
    EXPECT_EQ(mesh.normals, (std::vector<Normal>{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}));
}

// The soup of a cube, as an STL file has it: three positions of its own for each triangle.
Mesh cube_soup() {
    const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    Mesh mesh;
    const auto add = [&](int a, int b, int c) {
        const auto base = static_cast<std::uint32_t>(mesh.positions.size());
        for (const int k : {a, b, c}) mesh.positions.push_back({k & 1 ? 1.0 : -0.0, k & 2 ? 1.0 : 0.0, k & 4 ? 1.0 : 0.0});
        mesh.triangles.push_back({base, base + 1, base + 2});
    };
    for (const auto& f : faces) add(f[0], f[1], f[2]), add(f[0], f[2], f[3]);
    return mesh;
}

TEST(MeshNormals, weld_shares_equal_positions) {
    Mesh mesh = cube_soup();
    mesh.positions[5].x = mesh.positions[5].x == 0 ? 0.0 : mesh.positions[5].x;  // 0 beside -0
    mesh.positions.push_back({9, 9, 9});                                         // unused
    const Mesh before = mesh;
    weld_vertices(mesh);
    ASSERT_EQ(mesh.positions.size(), 8u);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (int k = 0; k < 3; ++k) EXPECT_EQ(mesh.positions[mesh.triangles[i][k]], before.positions[before.triangles[i][k]]);
    }
}

TEST(MeshNormals, sharp_cube_and_smooth_cube) {
    Mesh mesh = cube_soup();
    weld_vertices(mesh);
    smooth_normals(mesh, 30 * pi / 180);
    ASSERT_EQ(mesh.normals.size(), 36u);
    for (std::size_t c = 0; c < 36; ++c) {
        const auto& t = mesh.triangles[c / 3];
        const Vec3 n = normalize(cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]));
        EXPECT_EQ(mesh.normals[c], (Normal{float(n.x), float(n.y), float(n.z)}));
    }
    smooth_normals(mesh, pi / 2);  // 90 degrees are within a limit of 90 degrees
    ASSERT_EQ(mesh.normals.size(), 8u);
    for (std::size_t i = 0; i < 8; ++i) {
        const Vec3 n = normalize(mesh.positions[i] - Vec3{0.5, 0.5, 0.5});  // weighted by angles, the diagonals do not show
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(mesh.normals[i][k], n[k], 1e-6);
    }
}

TEST(MeshNormals, contrary_and_crowded_edges_are_sharp) {
    Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 1, 3}}, {}, {}};  // the second faces the other way
    smooth_normals(mesh, pi);
    ASSERT_EQ(mesh.normals.size(), 6u);
    EXPECT_EQ(mesh.normals[0], (Normal{0, 0, 1}));
    EXPECT_EQ(mesh.normals[3], (Normal{0, 0, -1}));
    Mesh empty;
    weld_vertices(empty);
    smooth_normals(empty, 1);
    EXPECT_TRUE(empty.normals.empty());
}

}  // namespace
}  // namespace crescente::geometry
