// The studio of a bare model: camera, lights, ground and backdrop fitted to its size (docs/studio.md).
#pragma once

#include <string_view>

#include "scene/scene.h"

namespace crescente::scene {

// Whether camera, lights and ground can be fitted to a scene of these bounds: there is something, and squares of its lengths are numbers.
bool can_be_framed(const math::Bounds& everything);

// How a bare model is lit. `points` makes soft light of many point lights, for the levels that sample none; the others are of a few lights with extent.
enum class Studio { points, softbox, three_point, overhead, tent };
inline constexpr std::string_view studio_names[] = {"points", "softbox", "three-point", "overhead", "tent"};

// Adds what is missing: a camera that frames what is visible when the scene has none; lights, ground and environment when it has
// no light of its own, or when a studio is asked for. The scene must be valid, and can_be_framed() true of its bounds.
void add_studio(Scene& scene, std::optional<Studio> asked = {});

}  // namespace crescente::scene
