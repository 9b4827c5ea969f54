#include "io/ply.h"

#include <cstring>

#include "reader_check.h"
#include "scene/validate.h"

namespace crescente::io {
namespace {

// "element face" in the headers: 3,732 and 5,804, all triangles.
TEST(Ply, TheSharedModelsHaveTheirTriangles) {
    REQUIRE_ASSET("mesh/cow.ply");
    for (const auto& [name, triangles] : {std::pair{"mesh/Wuson.ply", 3732u}, std::pair{"mesh/cow.ply", 5804u}}) {
        const auto loaded = read_ply_file(asset(name));
        ASSERT_TRUE(loaded) << loaded.error().text();
        EXPECT_EQ(triangles_in(loaded->scene), triangles) << name;
        EXPECT_EQ(warns_of(*loaded, "line 3: unexpected 'Created'"), std::string(name) == "mesh/Wuson.ply");  // a comment that is none
        EXPECT_TRUE(scene::validate(loaded->scene, name).empty()) << name;
    }
}

TEST(Ply, VertexColoursStandInWhereThereIsNoMaterial) {
    const std::string ply = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
                            "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 1\nproperty list uchar int vertex_indices\n"
                            "end_header\n0 0 0 255 0 0\n1 0 0 255 0 0\n0 1 0 255 0 255\n3 0 1 2\n";
    const auto loaded = read_ply(ply, "colours.ply");
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_EQ(loaded->scene.materials.size(), 1u);
    EXPECT_NEAR(std::get<scene::PhysicalMaterial>(loaded->scene.materials[0].model).base_color.r, 1, 1e-6);
    EXPECT_NEAR(std::get<scene::PhysicalMaterial>(loaded->scene.materials[0].model).base_color.g, 0, 1e-6);
    EXPECT_NEAR(std::get<scene::PhysicalMaterial>(loaded->scene.materials[0].model).base_color.b, 1.0 / 3, 1e-6);
}

template <class T>
void put(std::string& to, T value, bool swapped) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (swapped) std::reverse(bytes, bytes + sizeof(T));
    to.append(bytes, sizeof(T));
}

// A quadrilateral with normals, an unused list and an unused element, in either byte order.
std::string binary(bool swapped) {
    std::string ply = std::string("ply\nformat binary_") + (swapped ? "big" : "little") +
                      "_endian 1.0\ncomment made here\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\nproperty float nx\n"
                      "property float ny\nproperty float nz\nproperty list uchar short links\nelement edge 1\nproperty int a\nelement face 1\n"
                      "property list uint ushort vertex_index\nproperty uchar flags\nend_header\n";
    const double corners[4][3] = {{0, 0, 0}, {1e6 + 1e-9, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    for (const auto& corner : corners) {
        for (const double v : corner) put(ply, v, swapped);
        for (const float v : {0.0f, 0.0f, 2.0f}) put(ply, v, swapped);
        put(ply, std::uint8_t{1}, swapped);
        put(ply, std::int16_t{7}, swapped);
    }
    put(ply, std::int32_t{5}, swapped);
    put(ply, std::uint32_t{4}, swapped);
    for (const std::uint16_t i : {0, 1, 2, 3}) put(ply, i, swapped);
    put(ply, std::uint8_t{0}, swapped);
    return ply;
}

TEST(Ply, BinaryOfEitherByteOrder) {
    for (const bool swapped : {false, true}) {
        const auto loaded = read_ply(binary(swapped), "a.ply");
        ASSERT_TRUE(loaded) << loaded.error().text();
        const auto& mesh = std::get<geometry::Mesh>(loaded->scene.shapes.at(0).shape);
        EXPECT_EQ(mesh.triangles.size(), 2u);
        EXPECT_EQ(mesh.positions.at(1).x, 1e6 + 1e-9);  // in double, as the file has it
        ASSERT_FALSE(mesh.normals.empty());
        EXPECT_EQ(mesh.normals[0], (std::array<float, 3>{0, 0, 1}));
        EXPECT_NEAR(bounds(loaded->scene).upper.x, 1e6, 1e-6);
        EXPECT_NEAR(bounds(loaded->scene).lower.z, -1, 1e-12);  // the file's y, z being up there
    }
}

TEST(Ply, FacesThatAreNotConvexStayPolygons) {
    const auto loaded = read_ply("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
                                 "property list uchar int vertex_indices\nend_header\n0 0 0\n2 0 0\n0.5 0.5 0\n0 2 0\n4 0 1 2 3\n2 0 1\n", "dart.ply");
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_EQ(loaded->scene.shapes.size(), 1u);
    EXPECT_EQ(std::get<geometry::Polygon>(loaded->scene.shapes[0].shape).loops.at(0).size(), 4u);
    EXPECT_TRUE(warns_of(*loaded, "1 faces have less than three vertices"));
}

TEST(Ply, WhatIsWrongIsTold) {
    const std::string vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const auto fails = [](const std::string& text, const std::string& words) {
        const auto loaded = read_ply(text, "a.ply");
        ASSERT_FALSE(loaded) << text;
        EXPECT_EQ(loaded.error().kind, ErrorKind::input);
        EXPECT_TRUE(tells(loaded.error(), words)) << loaded.error().text();
    };
    const std::string ascii = "ply\nformat ascii 1.0\n";
    fails("plyx\n", "line 1: this is not PLY");
    fails("ply\nelemnt vertex 3\n", "line 2: unexpected 'elemnt' (did you mean 'element'?)");
    fails("ply\nformat asci 1.0\nend_header\n", "line 2: the format must be");
    fails(ascii + "element vertex 3\nproperty flot x\nend_header\n", "line 4: a property has no type that PLY knows");
    fails(ascii + "element vertex 3\nproperty float x\nend_header\n1\n2\n3\n", "the vertices have no x, y and z");
    fails(ascii + vertices + faces + "0 0 0\n1 0 0\n0 1 nan\n3 0 1 2\n", "line 12: 'nan' is not a finite number");
    fails(ascii + vertices + faces + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "face 0: has a vertex that is not there");
    fails(ascii + vertices + faces + "0 0 0\n1 0 0\n0 1 0\n200 0 1 2\n", "a list is longer than the rest of the file");
    fails(ascii + "element vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nend_header\n0 0 0\n", "promises more");
    fails(ascii + "element vertex 4000000000\nend_header\n", "promises more");
}

TEST(Ply, AFileCutAnywhereIsAnError) {
    for (const bool swapped : {false, true}) {
        const std::string whole = binary(swapped);
        for_each_cut(whole, whole.size(), [](const std::string& bytes) { return read_ply(bytes, "a.ply"); },
                     [](std::size_t length, const Expected<Loaded>& cut) {
                         ASSERT_FALSE(cut) << length;
                         EXPECT_EQ(cut.error().kind, ErrorKind::input) << length;
                     });
    }
    REQUIRE_ASSET("mesh/cow.ply");
    const std::string whole = bytes_of(asset("mesh/cow.ply"));
    for_each_cut(whole, 300, [](const std::string& bytes) { return read_ply(bytes, "cow.ply"); },
                 [&](std::size_t length, const Expected<Loaded>& cut) {
                     if (length + 8 > whole.size()) return;  // the last index may be read from its first digits
                     ASSERT_FALSE(cut) << length;
                     EXPECT_EQ(cut.error().kind, ErrorKind::input) << length;
                 });
}

}  // namespace
}  // namespace crescente::io
