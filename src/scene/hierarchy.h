// Walking the hierarchy of a scene.
#pragma once

#include "math/mix_bits.h"
#include "scene/scene.h"

namespace crescente::scene {

// A visible node with a shape, in one of the places where the hierarchy shows it.
struct Appearance {
    std::uint32_t node;
    math::Affine to_world;
    const std::vector<MaterialId>* materials;  // of the nearest node from it upwards that names some
    std::uint64_t identity;                    // hash of the way down to it, the same whatever else the scene shows; a child listed twice: the same
};

// Calls visit(Appearance) in the order of the hierarchy (parents before children, as listed). The scene must have passed validate().
template <class Visit>
void walk_appearances(const Scene& scene, Visit&& visit) {
    static const std::vector<MaterialId> no_materials;
    std::vector<Appearance> open;
    const auto open_all = [&](const std::vector<NodeId>& list, const math::Affine& to_world, const std::vector<MaterialId>* materials, std::uint64_t identity) {
        for (auto child = list.rbegin(); child != list.rend(); ++child) {
            open.push_back({child->value, to_world, materials, math::mix_bits(identity + child->value + 1)});
        }
    };
    open_all(scene.roots, {}, &no_materials, 0);
    while (!open.empty()) {
        Appearance at = open.back();  // to_world and materials are still those above the node
        open.pop_back();
        const Node& node = scene.nodes[at.node];
        if (!node.visible) continue;
        at.to_world = at.to_world * node.transform;
        if (!node.materials.empty()) at.materials = &node.materials;
        if (node.shape.valid()) visit(at);
        open_all(node.children, at.to_world, at.materials, at.identity);
    }
}

template <class Visit>
void for_each_appearance(const Scene& scene, Visit&& visit) {
    walk_appearances(scene, [&](const Appearance& at) { visit(at.node, at.to_world, *at.materials); });
}

}  // namespace crescente::scene
