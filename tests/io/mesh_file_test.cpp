#include "io/mesh_file.h"

#include "reader_check.h"
#include "scene/validate.h"

namespace crescente::io {
namespace {

bool without_assimp() {
    const auto probe = read_mesh("", "probe.obj", ".");
    return !probe && probe.error().kind == ErrorKind::unsupported;
}

#define REQUIRE_ASSIMP \
    if (without_assimp()) GTEST_SKIP() << "this build is without Assimp"

const scene::PhysicalMaterial& physical(const scene::Scene& scene, std::size_t i) {
    return std::get<scene::PhysicalMaterial>(scene.materials.at(i).model);
}

TEST(MeshFile, CubesOfObjHaveNodesAndMaterials) {
    REQUIRE_ASSIMP;
    REQUIRE_ASSET("mesh/hundred_cubes.obj");
    const auto loaded = read_mesh_file(asset("mesh/hundred_cubes.obj"));
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(loaded->scene.shapes.size(), 100u);
    EXPECT_EQ(appearances_in(loaded->scene), 100u);
    EXPECT_EQ(triangles_in(loaded->scene), 1200u);
    ASSERT_EQ(loaded->scene.materials.size(), 3u);
    EXPECT_EQ(loaded->scene.materials[0].name, "Red");
    EXPECT_EQ(physical(loaded->scene, 0).base_color, (math::Rgb{0.8f, 0.2f, 0.2f}));
    EXPECT_TRUE(loaded->warnings.empty());
    // The same without its material library.
    const auto alone = read_mesh(bytes_of(asset("mesh/hundred_cubes.obj")), "cubes.obj", "/nowhere");
    ASSERT_TRUE(alone) << alone.error().text();
    EXPECT_TRUE(warns_of(*alone, "'hundred_cubes.mtl'"));
}

TEST(MeshFile, MtlBecomesPhysical) {
    REQUIRE_ASSIMP;
    const auto folder = std::filesystem::path(testing::TempDir()) / "crescente_mtl";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "looks.mtl") << "newmtl glass\nKd 0.9 0.9 1\nKs 1 1 1\nNs 1000\nd 0.25\nNi 1.45\nillum 7\n"
                                           "newmtl steel\nKd 0 0 0\nKs 0.6 0.6 0.65\nNs 100\nillum 3\n"
                                           "newmtl veil\nKd 0.5 0.5 0.4\nd 0.5\nillum 2\n"
                                           "newmtl lamp\nKd 0 0 0\nKe 5 4 3\n";
    const std::string obj = "mtllib looks.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\no a\nusemtl glass\nf 1 2 3\no b\nusemtl steel\nf 1 2 4\n"
                            "o c\nusemtl veil\nf 1 3 4\no d\nusemtl lamp\nf 2 3 4\n";
    const auto loaded = read_mesh(obj, "looks.obj", folder);
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_EQ(loaded->scene.materials.size(), 4u);
    EXPECT_NEAR(physical(loaded->scene, 0).transmission, 0.75, 1e-6);
    EXPECT_NEAR(physical(loaded->scene, 0).ior, 1.45, 1e-6);
    EXPECT_EQ(physical(loaded->scene, 0).opacity, 1);
    EXPECT_LT(physical(loaded->scene, 0).roughness, 0.25);
    EXPECT_EQ(physical(loaded->scene, 1).metallic, 1);
    EXPECT_EQ(physical(loaded->scene, 1).base_color, (math::Rgb{0.6f, 0.6f, 0.65f}));
    EXPECT_NEAR(physical(loaded->scene, 2).opacity, 0.5, 1e-6);
    EXPECT_EQ(physical(loaded->scene, 2).transmission, 0);
    EXPECT_EQ(physical(loaded->scene, 2).roughness, 1);
    EXPECT_EQ(physical(loaded->scene, 3).emissive, (math::Rgb{5, 4, 3}));
}

// What a normal map bends, it bends along tangents that are smooth across triangles: files of this kind repeat a vertex for each of its corners.
TEST(MeshFile, NormalMapsGetSmoothTangents) {
    REQUIRE_ASSIMP;
    const auto folder = std::filesystem::path(testing::TempDir()) / "crescente_tangents";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "a.mtl") << "newmtl bent\nKd 1 1 1\nnorm bumps.png\nnewmtl plain\nKd 1 1 1\nmap_Kd bumps.png\n";
    const std::string obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 2 0 1\nv 0 1 0\nv 1 1 0\nv 2 1 1\nvt 0 0\nvt 0.5 0\nvt 1 0\nvt 0 1\nvt 0.5 1\nvt 1 1\n"
                            "vn 0 0 1\nvn -0.4 0 0.9\nvn -0.7 0 0.7\n";
    const std::string faces = "f 1/1/1 2/2/2 5/5/2 4/4/1\nf 2/2/2 3/3/3 6/6/3 5/5/2\n";
    const auto loaded = read_mesh(obj + "o a\nusemtl bent\n" + faces + "o b\nusemtl plain\n" + faces, "a.obj", folder);
    ASSERT_TRUE(loaded) << loaded.error().text();
    std::size_t with = 0, without = 0;
    for (const auto& shape : loaded->scene.shapes) {
        const auto& mesh = std::get<geometry::Mesh>(shape.shape);
        if (mesh.tangents.empty()) {
            ++without;
            continue;
        }
        ++with;
        ASSERT_EQ(mesh.tangents.size(), mesh.positions.size());
        EXPECT_EQ(mesh.positions.size(), 6u) << "corners that are alike are one";
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            const auto& t = mesh.tangents[i];
            const math::Vec3 tangent{t[0], t[1], t[2]}, normal{mesh.normals[i][0], mesh.normals[i][1], mesh.normals[i][2]};
            EXPECT_NEAR(length(tangent), 1, 1e-5);
            EXPECT_NEAR(dot(tangent, normal), 0, 1e-5);
            EXPECT_NEAR(t[1], 0, 1e-5);
            EXPECT_GT(t[0], 0.5);
            EXPECT_EQ(t[3], 1);
        }
    }
    EXPECT_EQ(with, 1u);
    EXPECT_EQ(without, 1u);
}

TEST(MeshFile, FilesElsewhereAreNotRead) {
    REQUIRE_ASSIMP;
    const auto folder = std::filesystem::path(testing::TempDir()) / "crescente_inside";
    std::filesystem::create_directories(folder / "model");
    std::ofstream(folder / "secret.mtl") << "newmtl red\nKd 1 0 0\n";
    const std::string obj = "mtllib ../secret.mtl\nusemtl red\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const auto loaded = read_mesh(obj, "a.obj", folder / "model");
    std::filesystem::remove_all(folder);
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_TRUE(warns_of(*loaded, "secret.mtl"));
    for (const auto& material : loaded->scene.materials) {
        EXPECT_NE(std::get<scene::PhysicalMaterial>(material.model).base_color, (math::Rgb{1, 0, 0}));
    }
}

TEST(MeshFile, NoTrianglesNoScene) {
    REQUIRE_ASSIMP;
    for (const char* name : {"a.obj", "a.off", "a.dae", "a.fbx", "a.3ds", "a.3mf", "a.amf", "a.x3d", "a.ac", "a.lwo", "a.x", "a.dxf"}) {
        for (const std::string& text : {std::string{}, std::string("nothing of the kind\n"), std::string(200, '\0')}) {
            const auto loaded = read_mesh(text, name, ".");
            ASSERT_FALSE(loaded) << name;
            EXPECT_EQ(loaded.error().kind, ErrorKind::input) << name;
        }
    }
}

// A cut text can be whole as far as its format is concerned.
TEST(MeshFile, AFileCutAnywhereIsAnErrorOrASmallerScene) {
    REQUIRE_ASSIMP;
    REQUIRE_ASSET("mesh/hundred_cubes.obj");
    const std::string whole = bytes_of(asset("mesh/hundred_cubes.obj"));
    std::size_t errors = 0;
    for_each_cut(whole, 300, [&](const std::string& bytes) { return read_mesh(bytes, "cubes.obj", asset("mesh")); },
                 [&](std::size_t length, const Expected<Loaded>& cut) {
                     if (cut) {
                         EXPECT_LE(triangles_in(cut->scene), 1200u) << length;
                         return;
                     }
                     ++errors;
                     EXPECT_EQ(cut.error().kind, ErrorKind::input) << length;
                 });
    EXPECT_GT(errors, 0u);
}

}  // namespace
}  // namespace crescente::io
