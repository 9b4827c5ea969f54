// The studio of a bare model: camera, lights, ground and backdrop fitted to its size (docs/studio.md).
#pragma once

#include "scene/scene.h"

namespace crescente::scene {

// Adds what is missing: a camera that frames what is visible when the scene has none; lights, ground and environment when it has
// no light of its own. The scene must not be empty.
void add_studio(Scene& scene);

}  // namespace crescente::scene
