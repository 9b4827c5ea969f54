// The studio of a bare model: camera, lights, ground and backdrop fitted to its size (docs/studio.md).
#pragma once

#include "scene/scene.h"

namespace crescente::scene {

// Whether camera, lights and ground can be fitted to a scene of these bounds: there is something, and squares of its lengths are numbers.
bool can_be_framed(const math::Bounds& everything);

// Adds what is missing: a camera that frames what is visible when the scene has none; lights, ground and environment when it has
// no light of its own. The scene must be valid, and can_be_framed() true of its bounds.
void add_studio(Scene& scene);

}  // namespace crescente::scene
