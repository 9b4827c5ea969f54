// The generated schema and reference: committed as generated, accepting the scenes of the project, refusing broken ones.
#include "io/scene_schema.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "io/scene_file.h"
#include "scene/validate.h"

using namespace crescente;
namespace fs = std::filesystem;

namespace {

std::string content_of(const fs::path& file) {
    std::ifstream stream(file);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
}

std::vector<fs::path> project_scenes() {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(CRESCENTE_ROOT "/scenes")) {
        if (entry.path().extension() == ".json") files.push_back(entry.path());
    }
    return files;
}

bool has_jsonschema() { return std::system("python3 -c 'import jsonschema' 2>/dev/null") == 0; }

// Which of the scenes an independent implementation of JSON Schema accepts: a '1' or a '0' for each. One Python process for all.
std::string accepted(const nlohmann::json& scenes) {
    const fs::path folder = fs::temp_directory_path() / ("crescente-schema-" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "schema.json") << io::scene_schema();
    std::ofstream(folder / "scenes.json") << scenes.dump();
    std::ofstream(folder / "check.py") << "import json, sys, jsonschema\n"
                                          "schema = json.load(open('schema.json'))\n"
                                          "jsonschema.Draft202012Validator.check_schema(schema)\n"
                                          "validator = jsonschema.Draft202012Validator(schema)\n"
                                          "scenes = json.load(open('scenes.json'))\n"
                                          "open('verdicts', 'w').write(''.join('01'[validator.is_valid(scene)] for scene in scenes))\n";
    EXPECT_EQ(std::system(("cd " + folder.string() + " && python3 check.py").c_str()), 0);
    const std::string verdicts = content_of(folder / "verdicts");
    fs::remove_all(folder);
    return verdicts;
}

}  // namespace

TEST(Schema, CommittedFilesAreGenerated) {
    EXPECT_TRUE(content_of(CRESCENTE_ROOT "/docs/scene.schema.json") == io::scene_schema()) << "run: crescente schema > docs/scene.schema.json";
    EXPECT_TRUE(content_of(CRESCENTE_ROOT "/docs/scene_format.md") == io::scene_reference()) << "run: crescente schema --manual > docs/scene_format.md";
}

TEST(Schema, ProjectScenesAreValid) {
    ASSERT_GE(project_scenes().size(), 3u);
    for (const fs::path& file : project_scenes()) {
        const auto loaded = io::read_scene_file(file);
        ASSERT_TRUE(loaded) << loaded.error().text();
        const Problems problems = scene::validate(loaded->scene, file.string());
        EXPECT_TRUE(problems.empty()) << Error{ErrorKind::input, problems}.text();
    }
}

// The scene in the reference is read as it stands there.
TEST(Schema, ReferenceExampleIsValid) {
    const std::string manual = io::scene_reference();
    const auto begin = manual.find("```json\n") + 8, end = manual.find("```\n", begin);
    const auto loaded = io::read_scene_text(manual.substr(begin, end - begin), "example", ".");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_TRUE(scene::validate(loaded->scene, "example").empty());
}

TEST(Schema, AcceptsTheScenesOfTheProject) {
    if (!has_jsonschema()) GTEST_SKIP() << "python3-jsonschema is not installed";
    auto scenes = nlohmann::json::array();
    for (const fs::path& file : project_scenes()) {
        scenes.push_back(nlohmann::json::parse(content_of(file), nullptr, true, true));
        scenes.push_back(nlohmann::json::parse(io::write_scene_text(io::read_scene_file(file)->scene)));  // what the writer makes of it
    }
    EXPECT_EQ(accepted(scenes), std::string(scenes.size(), '1'));
}

// Whatever the schema refuses here, the reader refuses as well.
TEST(Schema, RefusesBrokenScenes) {
    if (!has_jsonschema()) GTEST_SKIP() << "python3-jsonschema is not installed";
    auto scenes = nlohmann::json::array();
    for (const char* broken : {
             R"([])",
             R"({"unti": "m"})",
             R"({"unit": "furlong"})",
             R"({"settings": {"width": 0}})",
             R"({"settings": {"width": 10.5}})",
             R"({"settings": {"level": "perfect"}})",
             R"({"camera": {"position": [1, 2]}})",
             R"({"materials": {"a": {"roughness": 2}}})",
             R"({"materials": {"a": {"diffuse": 0.5}}})",
             R"({"materials": {"a": {"model": "classic", "roughness": 0.5}}})",
             R"({"materials": {"a": {"base_color": "red"}}})",
             R"({"shapes": {"a": {}}})",
             R"({"shapes": {"a": {"ball": {}}}})",
             R"({"shapes": {"a": {"sphere": {}, "box": {}}}})",
             R"({"shapes": {"a": {"sphere": {"radius": -1}}}})",
             R"({"objects": [{"transform": [{"translate": [1, 2]}]}]})",
             R"({"objects": [{"transform": {"rotate": {"axis": "w", "angle": 3}}}]})",
             R"({"objects": [{"transform": {"scale": 2, "translate": [0, 0, 0]}}]})",
             R"({"objects": [{"visible": 1}]})",
         }) {
        scenes.push_back(nlohmann::json::parse(broken));
        EXPECT_FALSE(io::read_scene_text(broken, "broken", ".")) << broken;
    }
    EXPECT_EQ(accepted(scenes), std::string(scenes.size(), '0'));
}
