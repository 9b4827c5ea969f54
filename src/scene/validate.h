// Whether a scene can be rendered: every problem at once.
#pragma once

#include <span>

#include "base/error.h"
#include "scene/scene.h"

namespace crescente::scene {

// Ranges of every field (from the field tables), indices, cycles in the hierarchy, singular transforms, non-finite or degenerate
// geometry, directions of zero length, a camera that looks nowhere, picture sizes. `file` is named in the problems. The
// places are JSON pointers as in a native scene ("/materials/chrome/ior"); unnamed things are named by their index.
Problems validate(const Scene& scene, const std::string& file);

// The same after edits of a valid scene: of the shapes only those that are named are looked at, and nothing need be visible.
Problems validate_edited(const Scene& scene, const std::string& file, std::span<const ShapeId> edited);

}  // namespace crescente::scene
