// The library of materials in scene files, edits and overrides, and its page.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "io/edit_text.h"
#include "io/material_reference.h"
#include "io/scene_file.h"
#include "scene/material_library.h"
#include "scene/validate.h"

namespace crescente::io {
namespace {

const scene::PhysicalMaterial& physical(const scene::Scene& scene, std::size_t i) { return std::get<scene::PhysicalMaterial>(scene.materials.at(i).model); }
const scene::PhysicalMaterial& named(const char* name) { return scene::find_in_library(name)->material; }

TEST(MaterialLibrary, NamesAreUniqueAndMaterialsValid) {
    const std::set<std::string> names(scene::library_names().begin(), scene::library_names().end());
    EXPECT_EQ(names.size(), scene::material_library().size());
    std::size_t metals = 0;
    auto loaded = read_scene_text(R"({"objects": {"ball": {"shape": {"sphere": {}}}}})", "test", ".");
    ASSERT_TRUE(loaded);
    scene::Scene& scene = loaded->scene;
    scene.camera.emplace();
    for (const scene::LibraryMaterial& m : scene::material_library()) {
        EXPECT_EQ(scene::find_in_library(m.name), &m);
        scene.materials.push_back({m.name, m.material});
        metals += m.name.ends_with(" polished");
    }
    for (const Problem& p : scene::validate(scene, "library")) ADD_FAILURE() << p.text();
    EXPECT_GE(metals, 12u);
}

TEST(MaterialLibrary, IsReadInScenes) {
    const auto loaded = read_scene_text(R"({"materials": {"a": {"library": "gold satin"}, "b": {"library": "paint red", "clearcoat": 0.5}},
        "objects": {"x": {"shape": {"sphere": {}}, "material": "a"}, "y": {"shape": {"sphere": {}}, "material": {"library": "glass clear"}},
                    "z": {"shape": {"sphere": {}}, "material": {"library": "glass clear"}}}})", "test", ".");
    ASSERT_TRUE(loaded) << loaded.error().text();
    const scene::Scene& s = loaded->scene;
    ASSERT_EQ(s.materials.size(), 3u) << "what is said twice is one";
    EXPECT_EQ(physical(s, 0), named("gold satin"));
    scene::PhysicalMaterial half = named("paint red");
    half.clearcoat = 0.5;
    EXPECT_EQ(physical(s, 1), half);
    EXPECT_EQ(s.materials[2].name, "glass clear");
    EXPECT_EQ(physical(s, 2), named("glass clear"));
    EXPECT_EQ(s.nodes[s.roots[2].value].materials, s.nodes[s.roots[1].value].materials);
    const auto again = read_scene_text(write_scene_text(s), "written", ".");
    ASSERT_TRUE(again) << again.error().text();
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(physical(again->scene, i), physical(s, i)) << "what is written is read again";
}

TEST(MaterialLibrary, TellsWhatIsWrong) {
    const auto told = [](const std::string& material) {
        const auto loaded = read_scene_text(R"({"materials": {"a": )" + material + "}}", "test", ".");
        return loaded ? std::string() : loaded.error().text();
    };
    EXPECT_NE(told(R"({"library": "gold satn"})").find("did you mean 'gold satin'"), std::string::npos) << told(R"({"library": "gold satn"})");
    EXPECT_NE(told(R"({"library": "unobtainium"})").find("crescente materials"), std::string::npos);
    EXPECT_NE(told(R"({"library": 3})").find("/materials/a/library"), std::string::npos);
    EXPECT_NE(told(R"({"model": "classic", "library": "gold satin"})").find("classic"), std::string::npos);
}

TEST(MaterialLibrary, PageIsGenerated) {
    std::ifstream stream(CRESCENTE_ROOT "/docs/materials.md");
    std::ostringstream text;
    text << stream.rdbuf();
    EXPECT_TRUE(text.str() == material_reference()) << "run: crescente materials --manual > docs/materials.md";
}

}  // namespace
}  // namespace crescente::io
