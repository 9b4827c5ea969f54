#include "app/server/studio_edits.h"

#include <algorithm>

#include "base/spelling.h"
#include "scene/studio.h"

namespace crescente::app {

Expected<std::vector<scene::Edit>> studio_edits(const scene::Scene& scene, const std::optional<std::string>& name) {
    // What is without geometry: the studio is fitted to the model's box.
    scene::Scene studio;
    studio.camera = scene.camera;
    if (name) {
        const auto found = std::find(std::begin(scene::studio_names), std::end(scene::studio_names), *name);
        if (found == std::end(scene::studio_names)) {
            const std::vector<std::string> known(std::begin(scene::studio_names), std::end(scene::studio_names));
            return failure(ErrorKind::input, {"", "/studio", "there is no studio '" + name->substr(0, 300) + "'", spelling_hint(name->substr(0, 300), known)});
        }
        const scene::Placement at(scene);
        if (!scene::can_be_framed(at.box)) return failure(ErrorKind::input, {"", "/studio", "the scene is empty, or too large to be lit", ""});
        scene::add_studio_lights(studio, at, static_cast<scene::Studio>(found - std::begin(scene::studio_names)));
        scene::add_ground(studio, at, scene::Ground::studio);
    }

    std::vector<scene::Edit> edits;
    for (auto i = static_cast<std::uint32_t>(scene.lights.size()); i > 0; --i) edits.push_back(scene::RemoveLight{i - 1});
    for (std::uint32_t i = 0; i < studio.lights.size(); ++i) edits.push_back(scene::InsertLight{i, studio.lights[i]});
    edits.push_back(scene::SetEnvironment{studio.environment});
    std::vector<scene::NodeId> roots = scene.roots;
    std::erase_if(roots, [&](scene::NodeId root) { return scene::is_studio_ground(scene.nodes[root.value]); });
    const auto nodes = static_cast<std::uint32_t>(scene.nodes.size()), shapes = static_cast<std::uint32_t>(scene.shapes.size()), materials = static_cast<std::uint32_t>(scene.materials.size());
    for (const scene::Material& material : studio.materials) edits.push_back(scene::AddMaterial{material});
    for (const scene::NamedShape& shape : studio.shapes) edits.push_back(scene::AddShape{shape});
    for (scene::Node node : studio.nodes) {
        node.shape.value += shapes;
        for (scene::MaterialId& id : node.materials) id.value += materials;
        edits.push_back(scene::AddNode{std::move(node)});
    }
    for (const scene::NodeId root : studio.roots) roots.push_back({root.value + nodes});
    edits.push_back(scene::SetRoots{std::move(roots)});
    return edits;
}

}  // namespace crescente::app
