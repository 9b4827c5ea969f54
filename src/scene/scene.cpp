#include "scene/scene.h"

namespace crescente::scene {

math::Bounds bounds(const Scene& scene) {
    math::Bounds box;
    for_each_appearance(scene, [&](std::uint32_t node, const math::Affine& to_world, const std::vector<MaterialId>&) {
        const math::Bounds shape = geometry::bounds(scene.shapes[scene.nodes[node].shape.value].shape);
        if (shape.bounded()) box.include(transform(to_world, shape));
    });
    return box;
}

}  // namespace crescente::scene
