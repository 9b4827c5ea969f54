// Pictures of textures: what is missing, broken or hostile is told; a written scene reads back with its textures.
#include "io/texture_files.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <random>
#include <unistd.h>

#include "io/base64.h"
#include "io/edit_text.h"
#include "io/image_file.h"
#include "io/openimageio.h"
#include "io/scene_file.h"
#include "scene/validate.h"

using namespace crescente;
namespace fs = std::filesystem;

namespace {

#define NEEDS_PICTURES \
    if (!io::has_openimageio()) GTEST_SKIP() << "this build has no OpenImageIO"

class TextureFiles : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("crescente-textures-" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }
    fs::path in(const std::string& name) const { return folder_ / name; }
    fs::path put(const std::string& name, std::string_view bytes) const {
        std::ofstream(in(name), std::ios::binary) << bytes;
        return in(name);
    }
    std::string bytes_of(const fs::path& file) const {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    // A picture of so many channels, the values growing to the right; EXR takes any number of them.
    fs::path picture(const std::string& name, int width, int height, std::vector<std::string> channels, float factor = 1) const {
        scene::Image image{width, height, {{"color", std::move(channels), {}}}};
        for (int i = 0; i < width * height; ++i) {
            for (std::size_t c = 0; c < image.layers[0].channels.size(); ++c) image.layers[0].values.push_back(factor * static_cast<float>(i % width) / static_cast<float>(width));
        }
        const auto written = io::write_image(image, in(name), {});
        EXPECT_TRUE(written) << written.error().text();
        return in(name);
    }
    // A scene with one material that shows the picture.
    Expected<io::Loaded> scene_with(const std::string& image, bool pattern = false) const {
        put("scene.json", R"({"materials": {"oak": {"textures": {"base_color": {"image": ")" + image + R"("}}}}, "objects": {"ball": {"shape": {"sphere": {}}, "material": "oak"}}})");
        io::ReadOptions options;
        options.texture_pattern = pattern;
        return io::read_scene(in("scene.json"), options);
    }
    std::string told(const std::string& image) const {
        const auto loaded = scene_with(image);
        return loaded ? "nothing" : loaded.error().text();
    }
    fs::path folder_;
};

void expect_part(const std::string& text, const std::string& part) { EXPECT_NE(text.find(part), std::string::npos) << "'" << part << "' is not in: " << text; }

TEST_F(TextureFiles, ArePutIntoTheirScene) {
    NEEDS_PICTURES;
    picture("ramp.png", 4, 2, {"R", "G", "B"});
    const auto loaded = scene_with("ramp.png");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_TRUE(loaded->warnings.empty());
    EXPECT_TRUE(scene::validate(loaded->scene, "").empty());
    const scene::TextureImage& image = *loaded->scene.materials[0].textures.at(0).texture.image;
    EXPECT_EQ(image.width(), 4);
    EXPECT_EQ(image.height(), 2);
    for (int x = 0; x < 4; ++x) EXPECT_NEAR(image.texel(0, x, 1).g, x / 4.0, 0.01) << "the curve of the file undone";
}

TEST_F(TextureFiles, ThatAreMissingOrBrokenAreTold) {
    NEEDS_PICTURES;
    expect_part(told("oak.png"), "oak.png");
    put("empty.png", "");
    expect_part(told("empty.png"), "empty.png");
    put("words.png", "this is no picture");
    expect_part(told("words.png"), "is no picture that OpenImageIO knows, or damaged");
    expect_part(told("words.png"), "/materials/oak/textures/base_color/image");
    const std::string whole = bytes_of(picture("whole.png", 64, 64, {"R", "G", "B"}));
    put("half.png", whole.substr(0, whole.size() / 2));
    expect_part(told("half.png"), "half.png");
    expect_part(told("data:;base64,????"), "is not base64");
    expect_part(told("data:;base64," + io::encode_base64("no picture")), "scene.json");
}

TEST_F(TextureFiles, WebpIsReadAndKtxIsNamed) {
    NEEDS_PICTURES;
    const auto loaded = scene_with("data:image/webp;base64,UklGRiIAAABXRUJQVlA4IBYAAAAwAQCdASoBAAEADsD+JaQAA3AAAAAA");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(loaded->scene.materials[0].textures.at(0).texture.image->width(), 1);
    put("oak.ktx2", std::string("\xabKTX 20\xbb\r\n\x1a\n and more", 21));
    expect_part(told("oak.ktx2"), "is in KTX2 (Basis Universal, KHR_texture_basisu)");
}

TEST_F(TextureFiles, ThatAreMissingAreReplacedWhereThatIsAsked) {
    NEEDS_PICTURES;
    const auto loaded = scene_with("oak.png", true);
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_EQ(loaded->warnings.size(), 1u);
    expect_part(loaded->warnings[0].reason, "a pattern stands in");
    const scene::TextureImage& image = *loaded->scene.materials[0].textures.at(0).texture.image;
    EXPECT_EQ(image.texel(0, 0, 0), (scene::Rgba{1, 0, 1, 1}));
    EXPECT_EQ(image.texel(0, 8, 0), (scene::Rgba{0, 0, 0, 1}));
}

TEST_F(TextureFiles, OfTooManyChannelsOrPixelsAreRefused) {
    NEEDS_PICTURES;
    picture("many.exr", 4, 4, {"a", "b", "c", "d", "e"});
    expect_part(told("many.exr"), "has 5 channels, more than 4");
    // The head of a PNG of 100000 x 100000 pixels, with its checksum.
    const auto giant = [](std::uint32_t size) {
        std::string chunk = "IHDR";
        for (int k = 0; k < 2; ++k) {
            for (int shift = 24; shift >= 0; shift -= 8) chunk.push_back(static_cast<char>(size >> shift));
        }
        chunk += std::string("\x08\x02\x00\x00\x00", 5);
        std::uint32_t crc = 0xffffffff;
        for (const char c : chunk) {
            crc ^= static_cast<unsigned char>(c);
            for (int k = 0; k < 8; ++k) crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
        }
        crc = ~crc;
        std::string file("\x89PNG\r\n\x1a\n\0\0\0\x0d", 12);
        file += chunk;
        for (int shift = 24; shift >= 0; shift -= 8) file.push_back(static_cast<char>(crc >> shift));
        return file + std::string("\0\0\0\x01IDAT\x78\x35\xaf\x06\x1e", 13);
    };
    put("giant.png", giant(100000));
    expect_part(told("giant.png"), "giant.png");
    expect_part(told("giant.png"), "100000");
}

TEST_F(TextureFiles, SamplesThatAreNoNumbersBecomeZero) {
    NEEDS_PICTURES;
    const auto file = picture("holes.exr", 4, 4, {"R", "G", "B"}, std::numeric_limits<float>::infinity());  // 0 * infinity is no number either
    const auto loaded = scene_with("holes.exr");
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_EQ(loaded->warnings.size(), 1u);
    expect_part(loaded->warnings[0].reason, "48 samples");
    EXPECT_EQ(loaded->scene.materials[0].textures[0].texture.image->texel(0, 3, 3), (scene::Rgba{0, 0, 0, 1}));
}

TEST_F(TextureFiles, AreHeldToTheirMemory) {
    NEEDS_PICTURES;
    picture("large.png", 256, 256, {"R", "G", "B"});
    auto loaded = scene_with("large.png");
    ASSERT_TRUE(loaded);
    EXPECT_LE(loaded->scene.materials[0].textures[0].texture.image->bytes(), scene::pyramid_bytes(256, 256, 3, scene::SampleType::bits8) + 64);
    std::vector<scene::Material> materials(3);
    for (scene::Material& m : materials) {
        m.textures.push_back({"base_color", {}});
        m.textures[0].texture.image = std::make_shared<const scene::TextureImage>(scene::ImageSource{in(&m == &materials[0] ? "large.png" : "other.png").string(), {}});
    }
    picture("other.png", 256, 256, {"R", "G", "B"});
    const std::size_t memory = 400'000;  // for one and a half
    const auto warnings = io::load_textures(materials, "scene", {false, memory});
    ASSERT_TRUE(warnings) << warnings.error().text();
    ASSERT_EQ(warnings->size(), 1u);
    expect_part(warnings->at(0).reason, "of its size");
    const auto& first = *materials[0].textures[0].texture.image;
    const auto& second = *materials[1].textures[0].texture.image;
    EXPECT_EQ(&second, materials[2].textures[0].texture.image.get()) << "one picture, however many show it";
    EXPECT_EQ(first.width(), 256);
    EXPECT_LT(second.width(), 256);
    EXPECT_LE(first.bytes() + second.bytes(), memory);
}

// Random damage to real files of several formats: told, or a picture; never more than that.
TEST_F(TextureFiles, RandomDamageIsSurvived) {
    NEEDS_PICTURES;
    std::mt19937_64 random(1);
    std::vector<scene::Material> materials;
    for (const char* name : {"a.png", "a.jpg", "a.tif", "a.hdr", "a.exr"}) {
        const std::string whole = bytes_of(picture(name, 20, 12, {"R", "G", "B"}));
        for (int i = 0; i < 8; ++i) {
            std::string bytes = whole;
            for (int k = 0; k < 6; ++k) bytes[random() % bytes.size()] = static_cast<char>(random());
            if (i % 3 == 0) bytes.resize(random() % bytes.size());
            auto image = std::make_shared<const scene::TextureImage>(scene::ImageSource{{}, std::move(bytes), "/" + std::to_string(i)});
            materials.push_back({"", scene::PhysicalMaterial{}, {{"base_color", {}}}});
            materials.back().textures[0].texture.image = std::move(image);
        }
    }
    const auto warnings = io::load_textures(materials, "scene", {true});
    ASSERT_TRUE(warnings) << warnings.error().text();
    for (const scene::Material& m : materials) {
        const scene::TextureImage& image = *m.textures[0].texture.image;
        ASSERT_TRUE(image.decoded());
        EXPECT_TRUE(std::isfinite(image.texel(image.level_count() - 1, 0, 0).r));
    }
}

TEST_F(TextureFiles, AWrittenSceneReadsBack) {
    NEEDS_PICTURES;
    const fs::path file = picture("ramp.png", 4, 2, {"R", "G", "B"});
    const std::string text = R"({"materials": {"oak": {"metallic": 0.5, "textures": {
        "base_color": [{"image": "ramp.png", "projection": "box", "size": 0.4, "rotation": 30, "wrap_u": "mirror"}, {"kind": "wood", "projection": "solid", "axis": [1, 2, 3]}],
        "roughness": {"kind": "noise", "color_a": [1, 0.5, 0.25], "channel": "green"},
        "normal": {"image": "data:;base64,)" + io::encode_base64(bytes_of(file)) + R"(", "strength": 0.5, "set": 1}}}},
        "shapes": {"tile": {"mesh": {"positions": [0,0,0, 1,0,0, 0,1,0], "triangles": [0,1,2], "coordinates": [0,0, 1,0, 0,1], "coordinates_2": [0,0, 2,0, 0,2],
            "colors": [1,1,1,1, 0.5,0,0,1, 0,0,0.25,0.5], "tangents": [1,0,0,1, 1,0,0,1, 1,0,0,-1]}}},
        "objects": {"floor": {"shape": "tile", "material": "oak"}}})";
    put("first.json", text);
    const auto first = io::read_scene(in("first.json"));
    ASSERT_TRUE(first) << first.error().text();
    EXPECT_TRUE(scene::validate(first->scene, "").empty());
    const std::string written = io::write_scene_text(first->scene);
    put("second.json", written);
    const auto second = io::read_scene(in("second.json"));
    ASSERT_TRUE(second) << second.error().text();
    EXPECT_EQ(io::write_scene_text(second->scene), written);
    ASSERT_EQ(first->scene.materials[0].textures.size(), 4u);
    const auto& a = first->scene.materials[0].textures;
    const auto& b = second->scene.materials[0].textures;
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(a[i].target, b[i].target);
        for (const auto& f : scene::Texture::fields()) EXPECT_EQ(f.get(a[i].texture), f.get(b[i].texture)) << f.info.name;
        if (a[i].texture.image) {
            EXPECT_EQ(a[i].texture.image->content(), b[i].texture.image->content());
        }
    }
    const auto& mesh = std::get<geometry::Mesh>(second->scene.shapes[0].shape);
    EXPECT_EQ(mesh.colors[2], (std::array<float, 4>{0, 0, 0.25f, 0.5f}));
    EXPECT_EQ(mesh.coordinates[1][2], (std::array<float, 2>{0, 2}));
    EXPECT_EQ(mesh.tangents[2][3], -1);
}

TEST_F(TextureFiles, WhatIsWrongInASceneIsTold) {
    const auto told_of = [&](const std::string& textures) {
        put("wrong.json", R"({"materials": {"m": {"textures": )" + textures + "}}}");
        const auto loaded = io::read_scene(in("wrong.json"));
        if (!loaded) return loaded.error().text();
        std::string all;
        for (const Problem& p : scene::validate(loaded->scene, "wrong.json")) all += p.text() + "\n";
        return all;
    };
    expect_part(told_of(R"({"base_colour": {"kind": "noise"}})"), "did you mean 'base_color'?");
    expect_part(told_of(R"({"ior": {"kind": "noise"}})"), "ior");
    expect_part(told_of(R"({"base_color": {}})"), "'image' is missing");
    expect_part(told_of(R"({"base_color": {"kind": "nois"}})"), "did you mean 'noise'?");
    expect_part(told_of(R"({"roughness": {"kind": "noise", "size": 0}})"), "/materials/m/textures/roughness/size");
    expect_part(told_of(R"({"roughness": {"kind": "noise", "axis": [0, 0, 0]}})"), "it points nowhere");
    expect_part(told_of(R"({"roughness": {"kind": "noise", "cutoff": 0.5}})"), "only opacity can be cut off");
    expect_part(told_of(R"({"base_color": {"kind": "noise", "image": "oak.png"}})"), "which its kind does not show");
}

// v counts up the picture in OBJ, and down here.
TEST_F(TextureFiles, OfWavefrontMaterialsAreRead) {
    NEEDS_PICTURES;
    picture("ramp.png", 4, 2, {"R", "G", "B"});
    put("tile.mtl", "newmtl oak\nKd 0.5 0.5 0.5\nmap_Kd ramp.png\nnewmtl stone\nKd 1 1 1\nmap_Kd ../outside.png\n");
    put("tile.obj", "mtllib tile.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 0 0.75\nusemtl oak\nf 1/1 2/2 3/3\nusemtl stone\nf 2/1 4/2 3/3\n");
    const auto loaded = io::read_scene(in("tile.obj"));
    if (!loaded && loaded.error().kind == ErrorKind::unsupported) GTEST_SKIP() << "this build is without Assimp";
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_TRUE(scene::validate(loaded->scene, "").empty());
    const auto named = [&](const std::string& name) {
        return *std::find_if(loaded->scene.materials.begin(), loaded->scene.materials.end(), [&](const scene::Material& m) { return m.name == name; });
    };
    ASSERT_EQ(named("oak").textures.size(), 1u);
    EXPECT_EQ(named("oak").textures[0].target, "base_color");
    EXPECT_EQ(named("oak").textures[0].texture.image->width(), 4);
    EXPECT_TRUE(named("stone").textures.empty()) << "a file from a stranger must not make the program read what lies elsewhere";
    bool told = false;
    for (const Problem& p : loaded->warnings) told = told || p.reason.find("1 textures are left out") != std::string::npos;
    EXPECT_TRUE(told);
    for (const auto& shape : loaded->scene.shapes) {
        const auto& mesh = std::get<geometry::Mesh>(shape.shape);
        if (mesh.coordinates[0].empty()) continue;
        ASSERT_EQ(mesh.coordinates[0].size(), mesh.positions.size());
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            EXPECT_EQ(mesh.coordinates[0][i][0], mesh.positions[i].x);
            EXPECT_EQ(mesh.coordinates[0][i][1], mesh.positions[i].y == 1 ? 0.25f : 1.0f);
        }
    }
}

TEST_F(TextureFiles, EditsBringTheirPictures) {
    NEEDS_PICTURES;
    const fs::path file = picture("ramp.png", 4, 2, {"R", "G", "B"});
    scene::Scene scene;
    scene.materials.push_back({"oak", scene::PhysicalMaterial{}, {}});
    const auto edits = io::read_edit_text(R"({"material": {"name": "oak", "textures": {"base_color": {"image": ")" + file.string() + R"("}}}})", scene, "edit");
    ASSERT_TRUE(edits) << edits.error().text();
    ASSERT_EQ(edits->size(), 1u);
    EXPECT_TRUE(std::get<scene::SetMaterial>(edits->at(0)).value.textures.at(0).texture.image->decoded());
    const auto missing = io::read_edit_text(R"({"material": {"name": "oak", "textures": {"base_color": {"image": "/nowhere/oak.png"}}}})", scene, "edit");
    ASSERT_FALSE(missing);
    expect_part(missing.error().text(), "/nowhere/oak.png");
}

}  // namespace
