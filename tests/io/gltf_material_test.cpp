// Materials of glTF files: factors, extensions, pictures.
#include "gltf_made.h"
#include "io/openimageio.h"
#include "scene/validate.h"

namespace crescente::io {
namespace {

TEST(Gltf, MaterialFactorsAndExtensions) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    const auto loaded = read(made.glb(
        R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.1,0.2,0.3,0.4],"metallicFactor":0.5,"roughnessFactor":0.25},"alphaMode":"BLEND","doubleSided":true,)"
        R"("emissiveFactor":[1,0.5,0],"extensions":{"KHR_materials_emissive_strength":{"emissiveStrength":4},"KHR_materials_ior":{"ior":1.3},"KHR_materials_clearcoat":{"clearcoatFactor":0.7,"clearcoatRoughnessFactor":0.2},)"
        R"("KHR_materials_transmission":{"transmissionFactor":0.9},"KHR_materials_volume":{"thicknessFactor":1,"attenuationDistance":0.5,"attenuationColor":[1,0.5,0.25]}}},)"
        R"({"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.3]},"alphaMode":"MASK"},{"pbrMetallicRoughness":{"baseColorFactor":[1,1,1,0.3]}}],)" +
        mesh_with(R"({"attributes":{"POSITION":0},"mode":6,"material":0},{"attributes":{"POSITION":0},"mode":6,"material":1},{"attributes":{"POSITION":0},"mode":6,"material":2})")));
    ASSERT_TRUE(loaded) << loaded.error().text();
    const auto& m = physical(loaded->scene, 0);
    EXPECT_EQ(m.base_color, (math::Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(m.metallic, 0.5);
    EXPECT_EQ(m.roughness, 0.25);
    EXPECT_EQ(m.opacity, 0.4);
    EXPECT_TRUE(m.double_sided);
    EXPECT_EQ(m.emissive, (math::Rgb{4, 2, 0}));
    EXPECT_EQ(m.ior, 1.3);
    EXPECT_EQ(m.clearcoat, 0.7);
    EXPECT_EQ(m.clearcoat_roughness, 0.2);
    EXPECT_EQ(m.transmission, 0.9);
    EXPECT_NEAR(m.attenuation.r, 0, 1e-6);
    EXPECT_NEAR(m.attenuation.g, std::log(2.0) / 0.5, 1e-6);
    EXPECT_NEAR(m.attenuation.b, std::log(4.0) / 0.5, 1e-6);
    EXPECT_EQ(physical(loaded->scene, 1).opacity, 0);  // below the cutoff
    EXPECT_EQ(physical(loaded->scene, 2).opacity, 1);
    EXPECT_EQ(physical(loaded->scene, 2).metallic, 1);  // the format's default
}

TEST(Gltf, MaterialsOfTheKhronosGroup) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    const auto loaded = read(made.glb(
        R"("extensionsRequired":["KHR_materials_specular","KHR_materials_sheen","KHR_materials_anisotropy","KHR_materials_iridescence","KHR_materials_dispersion"],)"
        R"("images":[{"uri":"a.png"}],"textures":[{"source":0}],"materials":[{"name":"all","extensions":{)"
        R"("KHR_materials_specular":{"specularFactor":0.6,"specularColorFactor":[1,2,0.5],"specularTexture":{"index":0},"specularColorTexture":{"index":0}},)"
        R"("KHR_materials_sheen":{"sheenColorFactor":[0.1,0.2,0.3],"sheenRoughnessFactor":0.4,"sheenColorTexture":{"index":0},"sheenRoughnessTexture":{"index":0}},)"
        R"("KHR_materials_anisotropy":{"anisotropyStrength":0.7,"anisotropyRotation":1.25,"anisotropyTexture":{"index":0}},)"
        R"("KHR_materials_iridescence":{"iridescenceFactor":0.9,"iridescenceIor":1.8,"iridescenceThicknessMinimum":100,"iridescenceThicknessMaximum":500,"iridescenceTexture":{"index":0},"iridescenceThicknessTexture":{"index":0}},)"
        R"("KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatNormalTexture":{"index":0,"scale":0.3}},)"
        R"("KHR_materials_transmission":{"transmissionFactor":1},"KHR_materials_volume":{"thicknessFactor":1},"KHR_materials_dispersion":{"dispersion":0.4}}},)"
        R"({"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0.25,1]},"normalTexture":{"index":0},"extensions":{"KHR_materials_unlit":{},"KHR_materials_clearcoat":{"clearcoatFactor":1,"clearcoatTexture":{"index":0}},)"
        R"("KHR_materials_sheen":{"sheenColorFactor":[1,1,1]}}}],)" +
        mesh_with(R"({"attributes":{"POSITION":0},"mode":6,"material":0},{"attributes":{"POSITION":0},"mode":6,"material":1})")));
    ASSERT_TRUE(loaded) << loaded.error().text();
    const scene::Material& all = loaded->scene.materials[0];
    const auto& m = physical(loaded->scene, 0);
    EXPECT_EQ(m.specular, 0.6);
    EXPECT_EQ(m.specular_color, (math::Rgb{1, 2, 0.5f}));
    EXPECT_EQ(m.sheen_color, (math::Rgb{0.1f, 0.2f, 0.3f}));
    EXPECT_EQ(m.sheen_roughness, 0.4);
    EXPECT_EQ(m.anisotropy, 0.7);
    EXPECT_EQ(m.anisotropy_rotation, 1.25);
    EXPECT_EQ(m.grain, scene::Grain::surface);
    EXPECT_EQ((std::array{m.iridescence, m.iridescence_ior, m.iridescence_thickness}), (std::array{0.9, 1.8, 500.0}));
    EXPECT_EQ(m.dispersion, 0.4);
    using scene::Channel;
    for (const auto& [target, channel] : {std::pair{"specular", Channel::alpha}, {"specular_color", Channel::automatic}, {"sheen_color", Channel::automatic}, {"sheen_roughness", Channel::alpha},
                                          {"anisotropy", Channel::blue}, {"grain", Channel::automatic}, {"iridescence", Channel::red}, {"iridescence_thickness", Channel::green}, {"clearcoat_normal", Channel::automatic}}) {
        EXPECT_EQ(texture(all, target).channel, channel) << target;
    }
    EXPECT_EQ(texture(all, "clearcoat_normal").strength, 0.3);
    EXPECT_NEAR(500 * (1 + texture(all, "iridescence_thickness").strength * (0 - 1)), 100, 1e-9) << "black is the least thickness";
    const auto& unlit = physical(loaded->scene, 1);
    EXPECT_EQ(unlit.emissive, (math::Rgb{1, 0.5f, 0.25f}));
    EXPECT_EQ(unlit.clearcoat, 0) << "unlit: nothing but its colour";
    EXPECT_EQ(unlit.specular, 0);
    EXPECT_TRUE(math::is_black(unlit.sheen_color));
    EXPECT_TRUE(loaded->scene.materials[1].textures.empty());
}

TEST(Gltf, PicturesAreSharedAndThoseThatAreNotReadAreNamed) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    const auto loaded = read(made.glb(
        R"("images":[{"bufferView":0,"mimeType":"image/png"},{"bufferView":0,"mimeType":"image/png"}],"textures":[{"source":0},{"source":1},{"extensions":{"EXT_texture_webp":{"source":1}}},{"extensions":{"KHR_texture_basisu":{"source":0}}}],)"
        R"("materials":[{"normalTexture":{"index":0},"emissiveFactor":[1,1,1],"emissiveTexture":{"index":1}},{"normalTexture":{"index":2},"occlusionTexture":{"index":3}}],)" +
        mesh_with(R"({"attributes":{"POSITION":0},"mode":6,"material":0},{"attributes":{"POSITION":0},"mode":6,"material":1})")));
    ASSERT_TRUE(loaded) << loaded.error().text();
    const scene::Material& m = loaded->scene.materials[0];
    EXPECT_EQ(texture(m, "normal").image, texture(m, "emissive").image) << "two images, one piece of a buffer";
    const bool told = std::any_of(loaded->warnings.begin(), loaded->warnings.end(), [](const Problem& p) {
        return (p.reason.find("EXT_texture_webp (WebP)") == std::string::npos) == has_openimageio() && p.reason.find("KHR_texture_basisu (KTX2, Basis Universal)") != std::string::npos;
    });
    EXPECT_TRUE(told);
    if (has_openimageio()) {
        EXPECT_EQ(texture(loaded->scene.materials[1], "normal").image, texture(m, "normal").image) << "WebP";
    }
}

TEST(Gltf, KtxIsNamed) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    const auto refused = read(made.glb(R"("extensionsRequired":["KHR_texture_basisu"],)" + mesh_with(R"({"attributes":{"POSITION":0},"mode":6})")));
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().text().find("KTX2"), std::string::npos) << refused.error().text();
}

// KHR_materials_ior: 0 stands for infinite, and is kept.
TEST(Gltf, InfiniteIndex) {
    Made made;
    made.accessor(square, 5126, "VEC3", 3);
    const auto loaded = read(made.glb(R"("materials":[{"extensions":{"KHR_materials_ior":{"ior":0},"KHR_materials_specular":{"specularColorFactor":[0.9,0.2,0.1]}}}],)" +
                                      mesh_with(R"({"attributes":{"POSITION":0},"mode":6,"material":0})")));
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(physical(loaded->scene, 0).ior, 0);
    EXPECT_TRUE(scene::validate(loaded->scene, "made.glb").empty());
}

}  // namespace
}  // namespace crescente::io
