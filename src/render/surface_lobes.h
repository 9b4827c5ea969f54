// What a surface is made of where a ray met it: the lobes of its material there. The one place that asks textures; whoever needs lobes of a node asks here, and
// not World::lobes, which has what the material says without its textures.
#pragma once

#include <new>
#include <type_traits>

#include "render/forest.h"
#include "render/textured_material.h"
#include "render/world.h"

namespace crescente::render {

// Room for lobes that textures make. Lobes are large: it is not cleared, as even an empty std::optional would be (gcc, PR 86173).
class TexturedLobes {
public:
    TexturedLobes() {}
    const Lobes& keep(const TexturedMaterial& material, const TexturePoint& point) { return *::new (&lobes_) Lobes(material.lobes_at(point)); }

private:
    static_assert(std::is_trivially_copyable_v<Lobes>);
    union {
        Lobes lobes_;
    };
};

// Of any place: `scratch` keeps the answer where the material has textures.
inline const Lobes& lobes_at(const World& world, std::uint32_t material, const TexturePoint& point, TexturedLobes& scratch) {
    const TexturedMaterial* textured = world.textured_material(material);
    return textured ? scratch.keep(*textured, point) : world.lobes[material];
}

// Of a node that did not leave the scene. Derived from the tile's nodes alone: from where it is and the path that leads there.
const Lobes& lobes_of(const World& world, const Tile& tile, std::uint32_t node, TexturedLobes& scratch);

// Whether the coat of a material may have another normal than what is below.
inline bool has_own_coat(const World& world, std::uint32_t material) {
    const TexturedMaterial* textured = world.textured_material(material);
    return textured && textured->has_own_coat();
}

// The node as its textures see it.
TexturePoint texture_point(const World& world, const Tile& tile, std::uint32_t node);

// A place where a ray met something, or passes through it; path: length of the way from the camera to where the ray starts, m.
TexturePoint texture_point(const World& world, const geometry::Ray& ray, const accel::Hit& hit, double path);

// Length of the path from the camera to the node, m.
double path_length(const World& world, const Tile& tile, std::uint32_t node);

// Gives the node, whose normal is that of the surface without relief, the one that its material's relief gives it.
void bend_normal(const World& world, Tile& tile, std::uint32_t node);

}  // namespace crescente::render
