// Walking the hierarchy of a scene.
#pragma once

#include "scene/scene.h"

namespace crescente::scene {

template <class Visit>
void for_each_appearance(const Scene& scene, Visit&& visit) {
    struct Place {
        NodeId node;
        math::Affine to_world;                        // of the parent
        const std::vector<MaterialId>* materials;     // of the nearest node above that names some
    };
    static const std::vector<MaterialId> no_materials;
    std::vector<Place> open;
    for (auto root = scene.roots.rbegin(); root != scene.roots.rend(); ++root) open.push_back({*root, {}, &no_materials});
    while (!open.empty()) {
        const Place place = open.back();
        open.pop_back();
        const Node& node = scene.nodes[place.node.value];
        if (!node.visible) continue;
        const math::Affine to_world = place.to_world * node.transform;
        const auto* materials = node.materials.empty() ? place.materials : &node.materials;
        if (node.shape.valid()) visit(place.node.value, to_world, *materials);
        for (auto child = node.children.rbegin(); child != node.children.rend(); ++child) open.push_back({*child, to_world, materials});
    }
}

}  // namespace crescente::scene
