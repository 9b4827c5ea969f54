#include "io/formats.h"

#include <set>

#include "reader_check.h"

namespace crescente::io {
namespace {

TEST(Formats, EveryExtensionBelongsToOneFormat) {
    std::set<std::string> seen;
    for (const Format& format : formats()) {
        EXPECT_FALSE(format.name.empty());
        EXPECT_FALSE(format.doc.empty());
        ASSERT_NE(format.read, nullptr);
        for (const std::string& extension : format.extensions) {
            EXPECT_TRUE(extension.starts_with('.'));
            EXPECT_TRUE(seen.insert(extension).second) << extension;
        }
    }
    for (const char* wanted : {".json", ".nff", ".gltf", ".glb", ".obj", ".ply", ".stl"}) EXPECT_TRUE(seen.contains(wanted)) << wanted;
}

TEST(Formats, TheManualKnowsEveryExtension) {
    const std::string manual = bytes_of(std::filesystem::path(CRESCENTE_ROOT) / "docs/formats.md");
    ASSERT_FALSE(manual.empty());
    for (const Format& format : formats()) {
        for (const std::string& extension : format.extensions) {
            EXPECT_NE(manual.find("`" + extension + "`"), std::string::npos) << extension;
        }
    }
}

TEST(Formats, AMissingFileIsToldWhateverItsFormat) {
    for (const Format& format : formats()) {
        for (const std::string& extension : format.extensions) {
            const auto loaded = read_scene("/nowhere/model" + extension);
            ASSERT_FALSE(loaded) << extension;
            EXPECT_EQ(loaded.error().kind, ErrorKind::input) << extension;
            EXPECT_EQ(loaded.error().problems.at(0).file, "/nowhere/model" + extension);
        }
    }
}

TEST(Formats, AnUnknownExtensionIsToldWithTheNearest) {
    const auto file = std::filesystem::path(testing::TempDir()) / "crescente.glbb";
    std::ofstream(file) << "x";
    const auto loaded = read_scene(file);
    std::filesystem::remove(file);
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, ErrorKind::input);
    EXPECT_TRUE(tells(loaded.error(), "did you mean '.glb'?")) << loaded.error().text();
}

TEST(Formats, AFolderIsNoFile) {
    const auto folder = std::filesystem::path(testing::TempDir()) / "crescente_folder.nff";
    std::filesystem::create_directories(folder);
    const auto loaded = read_scene(folder);
    std::filesystem::remove_all(folder);
    ASSERT_FALSE(loaded);
    EXPECT_TRUE(tells(loaded.error(), "this is a folder"));
}

TEST(Formats, ExtensionsAreReadInAnyCase) {
    const auto file = std::filesystem::path(testing::TempDir()) / "crescente_case.NFF";
    std::ofstream(file) << "s 0 0 0 1\n";
    const auto loaded = read_scene(file);
    std::filesystem::remove(file);
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(loaded->scene.shapes.size(), 1u);
}

}  // namespace
}  // namespace crescente::io
