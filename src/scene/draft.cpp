#include "scene/draft.h"

#include <algorithm>

namespace crescente::scene {
namespace {

// Lights that are the same at the beginning and at the end of both lists stay; those between are set, as far as both have them, then removed or inserted.
void add_light_edits(const std::vector<Light>& before, const std::vector<Light>& now, std::vector<Edit>& edits) {
    const std::size_t both = std::min(before.size(), now.size());
    std::size_t head = 0, tail = 0;
    while (head < both && before[head] == now[head]) ++head;
    while (tail < both - head && before[before.size() - 1 - tail] == now[now.size() - 1 - tail]) ++tail;
    std::size_t i = head;
    for (; i < both - tail; ++i) edits.emplace_back(SetLight{static_cast<std::uint32_t>(i), now[i]});
    for (std::size_t k = i; k < before.size() - tail; ++k) edits.emplace_back(RemoveLight{static_cast<std::uint32_t>(i)});
    for (std::size_t k = i; k < now.size() - tail; ++k) edits.emplace_back(InsertLight{static_cast<std::uint32_t>(k), now[k]});
}

}  // namespace

Draft::Draft(const Scene& scene)
    : shapes(scene.shapes), materials(scene.materials), nodes(scene.nodes), roots(scene.roots), lights(scene.lights), camera(scene.camera),
      environment(scene.environment), settings(scene.settings), scene_(&scene) {}

std::vector<Edit> Draft::edits() const {
    std::vector<Edit> edits;
    for (const NamedShape& shape : shapes.added()) edits.emplace_back(AddShape{shape});
    for (const Material& material : materials.added()) edits.emplace_back(AddMaterial{material});
    for (const Node& node : nodes.added()) edits.emplace_back(AddNode{node});
    for (const auto& [index, shape] : shapes.changed()) edits.emplace_back(SetShape{{index}, shape.shape});
    for (const auto& [index, material] : materials.changed()) edits.emplace_back(SetMaterial{{index}, material});
    for (const auto& [index, node] : nodes.changed()) edits.emplace_back(SetNode{{index}, node});
    if (roots != scene_->roots) edits.emplace_back(SetRoots{roots});
    add_light_edits(scene_->lights, lights, edits);
    if (camera != scene_->camera) edits.emplace_back(SetCamera{camera});
    if (environment != scene_->environment) edits.emplace_back(SetEnvironment{environment});
    if (settings != scene_->settings) edits.emplace_back(SetSettings{settings});
    return edits;
}

}  // namespace crescente::scene
