// Walking the hierarchy of a scene.
#pragma once

#include <span>

#include "math/mix_bits.h"
#include "scene/motion.h"
#include "scene/scene.h"

namespace crescente::scene {

// A visible node with a shape, in one of the places where the hierarchy shows it.
struct Appearance {
    std::uint32_t node;
    math::Affine to_world;
    const std::vector<MaterialId>* materials;  // of the nearest node from it upwards that names some
    std::uint64_t identity;                    // hash of the way down to it, the same whatever else the scene shows; a child listed twice: the same
    std::uint64_t motion = 0;                  // hash of how it moves: from the first node that does on the way down; 0: it stands still
    std::uint8_t marks = 0;                    // of it and of all nodes above, together
};

// Of a node shown by another appearance; of a root, by 0.
inline std::uint64_t identity_below(std::uint64_t parent, NodeId node) { return math::mix_bits(parent + node.value + 1); }

// Calls visit(Appearance) in the order of the hierarchy (parents before children, as listed), with all where it is at a time of its motion, 0 to 1. The scene must
// have passed validate(). `marks`: bits of each node that those below it inherit; empty: none.
template <class Visit>
void walk_appearances(const Scene& scene, double time, Visit&& visit, std::span<const std::uint8_t> marks = {}) {
    static const std::vector<MaterialId> no_materials;
    std::vector<Appearance> open;
    const auto open_all = [&](const std::vector<NodeId>& list, const math::Affine& to_world, const std::vector<MaterialId>* materials, std::uint64_t identity, std::uint64_t motion,
                              std::uint8_t inherited) {
        for (auto child = list.rbegin(); child != list.rend(); ++child) {
            const auto own = marks.empty() ? std::uint8_t{0} : marks[child->value];
            open.push_back({child->value, to_world, materials, identity_below(identity, *child), motion, static_cast<std::uint8_t>(inherited | own)});
        }
    };
    open_all(scene.roots, {}, &no_materials, 0, 0, 0);
    while (!open.empty()) {
        Appearance at = open.back();  // to_world and materials are still those above the node
        open.pop_back();
        const Node& node = scene.nodes[at.node];
        if (!node.visible) continue;
        at.to_world = at.to_world * place_at(node, time);
        if (at.motion || node.motion) at.motion = motion_below(at.motion, node);
        if (!node.materials.empty()) at.materials = &node.materials;
        if (node.shape.valid()) visit(at);
        open_all(node.children, at.to_world, at.materials, at.identity, at.motion, at.marks);
    }
}

template <class Visit>
void for_each_appearance(const Scene& scene, Visit&& visit) {
    walk_appearances(scene, 0, [&](const Appearance& at) { visit(at.node, at.to_world, *at.materials); });
}

// The nodes from a root down to the one whose appearance has this identity; of several the first. Empty: none has, or it is not visible.
std::vector<NodeId> path_to(const Scene& scene, std::uint64_t identity);

}  // namespace crescente::scene
