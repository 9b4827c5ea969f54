// A scene: plain values tied by typed indices. No pointers, no derived data. Lengths in metres, angles in radians, y up,
// right-handed; readers convert on the way in (docs/formats.md).
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "geometry/kinds.h"
#include "math/transform.h"
#include "scene/camera.h"
#include "scene/environment.h"
#include "scene/light.h"
#include "scene/material.h"
#include "scene/settings.h"

namespace crescente::scene {

template <class Tag>
struct Index {
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    std::uint32_t value = none;
    constexpr bool valid() const { return value != none; }
    constexpr bool operator==(const Index&) const = default;
};
using ShapeId = Index<struct ShapeTag>;
using MaterialId = Index<struct MaterialTag>;
using NodeId = Index<struct NodeTag>;

// A named shape, so that several nodes can show it.
struct NamedShape {
    std::string name;
    geometry::Shape shape;
};

// A place in the hierarchy: a shape, a group, or both. A node that is the child of several nodes is an instance in each of
// those places; its shape is kept once. The nodes must form a directed acyclic graph.
struct Node {
    std::string name;
    math::Affine transform;              // to the parent's space
    ShapeId shape;                       // none: a group
    std::vector<MaterialId> materials;   // by the shape's material slot; empty: the parent's, at the root the default material
    std::vector<NodeId> children;
    bool visible = true;                 // false hides the node and everything below
    std::optional<math::Affine> motion = {};  // to where it is at the end of the motion's time, in its own space, before `transform`; none: it stands still
};

// How the file that a scene came from measures; kept to write it back and to show lengths as the user knows them.
struct Unit {
    std::string name = "m";
    double metres = 1;
};

struct Scene {
    std::string name;
    Unit unit;
    std::deque<NamedShape> shapes;  // which keep their places when more are added
    std::vector<Material> materials;
    std::vector<Node> nodes;
    std::vector<NodeId> roots;
    std::vector<Light> lights;
    std::optional<Camera> camera;            // none: a bare model is framed (scene/studio.h)
    std::optional<Environment> environment;  // none: black, or the studio's
    Settings settings;
};

// The box of everything visible and bounded, in world space.
math::Bounds bounds(const Scene& scene);

// Calls visit(node index, transform to world, inherited materials) for each visible appearance of a node with a shape, in the order of
// the hierarchy (parents before children, as listed). The scene must have passed validate().
template <class Visit>
void for_each_appearance(const Scene& scene, Visit&& visit);

}  // namespace crescente::scene

#include "scene/hierarchy.h"
