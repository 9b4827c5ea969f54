// Light from where a ray leaves the scene.
#pragma once

#include "math/color.h"
#include "math/vec.h"
#include "render/lobes.h"
#include "scene/environment.h"

namespace crescente::render {

using namespace math;

// Radiance from a direction (unit): linear in the height of the direction between nadir, horizon and zenith.
Rgb environment_radiance(const scene::Environment& environment, Vec3 direction);

// Irradiance over pi on a surface with this normal (unit): the gradient convolved with the clamped cosine, in closed form.
Rgb environment_irradiance(const scene::Environment& environment, Vec3 normal);

// Radiance that a surface sends to the viewer (unit) by the light of the environment alone, without shadows: diffuse, and the
// reflection that is too blurred for a mirrored ray. inside: the viewer is in the body.
Rgb reflect_environment(const scene::Environment& environment, const Lobes& lobes, Vec3 normal, Vec3 to_viewer, bool inside);

// The backdrop at a height in the picture, 0 bottom to 1 top.
Rgb backdrop_radiance(const scene::Environment& environment, double height);

}  // namespace crescente::render
