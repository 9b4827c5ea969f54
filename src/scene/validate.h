// Whether a scene can be rendered: every problem at once.
#pragma once

#include "base/error.h"
#include "scene/scene.h"

namespace crescente::scene {

// Ranges of every field (from the field tables), indices, cycles in the hierarchy, singular transforms, non-finite or degenerate
// geometry, directions of zero length, a camera that looks nowhere, picture sizes. `file` is named in the problems. The
// places are JSON pointers as in a native scene ("/materials/chrome/ior"); unnamed things are named by their index.
Problems validate(const Scene& scene, const std::string& file);

}  // namespace crescente::scene
