// Edits from memory, line by line on one scene. What is read must leave the scene valid or alone, and must be undone; what is left must be drawable.
#include "engine.h"
#include "io/edit_script.h"
#include "io/scene_file.h"

namespace {

using namespace crescente;

const scene::Scene& first_scene() {
    static const scene::Scene scene = [] {
        auto loaded = io::read_scene_text(R"({
            "camera": {}, "lights": {"key": {"position": [1, 2, 3]}},
            "materials": {"red": {"base_color": [1, 0, 0]}, "chrome": {"model": "classic", "reflection": 0.9}},
            "shapes": {"ball": {"sphere": {}}}, "groups": {"spare": {"shape": "ball"}},
            "objects": {"car": {"material": "red", "children": {"wheel": {"shape": "ball"}, "a/b": {"shape": {"box": {}}, "material": "chrome"}}}, "floor": {"shape": {"plane": {}}}}
        })", "first.json", "/no folder");
        fuzz::require(loaded.has_value());
        return std::move(loaded->scene);
    }();
    return scene;
}

bool same_hierarchy(const scene::Scene& a, const scene::Scene& b) {
    if (a.roots != b.roots || a.lights != b.lights || a.environment != b.environment || a.camera != b.camera || a.settings != b.settings) return false;
    for (std::size_t i = 0; i < a.nodes.size(); ++i) {
        const scene::Node &x = a.nodes[i], &y = b.nodes[i];
        if (x.children != y.children || x.materials != y.materials || x.shape != y.shape || x.visible != y.visible || x.transform != y.transform) return false;
    }
    return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    const auto lines = io::read_edit_script({reinterpret_cast<const char*>(data), size}, "fuzz.jsonl");
    if (!lines) return 0;
    scene::Scene scene = first_scene();
    for (const io::ScriptLine& line : *lines) {
        const auto* json = std::get_if<io::Json>(&line.step);
        if (!json) continue;
        auto edits = io::read_edit(*json, scene, "fuzz.jsonl");
        if (!edits) continue;
        const scene::Scene before = scene;
        auto undo = scene::apply(std::move(*edits), scene);
        if (!undo) {
            fuzz::require(same_hierarchy(before, scene));
            continue;
        }
        fuzz::require(scene::validate_edited(scene, "edited", {}).empty());
        auto redo = scene::apply(std::move(*undo), scene);
        fuzz::require(redo.has_value() && same_hierarchy(before, scene));
        fuzz::require(scene::apply(std::move(*redo), scene).has_value());
    }
    if (scene::validate(scene, "edited").empty()) fuzz::exercise(io::Loaded{std::move(scene), {}});
    return 0;
}
