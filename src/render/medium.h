// Bodies that absorb: what the media on the way of a ray take of its light (Bouguer 1729, Lambert 1760, Beer 1852).
//
// A medium is the inside of an instance whose material lets light in and has an attenuation. Surfaces are taken at their word: the geometric
// normal points outward. A ray is in a body from the crossing where it enters to the next crossing of the same instance; a crossing where
// it leaves a body that it was not known to be in says that it was in it from its start. Where bodies overlap each absorbs on its own. A ray
// that leaves the scene is not attenuated on its last way.
#pragma once

#include <span>

#include "accel/accelerator.h"
#include "render/forest.h"

namespace crescente::render {

struct World;

// A body that a ray is in.
struct Medium {
    std::uint32_t instance;
    Rgb attenuation;   // 1/m
    double since = 0;  // where the ray came into it, m along the ray
};

// The bodies that the camera is in; none for an orthographic one, whose rays start in many places.
std::vector<Medium> media_around_camera(const World& world);

// Share of light that is left at the end of the ray of this length (m) that ended at the node.
Rgb transmittance(const World& world, const Tile& tile, std::uint32_t node, double length);

// What passes all the crossings of a ray from the node to a light, in the order of `accel::before`: the filters of the surfaces, and
// the media between them. ray.t_max is the distance of the light.
Rgb passage(const World& world, const Tile& tile, std::uint32_t node, std::span<const accel::Crossing> crossings, const geometry::Ray& ray);

// The same for a ray that starts anywhere: of the bodies that it starts in those are known that it leaves. straight_only: surfaces that bend light let through
// what their coverage leaves alone, since bent light is looked for otherwise. path: length of the way from the camera to where the ray starts, m.
Rgb passage(const World& world, std::span<const accel::Crossing> crossings, const geometry::Ray& ray, double path, bool straight_only);

}  // namespace crescente::render
