#include "io/stl.h"

#include "reader_check.h"
#include "scene/validate.h"

namespace crescente::io {
namespace {

std::string stl_text(double size) {
    const std::string s = std::to_string(size);
    const auto facet = [](const std::string& a, const std::string& b, const std::string& c) {
        return "facet normal 0 0 0\nouter loop\nvertex " + a + "\nvertex " + b + "\nvertex " + c + "\nendloop\nendfacet\n";
    };
    return "solid corner\n" + facet("0 0 0", "0 " + s + " 0", s + " 0 0") + facet("0 0 0", s + " 0 0", "0 0 " + s) +
           facet("0 0 0", "0 0 " + s, "0 " + s + " 0") + "endsolid corner\n";
}

// Header, count, facets of 50 bytes.
std::string binary(const std::vector<std::array<float, 9>>& facets, const std::string& title = "title") {
    std::string bytes = title + std::string(80 - title.size(), ' ');
    const auto count = static_cast<std::uint32_t>(facets.size());
    bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
    for (const auto& facet : facets) {
        bytes.append(12, '\0');
        bytes.append(reinterpret_cast<const char*>(facet.data()), sizeof facet);
        bytes.append(2, '\0');
    }
    return bytes;
}

// Counts in the binary headers: 24,696, 13,506 and 984; "facet" lines of hinge.stl: 1,212.
TEST(Stl, TheSharedModelsHaveTheirTriangles) {
    REQUIRE_ASSET("mesh/motor.stl");
    struct Known {
        const char* file;
        std::size_t triangles, dropped;
    };
    for (const Known& known : {Known{"mesh/bearing.stl", 24680, 16}, Known{"mesh/motor.stl", 13500, 6}, Known{"mesh/low_poly_benchy.stl", 980, 4},
                               Known{"mesh/hinge.stl", 1212, 0}}) {
        const auto loaded = read_stl_file(asset(known.file));
        ASSERT_TRUE(loaded) << loaded.error().text();
        EXPECT_EQ(triangles_in(loaded->scene), known.triangles) << known.file;
        EXPECT_EQ(warns_of(*loaded, std::to_string(known.dropped) + " triangles have no area"), known.dropped > 0) << known.file;
        EXPECT_TRUE(scene::validate(loaded->scene, known.file).empty()) << known.file;
    }
}

TEST(Stl, MillimetresWithZUp) {
    const auto loaded = read_stl(stl_text(30), "corner.stl");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(loaded->scene.unit.name, "mm");
    EXPECT_EQ(loaded->scene.unit.metres, 0.001);
    const math::Bounds box = bounds(loaded->scene);  // z of the file is y here, y is -z
    EXPECT_NEAR(box.lower.z, -0.03, 1e-9);
    EXPECT_NEAR(box.upper.z, 0, 1e-9);
    EXPECT_NEAR(box.upper.y, 0.03, 1e-9);
    EXPECT_NEAR(box.upper.x, 0.03, 1e-9);
}

TEST(Stl, WeldedCornersStaySharpBeyondTheCreaseAngle) {
    const auto loaded = read_stl(stl_text(1), "corner.stl");
    ASSERT_TRUE(loaded) << loaded.error().text();
    const auto& mesh = std::get<geometry::Mesh>(loaded->scene.shapes.at(0).shape);
    EXPECT_EQ(mesh.positions.size(), 4u);
    for (std::uint32_t t = 0; t < 3; ++t) {
        const auto& triangle = mesh.triangles[t];
        const math::Vec3 centre = (mesh.positions[triangle[0]] + mesh.positions[triangle[1]] + mesh.positions[triangle[2]]) / 3;
        const auto point = mesh.surface(t, centre);
        EXPECT_NEAR(dot(point.normal, point.shading_normal), 1, 1e-6);  // faces at right angles
    }
}

TEST(Stl, CoordinatesThatAreNoNumbersAreAnError) {
    const float nan = std::nanf("");
    const auto loaded = read_stl(binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 0, 0, nan, 0, 0, 0, 1, 0}}), "broken.stl");
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, ErrorKind::input);
    EXPECT_TRUE(tells(loaded.error(), "not finite")) << loaded.error().text();
}

TEST(Stl, ABinaryFileMayBeginWithSolid) {
    const auto loaded = read_stl(binary({{0, 0, 0, 1, 0, 0, 0, 1, 0}}, "solid but binary"), "a.stl");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(triangles_in(loaded->scene), 1u);
}

TEST(Stl, WhatIsWrongIsToldWithItsLine) {
    const auto loaded = read_stl("solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 x\nendloop\nendfacet\nvortex\nendsolid\n", "a.stl");
    ASSERT_FALSE(loaded);
    EXPECT_TRUE(tells(loaded.error(), "line 5: a vertex needs three finite numbers")) << loaded.error().text();
    EXPECT_TRUE(tells(loaded.error(), "line 6: a facet has 2 vertices")) << loaded.error().text();
    EXPECT_TRUE(tells(loaded.error(), "line 8: unexpected 'vortex'")) << loaded.error().text();
}

TEST(Stl, AFileCutAnywhereIsAnError) {
    REQUIRE_ASSET("mesh/hinge.stl");
    for (const char* name : {"mesh/low_poly_benchy.stl", "mesh/hinge.stl"}) {
        const std::string whole = bytes_of(asset(name));
        const std::size_t matter = whole.find_last_not_of(" \r\n") - 20;  // the last line of text may lose its end
        for_each_cut(whole, 300, [&](const std::string& bytes) { return read_stl(bytes, name); },
                     [&](std::size_t length, const Expected<Loaded>& cut) {
                         if (length > matter) return;
                         ASSERT_FALSE(cut) << name << " at " << length;
                         EXPECT_EQ(cut.error().kind, ErrorKind::input) << name << " at " << length;
                     });
    }
}

}  // namespace
}  // namespace crescente::io
