#include "scene/edit.h"

#include <algorithm>

#include "scene/validate.h"

namespace crescente::scene {
namespace {

// Makes one edit after the other, and remembers what undoes it.
class Editor {
public:
    explicit Editor(Scene& scene) : scene_(scene) {}

    // A problem where the edit names what is not there; it then does nothing.
    std::optional<std::string> make(Edit& edit) {
        return std::visit([this](auto& e) { return make(e); }, edit);
    }

    std::vector<Edit> undo() { return {std::make_move_iterator(undo_.rbegin()), std::make_move_iterator(undo_.rend())}; }
    const std::vector<ShapeId>& shapes() const { return shapes_; }

private:
    using Result = std::optional<std::string>;

    // Swaps in the new value, and leaves the old one in the edit, which thereby becomes its own undoing.
    template <class Kind, class Value>
    Result swap(Kind& edit, Value& now, Value& next) {
        std::swap(now, next);
        undo_.emplace_back(std::move(edit));
        return {};
    }
    static Result missing(const char* what, std::uint32_t index, std::size_t count) {
        return std::string("there is no ") + what + " " + std::to_string(index) + " among " + std::to_string(count);
    }

    Result make(SetMaterial& e) {
        if (e.material.value >= scene_.materials.size()) return missing("material", e.material.value, scene_.materials.size());
        return swap(e, scene_.materials[e.material.value], e.value);
    }
    Result make(AddMaterial& e) {
        scene_.materials.push_back(std::move(e.value));
        return {};
    }
    Result make(SetLight& e) {
        if (e.light >= scene_.lights.size()) return missing("light", e.light, scene_.lights.size());
        return swap(e, scene_.lights[e.light], e.value);
    }
    Result make(InsertLight& e) {
        if (e.before > scene_.lights.size()) return missing("place for a light", e.before, scene_.lights.size() + 1);
        scene_.lights.insert(scene_.lights.begin() + e.before, std::move(e.value));
        undo_.emplace_back(RemoveLight{e.before});
        return {};
    }
    Result make(RemoveLight& e) {
        if (e.light >= scene_.lights.size()) return missing("light", e.light, scene_.lights.size());
        undo_.emplace_back(InsertLight{e.light, std::move(scene_.lights[e.light])});
        scene_.lights.erase(scene_.lights.begin() + e.light);
        return {};
    }
    Result make(SetShape& e) {
        if (e.shape.value >= scene_.shapes.size()) return missing("shape", e.shape.value, scene_.shapes.size());
        shapes_.push_back(e.shape);
        return swap(e, scene_.shapes[e.shape.value].shape, e.value);
    }
    Result make(AddShape& e) {
        shapes_.push_back({static_cast<std::uint32_t>(scene_.shapes.size())});
        scene_.shapes.push_back(std::move(e.value));
        return {};
    }
    Result make(SetNode& e) {
        if (e.node.value >= scene_.nodes.size()) return missing("node", e.node.value, scene_.nodes.size());
        return swap(e, scene_.nodes[e.node.value], e.value);
    }
    Result make(AddNode& e) {
        scene_.nodes.push_back(std::move(e.value));
        return {};
    }
    Result make(SetRoots& e) { return swap(e, scene_.roots, e.roots); }
    Result make(SetCamera& e) {
        if (!e.camera) return "the camera cannot be taken away";
        return swap(e, scene_.camera, e.camera);
    }
    Result make(SetEnvironment& e) { return swap(e, scene_.environment, e.environment); }
    Result make(SetSettings& e) { return swap(e, scene_.settings, e.settings); }

    Scene& scene_;
    std::vector<Edit> undo_;
    std::vector<ShapeId> shapes_;  // that are new
};

}  // namespace

Expected<std::vector<Edit>> apply(std::vector<Edit> edits, Scene& scene, const std::string& file) {
    const std::size_t shapes = scene.shapes.size(), materials = scene.materials.size(), nodes = scene.nodes.size();
    Editor editor(scene);
    Problems problems;
    for (std::size_t i = 0; i < edits.size(); ++i) {
        if (auto wrong = editor.make(edits[i])) problems.push_back({file, "edit " + std::to_string(i + 1), std::move(*wrong), {}});
    }
    const Problems broken = validate_edited(scene, file, editor.shapes());
    problems.insert(problems.end(), broken.begin(), broken.end());
    std::vector<Edit> undo = editor.undo();
    if (problems.empty()) {
        for (const ShapeId shape : editor.shapes()) geometry::prepare(scene.shapes[shape.value].shape);
        return undo;
    }
    Editor undoing(scene);
    for (Edit& edit : undo) undoing.make(edit);
    scene.shapes.resize(shapes), scene.materials.resize(materials), scene.nodes.resize(nodes);
    return tl::unexpected(Error{ErrorKind::input, std::move(problems)});
}

void apply_unchecked(std::vector<Edit> edits, Scene& scene) {
    Editor editor(scene);
    for (Edit& edit : edits) editor.make(edit);
}

}  // namespace crescente::scene
