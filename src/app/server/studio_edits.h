// Another studio for a scene that is being rendered.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/edit.h"

namespace crescente::app {

// Edits that put the studio's lights, surroundings and ground in place of all lights, the environment and the studio's ground that are there; without a name they only take those away. The scene must
// have a camera. Errors (input): there is no studio of that name, the scene cannot be framed.
Expected<std::vector<scene::Edit>> studio_edits(const scene::Scene& scene, const std::optional<std::string>& name);

}  // namespace crescente::app
