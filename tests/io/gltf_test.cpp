#include "io/gltf.h"

#if __has_include(<draco/compression/encode.h>)
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#endif

#include "gltf_made.h"
#include "io/gltf_draco.h"
#include "scene/validate.h"

namespace crescente::io {
namespace {

struct Known {
    const char* file;
    std::size_t triangles, dropped, shapes, appearances;
};

// Triangles as declared by the accessors, found by an independent count; 10,419 of the engine's have corners on one line.
TEST(Gltf, TheSharedModelsHaveTheirTriangles) {
    REQUIRE_ASSET("gltf/Fox.glb");
    for (const Known& known : {
             Known{"2CylinderEngine.glb", 75730 - 10419, 10419, 29, 67}, Known{"AnisotropyDiscTest.glb", 2788, 0, 12, 12},
             Known{"AnisotropyStrengthTest.glb", 97240, 0, 50, 50}, Known{"AttenuationTest.glb", 232, 0, 18, 23},
             Known{"ClearCoatTest.glb", 37116, 0, 27, 27}, Known{"DispersionTest.glb", 51827, 0, 27, 27}, Known{"Fox.glb", 576, 0, 1, 1},
             Known{"Lights.glb", 12, 0, 1, 1}, Known{"NormalTangentTest.glb", 7774, 0, 1, 1},
             Known{"PrimitiveModeNormalsTest.glb", 2562, 0, 9, 9}, Known{"SimpleInstancing.glb", 12, 0, 1, 125},
             Known{"SpecularTest.glb", 44828, 0, 24, 24}, Known{"SunglassesKhronos.glb", 13396, 0, 8, 8},
             Known{"TransmissionRoughnessTest.glb", 77792, 0, 9, 9}, Known{"geometry-camera-light.glb", 14, 0, 2, 2},
             Known{"FlightHelmet/FlightHelmet.gltf", 94722, 0, 6, 6}}) {
        const auto loaded = read_scene(asset(std::string("gltf/") + known.file));
        ASSERT_TRUE(loaded) << loaded.error().text();
        EXPECT_EQ(triangles_in(loaded->scene), known.triangles) << known.file;
        EXPECT_EQ(warns_of(*loaded, std::to_string(known.dropped) + " triangles have no area"), known.dropped > 0) << known.file;
        EXPECT_EQ(loaded->scene.shapes.size(), known.shapes) << known.file;
        EXPECT_EQ(appearances_in(loaded->scene), known.appearances) << known.file;
        EXPECT_TRUE(scene::validate(loaded->scene, known.file).empty()) << known.file;
        for (const Problem& warning : loaded->warnings) EXPECT_EQ(warning.reason.find("textures"), std::string::npos) << known.file << ": " << warning.reason;
    }
}

TEST(Gltf, LightsOfTheSharedModel) {
    REQUIRE_ASSET("gltf/Lights.glb");
    const auto loaded = read_gltf_file(asset("gltf/Lights.glb"));
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_EQ(loaded->scene.lights.size(), 4u);
    const auto named = [&](const std::string& name) {
        for (const auto& light : loaded->scene.lights) {
            if (light.name == name) return light;
        }
        ADD_FAILURE() << name;
        return scene::Light{};
    };
    const scene::Light point = named("Light"), spot = named("Spot"), sun = named("Sun");
    EXPECT_EQ(point.color, (math::Rgb{1, 0, 0}));
    EXPECT_EQ(point.intensity, 5);
    EXPECT_EQ(point.outer_angle, math::pi);
    EXPECT_EQ(point.falloff, scene::Falloff::inverse_square);
    EXPECT_EQ(spot.kind, scene::LightKind::point);
    EXPECT_DOUBLE_EQ(spot.inner_angle, 0.3337942263919169);
    EXPECT_DOUBLE_EQ(spot.outer_angle, 0.39269909262657166);
    EXPECT_NEAR(length(spot.direction - math::Vec3{0, -1, 0}), 0, 1e-6);  // along -z of a node turned about x
    EXPECT_NEAR(spot.position.y, 1.9432672262191772, 1e-12);
    EXPECT_EQ(sun.kind, scene::LightKind::directional);
    EXPECT_TRUE(loaded->scene.camera);
}

TEST(Gltf, TexturesOfTheSharedModels) {
    REQUIRE_ASSET("gltf/Fox.glb");
    const auto loaded = read_scene(asset("gltf/Fox.glb"));
    ASSERT_TRUE(loaded) << loaded.error().text();
    if (warns_of(*loaded, "this build has no OpenImageIO")) GTEST_SKIP() << "this build decodes no pictures";
    const scene::Texture& fur = texture(loaded->scene.materials[0], "base_color");
    ASSERT_TRUE(fur.image && fur.image->decoded());
    const scene::Rgba mean = fur.image->texel(fur.image->level_count() - 1, 0, 0);  // an orange
    EXPECT_GT(mean.r, 1.5f * mean.g);
    EXPECT_GT(mean.g, 1.5f * mean.b);
    EXPECT_EQ(std::get<geometry::Mesh>(loaded->scene.shapes[0].shape).coordinates[0].size(), std::get<geometry::Mesh>(loaded->scene.shapes[0].shape).positions.size());

    const auto helmet = read_scene(asset("gltf/FlightHelmet/FlightHelmet.gltf"));
    ASSERT_TRUE(helmet) << helmet.error().text();
    for (const scene::Material& m : helmet->scene.materials) {
        if (m.name.empty()) continue;
        EXPECT_EQ(texture(m, "roughness").image, texture(m, "metallic").image) << "one picture, decoded once";
        EXPECT_EQ(texture(m, "roughness").channel, scene::Channel::green);
        EXPECT_EQ(texture(m, "metallic").channel, scene::Channel::blue);
        EXPECT_TRUE(texture(m, "normal").image->decoded());
    }
    EXPECT_TRUE(warns_of(*loaded, "3 animations"));
    EXPECT_TRUE(warns_of(*loaded, "1 nodes have skins"));
}

TEST(Gltf, TrianglesStripsAndFans) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    made.accessor(std::vector<std::uint8_t>{0, 1, 2, 0, 2, 3}, 5121, "SCALAR", 1);
    made.accessor(std::vector<std::uint16_t>{0, 1, 3, 2}, 5123, "SCALAR", 1);
    made.accessor(std::vector<std::uint32_t>{0, 1, 2, 3}, 5125, "SCALAR", 1);
    for (const char* how : {R"("indices":1)", R"("indices":2,"mode":5)", R"("indices":3,"mode":6)"}) {
        const auto loaded = read(made.glb(mesh_with(R"({"attributes":{"POSITION":0},)" + std::string(how) + "}")));
        ASSERT_TRUE(loaded) << loaded.error().text();
        const auto& mesh = std::get<geometry::Mesh>(loaded->scene.shapes.at(0).shape);
        ASSERT_EQ(mesh.triangles.size(), 2u) << how;
        EXPECT_EQ(mesh.positions.size(), 4u) << how;
        EXPECT_TRUE(mesh.normals.empty());
        for (std::uint32_t t = 0; t < 2; ++t) {  // all seen from the same side
            EXPECT_EQ(mesh.surface(t, mesh.positions[mesh.triangles[t][0]]).normal, (math::Vec3{0, 0, 1})) << how;
        }
    }
}

TEST(Gltf, PointsAndLinesAreToldAndLeftOut) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    const auto loaded = read(made.glb(mesh_with(R"({"attributes":{"POSITION":0},"mode":0},{"attributes":{"POSITION":0},"mode":3},{"attributes":{"POSITION":0},"mode":6})")));
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(triangles_in(loaded->scene), 2u);
    EXPECT_TRUE(warns_of(*loaded, "2 primitives are points or lines"));
}

TEST(Gltf, NormalisedAndQuantisedTypesAndSparseValues) {
    Made made;
    made.accessor(std::vector<std::int16_t>{0, 0, 0, 32767, 0, 0, 0, 32767, 0}, 5122, "VEC3", 3, R"(,"normalized":true)");
    made.accessor(std::vector<std::int8_t>{0, 0, 127, 0, 0, 127, 0, 0, 127}, 5120, "VEC3", 3, R"(,"normalized":true)");
    made.accessor(std::vector<std::uint16_t>{2}, 5123, "SCALAR", 1);
    made.accessor(std::vector<std::int16_t>{0, -32767, 0}, 5122, "VEC3", 3);
    const std::string sparse = R"(,"sparse":{"count":1,"indices":{"bufferView":2,"componentType":5123},"values":{"bufferView":3}})";
    Made with_sparse = made;
    with_sparse.accessors.insert(with_sparse.accessors.find('}'), sparse);
    const auto plain = read(made.glb(mesh_with(R"({"attributes":{"POSITION":0,"NORMAL":1}})")));
    const auto changed = read(with_sparse.glb(mesh_with(R"({"attributes":{"POSITION":0,"NORMAL":1}})")));
    ASSERT_TRUE(plain) << plain.error().text();
    ASSERT_TRUE(changed) << changed.error().text();
    const auto& mesh = std::get<geometry::Mesh>(plain->scene.shapes.at(0).shape);
    EXPECT_EQ(mesh.positions, (std::vector<math::Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.normals.at(0), (std::array<float, 3>{0, 0, 1}));
    EXPECT_EQ(std::get<geometry::Mesh>(changed->scene.shapes.at(0).shape).positions.at(2), (math::Vec3{0, -1, 0}));
}

TEST(Gltf, PrimitivesBecomeSlotsOfOneMesh) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    made.accessor(std::vector<float>{0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 3);
    made.accessor(std::vector<std::uint8_t>{0, 1, 2}, 5121, "SCALAR", 1);
    made.accessor(std::vector<std::uint8_t>{0, 2, 3}, 5121, "SCALAR", 1);
    const auto loaded = read(made.glb(
        R"("materials":[{"name":"a"},{"name":"b"}],)" +
        mesh_with(R"({"attributes":{"POSITION":0,"NORMAL":1},"indices":2,"material":1},{"attributes":{"POSITION":0},"indices":3,"material":0},)"
                  R"({"attributes":{"POSITION":0},"indices":3,"material":1})")));
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_EQ(loaded->scene.shapes.size(), 1u);
    const auto& mesh = std::get<geometry::Mesh>(loaded->scene.shapes[0].shape);
    EXPECT_EQ(mesh.slots, (std::vector<std::uint16_t>{0, 1, 0}));
    EXPECT_EQ(mesh.normals.size(), mesh.positions.size());  // flat primitives got the face's
    const auto& materials = loaded->scene.nodes.at(0).materials;
    ASSERT_EQ(materials.size(), 2u);
    EXPECT_EQ(loaded->scene.materials.at(materials[0].value).name, "b");
    EXPECT_EQ(loaded->scene.materials.at(materials[1].value).name, "a");
}

TEST(Gltf, HierarchyInstancesCameraAndLight) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    const auto loaded = read(made.glb(
        R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"mode":6}]}],"scene":0,"scenes":[{"nodes":[0,3]}],)"
        R"("cameras":[{"type":"perspective","perspective":{"yfov":0.5,"znear":0.25}}],)"
        R"("extensions":{"KHR_lights_punctual":{"lights":[{"type":"spot","intensity":7,"range":9,"spot":{"innerConeAngle":0.1,"outerConeAngle":0.2}}]}},)"
        R"("nodes":[{"translation":[10,0,0],"rotation":[0,0.7071067811865476,0,0.7071067811865476],"children":[1,2]},{"mesh":0,"scale":[2,2,2]},)"
        R"({"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,5,0,1],"camera":0},{"translation":[0,3,0],"extensions":{"KHR_lights_punctual":{"light":0}}}])"));
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(loaded->scene.shapes.size(), 1u);
    std::vector<math::Affine> places;
    scene::for_each_appearance(loaded->scene, [&](auto, const math::Affine& place, const auto&) { places.push_back(place); });
    ASSERT_EQ(places.size(), 2u);
    EXPECT_NEAR(length(places[0].point({1, 0, 0}) - math::Vec3{10, 0, -2}), 0, 1e-12);  // a quarter turn about y
    EXPECT_NEAR(length(places[1].point({0, 0, 0}) - math::Vec3{10, 5, 0}), 0, 1e-12);
    ASSERT_TRUE(loaded->scene.camera);
    EXPECT_EQ(loaded->scene.camera->field_of_view, 0.5);
    EXPECT_EQ(loaded->scene.camera->near, 0.25);
    EXPECT_NEAR(length(loaded->scene.camera->target - loaded->scene.camera->position - math::Vec3{-1, 0, 0}), 0, 1e-12);
    const scene::Light& light = loaded->scene.lights.at(0);
    EXPECT_EQ(light.position, (math::Vec3{0, 3, 0}));
    EXPECT_EQ(light.direction, (math::Vec3{0, 0, -1}));
    EXPECT_EQ(light.range, 9);
}

TEST(Gltf, TexturesWithSamplersTransformsAndAlpha) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    made.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
    made.accessor(std::vector<std::uint8_t>{255, 0, 0, 51, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 0}, 5121, "VEC4", 4, R"(,"normalized":true)");
    const std::string rest =
        R"("images":[{"uri":"data:image/png;base64,AAAA"},{"uri":"a%20b.png"}],"samplers":[{"wrapS":33071,"wrapT":33648,"magFilter":9728}],)"
        R"("textures":[{"source":0,"sampler":0},{"source":1}],)"
        R"("materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0,"texCoord":1,"extensions":{"KHR_texture_transform":{"offset":[0.5,0.25],"rotation":1.5,"scale":[2,3],"texCoord":0}}}},)"
        R"("alphaMode":"MASK","alphaCutoff":0.3,"normalTexture":{"index":1,"scale":0.7},"occlusionTexture":{"index":1,"strength":0.4},"emissiveFactor":[1,1,1],"emissiveTexture":{"index":1}},)"
        R"({"alphaMode":"BLEND"}],)";
    const auto loaded = read(made.glb(rest + mesh_with(R"({"attributes":{"POSITION":0,"TEXCOORD_0":1},"mode":6,"material":0},{"attributes":{"POSITION":0,"COLOR_0":2},"mode":6,"material":1})")));
    ASSERT_TRUE(loaded) << loaded.error().text();
    const scene::Material &m = loaded->scene.materials[0], &colored = loaded->scene.materials[1];
    const scene::Texture& base = texture(m, "base_color");
    EXPECT_EQ(base.wrap_u, scene::Wrap::clamp);
    EXPECT_EQ(base.wrap_v, scene::Wrap::mirror);
    EXPECT_EQ(base.filter, scene::TextureFilter::nearest);
    EXPECT_EQ(base.set, 0) << "the transform's goes before";
    EXPECT_EQ((std::array{base.offset_u, base.offset_v, base.rotation, base.scale_u, base.scale_v}), (std::array{0.5, 0.25, 1.5, 2.0, 3.0}));
    EXPECT_EQ(base.image->source().bytes, std::string(3, '\0'));
    EXPECT_EQ(texture(m, "opacity").channel, scene::Channel::alpha);
    EXPECT_EQ(texture(m, "opacity").cutoff, 0.3);
    EXPECT_EQ(texture(m, "normal").strength, 0.7);
    EXPECT_EQ(texture(m, "occlusion").strength, 0.4);
    EXPECT_TRUE(texture(m, "emissive").image->source().file.ends_with("a b.png"));
    EXPECT_EQ(texture(colored, "base_color").kind, scene::TextureKind::vertex_color);
    EXPECT_EQ(texture(colored, "opacity").channel, scene::Channel::alpha);
    EXPECT_EQ(texture(colored, "opacity").cutoff, 0);
    const auto& mesh = std::get<geometry::Mesh>(loaded->scene.shapes[0].shape);
    ASSERT_EQ(mesh.positions.size(), 8u) << "vertices that differ in what textures go by are not shared";
    EXPECT_EQ(mesh.coordinates[0][1], (std::array<float, 2>{1, 1})) << "of the second corner of the fan";
    EXPECT_EQ(mesh.coordinates[0][6], (std::array<float, 2>{0, 0})) << "of a primitive without them";
    EXPECT_EQ(mesh.colors[0], (std::array<float, 4>{1, 1, 1, 1})) << "of a primitive without them";
    EXPECT_EQ(mesh.colors[6], (std::array<float, 4>{1, 0, 0, 0.2f})) << "of the fan's middle";

    for (const char* wrong : {R"("images":[{"uri":"../a.png"}],"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}],)",
                              R"("images":[{"uri":"a.png"}],"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0,"texCoord":2}}],)",
                              R"("images":[],"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}],)",
                              R"("images":[{}],"textures":[{"source":0}],"materials":[{"normalTexture":{"index":0}}],)"}) {
        EXPECT_FALSE(read(made.glb(wrong + mesh_with(R"({"attributes":{"POSITION":0},"mode":6,"material":0})")))) << wrong;
    }
    EXPECT_FALSE(read(made.glb(mesh_with(R"({"attributes":{"POSITION":0,"TEXCOORD_0":0},"mode":6})")))) << "coordinates of three numbers";
}

TEST(Gltf, TheFolderIsTheBorder) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "crescente_gltf";
    std::filesystem::create_directories(folder / "model" / "data");
    std::ofstream(folder / "secret.bin") << std::string(64, 'x');
    std::ofstream(folder / "model" / "data" / "b c.bin", std::ios::binary).write(reinterpret_cast<const char*>(square.data()), 48);
    const auto with = [&](const std::string& uri) {
        const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":48,"uri":")" + uri + R"("}],"bufferViews":[{"buffer":0,"byteLength":48}],)"
                                 R"("accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":4}],)" +
                                 mesh_with(R"({"attributes":{"POSITION":0},"mode":6})") + "}";
        return read_gltf(text, "test.gltf", folder / "model");
    };
    const auto inside = with("data/b%20c.bin");
    ASSERT_TRUE(inside) << inside.error().text();
    EXPECT_EQ(triangles_in(inside->scene), 2u);
    for (const std::string& uri : {std::string("../secret.bin"), std::string("data/../../secret.bin"), std::string("%2e%2e/secret.bin"),
                                   (folder / "secret.bin").string(), std::string("http://example.org/a.bin"), std::string("file:///etc/passwd")}) {
        const auto outside = with(uri);
        ASSERT_FALSE(outside) << uri;
        EXPECT_EQ(outside.error().kind, ErrorKind::input);
        EXPECT_TRUE(tells(outside.error(), "is refused")) << outside.error().text();
    }
    const auto missing = with("none.bin");
    ASSERT_FALSE(missing);
    EXPECT_TRUE(tells(missing.error(), "/buffers/0/uri")) << missing.error().text();
    EXPECT_TRUE(tells(missing.error(), "there is no such file")) << missing.error().text();
    std::filesystem::remove_all(folder);
}

TEST(Gltf, BuffersInTheTextItself) {
    // Three floats 0 0 0, 1 0 0, 0 1 0 in base64.
    const std::string text = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":36,"uri":"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],)"
                             R"("bufferViews":[{"buffer":0,"byteLength":36}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":3}],)" +
                             mesh_with(R"({"attributes":{"POSITION":0}})") + "}";
    const auto loaded = read(text);
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(triangles_in(loaded->scene), 1u);
}

TEST(Gltf, WhatIsWrongIsToldWithItsPlace) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    made.accessor(std::vector<std::uint8_t>{0, 1, 9}, 5121, "SCALAR", 1);
    made.accessor(std::vector<float>{0, 0, 0, 1, 0, 0, std::nanf(""), 1, 0}, 5126, "VEC3", 3);
    const auto fails = [&](const std::string& rest, const std::string& words) {
        const auto loaded = read(made.glb(rest));
        ASSERT_FALSE(loaded) << rest;
        EXPECT_EQ(loaded.error().kind, ErrorKind::input);
        EXPECT_TRUE(tells(loaded.error(), words)) << loaded.error().text();
    };
    fails(mesh_with(R"({"attributes":{"POSITION":0},"indices":1})"), "/meshes/0/primitives/0: has an index 9, but only 4 vertices");
    fails(mesh_with(R"({"attributes":{"POSITION":2}})"), "/meshes/0/primitives/0: vertex 2 has no finite position");
    fails(mesh_with(R"({"attributes":{"POSITION":7}})"), "/meshes/0/primitives/0/POSITION: points at 7, but there are only 3");
    fails(mesh_with(R"({"attributes":{}})"), "has no positions");
    fails(R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}])", "/nodes/0: has more than one parent");
    fails(R"("scenes":[{"nodes":[4]}],"nodes":[{}])", "must be the index of a node");
    fails(R"("scenes":[{"nodes":[0]}],"nodes":[{"translation":[1,2]}])", "/nodes/0/translation: must be an array of 3 numbers");
    fails(R"("scenes":[{"nodes":[0]}],"nodes":[{"rotation":[0,0,0,0]}])", "/nodes/0/rotation: must not be zero");
    made.accessors.replace(made.accessors.find(R"("count":4)"), 9, R"("count":5)");
    fails(mesh_with(R"({"attributes":{"POSITION":0}})"), "/accessors/0: reaches beyond the end of its buffer view");
    made.accessors.replace(made.accessors.find(R"("count":5)"), 9, R"("count":4000000000)");
    fails(mesh_with(R"({"attributes":{"POSITION":0}})"), "/accessors/0: has more elements than the file has bytes");
}

TEST(Gltf, RequiredExtensionsThatAreNotKnownAreRefused) {
    const auto refused = read(R"({"asset":{"version":"2.0"},"extensionsRequired":["EXT_from_the_future"]})");
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::unsupported);
    EXPECT_TRUE(tells(refused.error(), "EXT_from_the_future"));
    const auto used = read(R"({"asset":{"version":"2.0"},"extensionsUsed":["EXT_from_the_future"]})");
    ASSERT_TRUE(used);
    EXPECT_TRUE(warns_of(*used, "EXT_from_the_future"));
    const auto old = read(R"({"asset":{"version":"1.0"}})");
    ASSERT_FALSE(old);
    EXPECT_TRUE(tells(old.error(), "only glTF 2.x"));
}

TEST(Gltf, OneAccessorUsedAgainAndAgainIsRefused) {
    Made made;
    std::vector<std::uint8_t> indices(3000);
    for (std::size_t i = 0; i < indices.size(); ++i) indices[i] = static_cast<std::uint8_t>(i % 3);
    made.accessor(square, 5126, "VEC3", 3);
    made.accessor(indices, 5121, "SCALAR", 1);
    std::string primitives;
    for (int i = 0; i < 2000; ++i) primitives += std::string(i ? "," : "") + R"({"attributes":{"POSITION":0},"indices":1})";
    const auto loaded = read(made.glb(mesh_with(primitives)));
    ASSERT_FALSE(loaded);
    EXPECT_TRUE(tells(loaded.error(), "far more indices than bytes"));
}

TEST(Gltf, DracoDataThatLieAreRefused) {
    if (!can_decode_draco()) GTEST_SKIP() << "this build is without Draco";
    std::string bytes("DRACO\x02\x02\x01\x01\x00\x00", 11);
    bytes += std::string("\x00", 1) + "\xff\xff\xff\xff\x0f" + "\xff\xff\xff\xff\x0f";  // four thousand million vertices and faces
    bytes += std::string(100, '\x01');
    EXPECT_FALSE(decode_draco(bytes, DracoIds{0}));
    EXPECT_FALSE(decode_draco(bytes.substr(0, 5), DracoIds{0}));
    EXPECT_FALSE(decode_draco("", DracoIds{0}));
}

#if __has_include(<draco/compression/encode.h>)
TEST(Gltf, DracoIsDecoded) {
    if (!can_decode_draco()) GTEST_SKIP() << "this build is without Draco";
    constexpr int side = 10;  // a wavy sheet of 2 x 10 x 10 triangles
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(2 * side * side);
    const int positions = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const int normals = builder.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
    const auto corner = [](int i, int j) { return std::array<float, 3>{float(i), float(j), float((i + j) % 2) * 0.5f}; };
    const std::array<float, 3> up{0, 0, 1};
    for (int i = 0; i < side; ++i) {
        for (int j = 0; j < side; ++j) {
            const std::array<float, 3> a = corner(i, j), b = corner(i + 1, j), c = corner(i + 1, j + 1), d = corner(i, j + 1);
            const draco::FaceIndex face(static_cast<std::uint32_t>(2 * (i * side + j)));
            builder.SetAttributeValuesForFace(positions, face, a.data(), b.data(), c.data());
            builder.SetAttributeValuesForFace(positions, face + 1, a.data(), c.data(), d.data());
            builder.SetAttributeValuesForFace(normals, face, up.data(), up.data(), up.data());
            builder.SetAttributeValuesForFace(normals, face + 1, up.data(), up.data(), up.data());
        }
    }
    const auto sheet = builder.Finalize();
    ASSERT_TRUE(sheet);
    draco::EncoderBuffer encoded;
    draco::Encoder encoder;
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, 16);
    ASSERT_TRUE(encoder.EncodeMeshToBuffer(*sheet, &encoded).ok());

    // As exporters write it: the accessors tell counts and types and have no buffer views.
    Made made;
    made.bytes.assign(encoded.data(), encoded.size());
    made.views = R"({"buffer":0,"byteLength":)" + std::to_string(encoded.size()) + "}";
    made.accessors = R"({"componentType":5126,"type":"VEC3","count":121},{"componentType":5126,"type":"VEC3","count":121},)"
                     R"({"componentType":5125,"type":"SCALAR","count":600})";
    const auto id = [&](int attribute) { return std::to_string(sheet->attribute(attribute)->unique_id()); };
    const std::string rest =
        R"("extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"],)" +
        mesh_with(R"({"attributes":{"POSITION":0,"NORMAL":1},"indices":2,"extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":)" +
                  id(positions) + R"(,"NORMAL":)" + id(normals) + "}}}}");
    const auto loaded = read(made.glb(rest));
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(triangles_in(loaded->scene), 200u);
    const auto& mesh = std::get<geometry::Mesh>(loaded->scene.shapes.at(0).shape);
    EXPECT_EQ(mesh.positions.size(), 121u);
    EXPECT_NEAR(mesh.bounds().upper.x, side, 1e-3);
    EXPECT_NEAR(mesh.bounds().upper.z, 0.5, 1e-3);
    for (const auto& normal : mesh.normals) EXPECT_NEAR(normal[2], 1, 1e-3);

    // Damaged data give an error or another mesh.
    for (std::size_t at = 0; at < encoded.size(); ++at) {
        Made damaged = made;
        damaged.bytes[at] = static_cast<char>(damaged.bytes[at] ^ 0x55);
        const auto result = read(damaged.glb(rest));
        if (!result) {
            EXPECT_EQ(result.error().kind, ErrorKind::input);
        }
    }
}
#endif

TEST(Gltf, AFileCutAnywhereIsAnError) {
    REQUIRE_ASSET("gltf/Lights.glb");
    for (const char* name : {"gltf/Lights.glb", "gltf/geometry-camera-light.glb", "gltf/SimpleInstancing.glb", "gltf/FlightHelmet/FlightHelmet.gltf"}) {
        const std::string whole = bytes_of(asset(name));
        ASSERT_TRUE(read_gltf(whole, name, asset(name).parent_path())) << name;
        const std::size_t cuts = std::string_view(name).ends_with(".gltf") ? 100 : whole.size();
        for_each_cut(whole, cuts, [&](const std::string& bytes) { return read_gltf(bytes, name, asset(name).parent_path()); },
                     [&](std::size_t length, const Expected<Loaded>& cut) {
                         ASSERT_FALSE(cut) << name << " at " << length;
                         EXPECT_EQ(cut.error().kind, ErrorKind::input) << name << " at " << length;
                         EXPECT_FALSE(cut.error().problems.empty()) << name << " at " << length;
                     });
    }
}

}  // namespace
}  // namespace crescente::io
