// What the camera would be focused on.
#pragma once

#include <optional>

#include "base/error.h"
#include "scene/scene.h"

namespace crescente::render {

// Distance along the view, metres, of what the camera sees in the middle of the picture when the shutter opens; nothing: it is the background. Builds the acceleration
// structure for one ray. The scene must be valid and have a camera; it stays as it is, unless there is an error: as of Session::open.
Expected<std::optional<double>> distance_in_the_middle(scene::Scene& scene);

}  // namespace crescente::render
