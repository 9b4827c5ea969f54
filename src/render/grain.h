// Which way the grain of a brushed surface runs at a place.
#pragma once

#include <vector>

#include "render/texture_mapping.h"
#include "scene/material.h"

namespace crescente::render {

// A vector of the surface along the grain, in world space, not of unit length; zero: it has no direction there. bent: textures of the target "grain", which turn it.
Vec3 grain_direction(const scene::PhysicalMaterial& material, const std::vector<scene::TextureBinding>& bent, const TexturePoint& point);

}  // namespace crescente::render
