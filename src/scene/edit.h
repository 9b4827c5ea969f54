// Edits of a scene: new values for the things in it.
//
// Nodes, shapes and materials keep their index for good: a thing that is removed is only no longer referred to, so that undo finds it again.
#pragma once

#include <span>
#include <variant>

#include "base/error.h"
#include "scene/scene.h"

namespace crescente::scene {

struct SetMaterial {
    MaterialId material;
    Material value;
};
struct AddMaterial {  // as the last one
    Material value;
};
struct SetLight {
    std::uint32_t light;
    Light value;
};
struct InsertLight {
    std::uint32_t before;  // index that it gets
    Light value;
};
struct RemoveLight {
    std::uint32_t light;
};
struct SetShape {
    ShapeId shape;
    geometry::Shape value;
};
struct AddShape {  // as the last one
    NamedShape value;
};
struct SetNode {  // moves, shows, hides, gives materials, adds and removes children
    NodeId node;
    Node value;
};
struct AddNode {  // as the last one; shown as soon as another edit names it as a child or root
    Node value;
};
struct SetRoots {
    std::vector<NodeId> roots;
};
struct SetCamera {
    std::optional<Camera> camera;
};
struct SetEnvironment {
    std::optional<Environment> environment;
};
struct SetSettings {
    Settings settings;
};

using Edit = std::variant<SetMaterial, AddMaterial, SetLight, InsertLight, RemoveLight, SetShape, AddShape, SetNode, AddNode, SetRoots, SetCamera,
                          SetEnvironment, SetSettings>;

// Applies edits to a valid scene, one after the other; shapes are prepared for tracing. Returns what undoes them, in the order in which it is to be
// applied; what was added stays, but is no longer referred to. Errors (input): every problem, with `file` and its place; the scene is then as it
// was but for what was added, to which nothing refers.
Expected<std::vector<Edit>> apply(std::vector<Edit> edits, Scene& scene, const std::string& file = {});

// The same for a scene that is still to be validated: only what the edits name must be there, and shapes are not prepared. An edit that names what is
// not there does nothing.
void apply_unchecked(std::vector<Edit> edits, Scene& scene);

}  // namespace crescente::scene
