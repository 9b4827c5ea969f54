#include "app/server/studio_edits.h"

#include <algorithm>

#include "base/spelling.h"

namespace crescente::app {
namespace {

Expected<scene::Placement> placement(const scene::Scene& scene) {
    const scene::Placement at(scene);
    if (!scene::can_be_framed(at.box)) return failure(ErrorKind::input, {"", "", "the scene is empty, or too large to be lit", ""});
    return at;
}

// The ground of `fitted`, which has nothing else, in place of the one that is there.
void replace_ground(const scene::Scene& scene, scene::Scene& fitted, std::vector<scene::Edit>& edits) {
    std::vector<scene::NodeId> roots = scene.roots;
    std::erase_if(roots, [&](scene::NodeId root) { return scene::is_studio_ground(scene.nodes[root.value]); });
    const auto nodes = static_cast<std::uint32_t>(scene.nodes.size()), shapes = static_cast<std::uint32_t>(scene.shapes.size()), materials = static_cast<std::uint32_t>(scene.materials.size());
    for (scene::Material& material : fitted.materials) edits.push_back(scene::AddMaterial{std::move(material)});
    for (scene::NamedShape& shape : fitted.shapes) edits.push_back(scene::AddShape{std::move(shape)});
    for (scene::Node& node : fitted.nodes) {
        node.shape.value += shapes;
        for (scene::MaterialId& id : node.materials) id.value += materials;
        edits.push_back(scene::AddNode{std::move(node)});
    }
    for (const scene::NodeId root : fitted.roots) roots.push_back({root.value + nodes});
    edits.push_back(scene::SetRoots{std::move(roots)});
}

}  // namespace

Expected<std::vector<scene::Edit>> studio_edits(const scene::Scene& scene, const std::optional<std::string>& name) {
    scene::Scene studio;  // what is without geometry: it is fitted to the model's box
    studio.camera = scene.camera;
    if (name) {
        const auto found = std::find(std::begin(scene::studio_names), std::end(scene::studio_names), *name);
        if (found == std::end(scene::studio_names)) {
            const std::vector<std::string> known(std::begin(scene::studio_names), std::end(scene::studio_names));
            return failure(ErrorKind::input, {"", "/studio", "there is no studio '" + name->substr(0, 300) + "'", spelling_hint(name->substr(0, 300), known)});
        }
        const auto at = placement(scene);
        if (!at) return tl::unexpected(at.error());
        scene::add_studio_lights(studio, *at, static_cast<scene::Studio>(found - std::begin(scene::studio_names)));
        const scene::Ground ground = scene::ground_of(scene);
        scene::add_ground(studio, *at, ground == scene::Ground::none ? scene::Ground::studio : ground);
    }
    std::vector<scene::Edit> edits;
    for (auto i = static_cast<std::uint32_t>(scene.lights.size()); i > 0; --i) edits.push_back(scene::RemoveLight{i - 1});
    for (std::uint32_t i = 0; i < studio.lights.size(); ++i) edits.push_back(scene::InsertLight{i, studio.lights[i]});
    edits.push_back(scene::SetEnvironment{studio.environment});
    replace_ground(scene, studio, edits);
    return edits;
}

Expected<std::vector<scene::Edit>> ground_edits(const scene::Scene& scene, scene::Ground ground) {
    scene::Scene fitted;
    fitted.camera = scene.camera;
    if (ground != scene::Ground::none) {
        const auto at = placement(scene);
        if (!at) return tl::unexpected(at.error());
        scene::add_ground(fitted, *at, ground);
    }
    std::vector<scene::Edit> edits;
    replace_ground(scene, fitted, edits);
    return edits;
}

}  // namespace crescente::app
