// Another studio for a scene that is being rendered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/edit.h"
#include "scene/studio.h"

namespace crescente::app {

// Edits that put the studio's lights and surroundings in place of all lights and the environment that are there, and its ground if none was wanted otherwise; without a name they take away lights,
// surroundings and the studio's ground. The scene must have a camera. Errors (input): there is no studio of that name, the scene cannot be framed.
Expected<std::vector<scene::Edit>> studio_edits(const scene::Scene& scene, const std::optional<std::string>& name);

// Edits that put another ground in place of the studio's that is there. Errors (input): the scene cannot be framed.
Expected<std::vector<scene::Edit>> ground_edits(const scene::Scene& scene, scene::Ground ground);

}  // namespace crescente::app
