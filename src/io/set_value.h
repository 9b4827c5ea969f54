// One value of a scene by its path: material.chrome.roughness. What `--set` and edits have in common.
#pragma once

#include "io/json_fields.h"
#include "scene/draft.h"

namespace crescente::io {

// Sets what "what.field" or "what.name.field" means, where what is settings, camera, environment, light, material or shape. The field is what stands
// after the last dot, so that names may have dots; a name may also stand in double quotes. Unnamed things go by their index. Things of the same name
// change together. Values are as in a scene file; lengths in the scene's unit, axes its own, y up.
// Problems, at `place`: any part not known, with the nearest spelling; a value of the wrong type or out of range; a camera where the scene has none. The
// draft may then be changed in part.
void set_value(scene::Draft& draft, std::string_view path, const Json& value, const Measure& measure, const Place& place, ProblemList& problems);

}  // namespace crescente::io
