// Scripts of edits, played on real scenes by the real program.
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace crescente::test {
namespace {

using Json = nlohmann::json;

const std::string primitives = (scenes / "primitives.json").string();
const std::string engine = (scenes / "2CylinderEngine.glb").string();

class EditCommand : public ProgramTest {
protected:
    Outcome play(const std::string& model, const std::string& script, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"edit", model, write("script.jsonl", script), "--size", "96x64"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return crescente(std::move(arguments));
    }
};

constexpr const char* every_edit = R"(// every verb
{"set": {"material.red.base_color": "#20a040", "settings.contrast": 0.2}}
{"material": {"name": "gold", "base_color": [1, 0.7, 0.3], "metallic": 1, "roughness": 0.2}}
{"add": {"name": "extra", "shape": {"sphere": {"radius": 0.4}}, "material": "gold", "transform": {"translate": [0, 1, 0]}}}
{"move": {"object": "extra", "by": {"translate": [0.3, 0, 0]}}}

{"hide": "extra"}
{"advance": {"seconds": 0.001}}
{"show": "extra"}
{"advance": {"level": "shadows"}}
{"duplicate": {"object": "extra", "name": "more", "by": {"translate": [-0.8, 0, 0]}}}
{"assign": {"object": "more", "material": "red"}}
{"shape": {"name": "extra", "box": {}}}
{"remove": "more"}
{"batch": [{"light": {"name": "rim", "position": [0, 3, 2], "intensity": 4}}, {"environment": {"zenith": 0.5}}, {"set": {"camera.field_of_view": 50}}]}
{"remove_light": "rim"}
{"undo": 3}
{"redo": 2}
{"advance": {}}
)";

// A scene with the names that the script uses.
constexpr const char* small_scene = R"({
  "camera": {"position": [0, 1, 5], "target": [0, 0.5, 0]},
  "lights": {"key": {"position": [2, 4, 3], "intensity": 20}},
  "materials": {"red": {"base_color": [1, 0, 0]}, "glass": {"model": "classic", "diffuse": 0.1, "transmission": 0.8, "reflection": 0.1, "ior": 1.3}},
  "objects": {
    "ground": {"shape": {"plane": {}}},
    "group": {"children": {"ball": {"shape": {"sphere": {"radius": 0.5}}, "material": "glass", "transform": {"translate": [0, 0.5, 0]}},
                           "box": {"shape": {"box": {}}, "material": "red", "transform": {"translate": [-1.5, 0.5, -1]}}}}
  }
})";

TEST_F(EditCommand, EveryEditEndsInThePictureOfAFreshRender) {
    const std::string model = write("scene.json", small_scene);
    const Outcome outcome = play(model, every_edit, {"--check", "--json", path("report.json"), "-o", path("a.png")});
    ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
    EXPECT_TRUE(contains(outcome.out, "(fresh render)"));
    EXPECT_TRUE(contains(outcome.out, "check: the picture is that of a fresh render, to the bit"));
    EXPECT_TRUE(fs::exists(path("a.png")));

    const Json report = Json::parse(read(path("report.json")));
    EXPECT_EQ(report["language_version"], 1);
    EXPECT_EQ(report["width"], 96);
    EXPECT_GT(report["fresh"]["rays"]["camera"], 96 * 64);
    EXPECT_EQ(report["check"]["equal"], true);
    EXPECT_EQ(report["check"]["different_pixels"], 0);
    EXPECT_GT(report["check"]["rays"]["camera"], 96 * 64);
    ASSERT_EQ(report["edits"].size(), 14u);
    const Json& recolored = report["edits"][0];
    EXPECT_EQ(recolored["line"], 2);
    EXPECT_FALSE(recolored["began_anew"]);
    EXPECT_FALSE(recolored["time"]["converged"].is_null());
    EXPECT_FALSE(recolored["time"]["first"].is_null());
    const Json& material = report["edits"][1];  // nothing refers to it yet
    EXPECT_EQ(material["tiles"], 0);
    EXPECT_EQ(material["rays"]["total"], 0);
    EXPECT_TRUE(material["time"]["first"].is_null());
    const Json& moved = report["edits"][3];
    EXPECT_FALSE(moved["began_anew"]);
    EXPECT_GT(moved["rays"]["total"], 0);
    EXPECT_LT(moved["rays_of_fresh"], 1);
    EXPECT_EQ(report["sum"]["edits"], 14);
}

TEST_F(EditCommand, UndoReturnsToTheFirstPicture) {
    const std::string first = path("first.png"), changed = path("changed.png"), last = path("last.png"), again = path("again.png"), fresh = path("fresh.png");
    const std::string model = write("scene.json", small_scene);
    const std::string script = "{\"picture\": \"" + first + "\"}\n{\"hide\": \"group/ball\"}\n{\"set\": {\"light.key.color\": [1, 0.5, 0]}}\n{\"picture\": \"" + changed +
                               "\"}\n{\"undo\": 2}\n{\"picture\": \"" + last + "\"}\n{\"redo\": 2}\n{\"picture\": \"" + again + "\"}\n{\"undo\": 2}\n";
    const Outcome outcome = play(model, script, {"--check", "-q"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    EXPECT_TRUE(read(first) == read(last));
    EXPECT_TRUE(read(changed) == read(again));
    EXPECT_FALSE(read(first) == read(changed));
    ASSERT_EQ(crescente({"render", model, "-o", fresh, "--size", "96x64", "-q"}).code, 0);
    // The command line is in the metadata of both; the pixels are what is compared.
    const auto pixels = [](const std::string& png) { return png.substr(png.find("IDAT")); };
    EXPECT_TRUE(pixels(read(first)) == pixels(read(fresh)));
}

TEST_F(EditCommand, BareModelsGetTheStudio) {
    const Outcome outcome = play(engine, "{\"hide\": 1}\n{\"undo\": 1}\n", {"--check"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.out, "{\"hide\": 1}"));
}

TEST_F(EditCommand, ABadScriptIsToldWholeBeforeAnythingIsRendered) {
    const Outcome outcome = play(primitives, "{\"hide\": \"ball\"}\n{\"hid\": \"ball\"}\n\n{\"undo\": -1}\n{\"show\" 3}\n", {"-o", path("a.png")});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(count(outcome.err, "error: "), 3u) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "script.jsonl: line 2, /hid: 'hid' is not known here (did you mean 'hide'?)"));
    EXPECT_TRUE(contains(outcome.err, "script.jsonl: line 4, /undo: must be a whole number"));
    EXPECT_TRUE(contains(outcome.err, "script.jsonl: line 5, column "));
    EXPECT_EQ(files(), std::vector<std::string>{"script.jsonl"});
}

TEST_F(EditCommand, ABadEditStopsTheScriptWithItsLine) {
    const std::string model = write("scene.json", small_scene);
    Outcome outcome = play(model, "{\"hide\": \"ground\"}\n{\"batch\": [{\"hide\": \"grond\"}, {\"set\": {\"light.key.intensity\": -1}}]}\n{\"picture\": \"" + path("no.png") + "\"}\n",
                           {"-o", path("a.png")});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "script.jsonl: line 2, /batch/0/hide: there is no object 'grond' (did you mean 'ground'?)"));
    EXPECT_TRUE(contains(outcome.err, "script.jsonl: line 2, /batch/1/set/light.key.intensity: is -1 cd|lx, must be at least 0"));
    EXPECT_EQ(files(), (std::vector<std::string>{"scene.json", "script.jsonl"}));

    outcome = play(model, "\n{\"move\": {\"object\": \"ground\", \"transform\": {\"scale\": 0}}}\n");  // only the scene shows it
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "script.jsonl: line 2, /objects/ground/transform: cannot be inverted"));

    outcome = play(model, "{\"hide\": \"ground\"}\n{\"undo\": 2}\n");
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "script.jsonl: line 2, /undo: one edit only can be taken back"));
}

TEST_F(EditCommand, FilesThatCannotBeReadOrWritten) {
    Outcome outcome = crescente({"edit", primitives, path("none.jsonl")});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "none.jsonl"));
    outcome = play(primitives, "{\"picture\": \"" + path("no/such/folder.png") + "\"}\n{\"picture\": \"" + path("a.xyz") + "\"}\n");
    EXPECT_EQ(outcome.code, 4);
    EXPECT_EQ(count(outcome.err, "error: "), 2u) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "script.jsonl, line 1"));
    outcome = crescente({"edit", primitives});
    EXPECT_EQ(outcome.code, 2);
    outcome = play(primitives, "", {"--chek"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_TRUE(contains(outcome.err, "did you mean '--check'?"));
}

TEST_F(EditCommand, AnEmptyScriptRendersThePicture) {
    const Outcome outcome = play(primitives, "// nothing\n", {"-o", path("a.png"), "--check"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.out, "0 edits"));
    EXPECT_TRUE(fs::exists(path("a.png")));
}

TEST_F(EditCommand, ASignalStopsTheScript) {
    std::string script;
    for (int i = 0; i < 500; ++i) script += "{\"set\": {\"camera.position\": [" + std::to_string(i) + ", 200, 900]}}\n";
    Running program(command({"edit", engine, write("script.jsonl", script), "--size", "640x480", "-o", path("a.png")}), {});
    ASSERT_TRUE(program.wait_for_error_text("rendering"));
    program.send(SIGINT);
    const Outcome outcome = program.finish();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_EQ(files(), std::vector<std::string>{"script.jsonl"});
}

}  // namespace
}  // namespace crescente::test
