// Changes to a scene from the command line: --set material.chrome.roughness=0.1
#pragma once

#include <string_view>

#include "base/error.h"
#include "scene/scene.h"

namespace crescente::io {

// Applies "what.field=value" or "what.name.field=value" to the scene, where what is settings, camera, environment, light, material or shape.
// The field is what stands after the last dot, so that names may have dots; a name may also stand in double quotes. Unnamed things go
// by their index. Things of the same name change together. Values are as in a scene file (docs/scene_format.md), also without quotes
// and brackets: 0.1, 1,2,3, #ff8800, orthographic. Lengths are in scene.unit; axes are the scene's own, y up.
// Errors (usage): any part not known, with the nearest spelling; a value of the wrong type or out of range; a camera where the scene
// has none. The scene is then unchanged.
// Returns warnings.
Expected<Problems> apply_override(scene::Scene& scene, std::string_view assignment);

}  // namespace crescente::io
