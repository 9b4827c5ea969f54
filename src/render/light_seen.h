// Light that rays meet without meeting a surface: what surrounds the scene, and lights with extent on the way.
#pragma once

#include "render/growth.h"

namespace crescente::render {

// Of a ray that leaves the scene: a camera ray through a point of the picture, or any other ray.
Rgb sky_seen(const World& world, LatticePoint point);
Rgb sky_seen(const World& world, const geometry::Ray& ray);

// Of the lights that the ray passes which ended on the node's surface.
Rgb lights_before(const World& world, const Tile& tile, const Node& node);

}  // namespace crescente::render
