// The lens and the shutter as the command line asks for them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"

namespace crescente::app {

// As the user wrote them.
struct LensOptions {
    std::optional<std::string> aperture, focus, blades, shutter;
};

// Fields of the camera in place of what the scene says; lengths still in the unit of its file.
struct LensRequest {
    std::vector<std::pair<const Field<scene::Camera>*, FieldValue>> fields;
    bool focus_on_middle = false;  // on what the middle of the picture shows
};

// Every problem of the options at once (ErrorKind::usage).
Expected<LensRequest> parse_lens(const LensOptions& options);

// The scene must have a camera, which may then be in need of being validated.
void set_lens(const LensRequest& request, scene::Scene& scene);

// For a valid scene with a camera. Errors: usage (there is nothing in the middle to focus on), and those of building its acceleration structure.
Expected<void> focus_on_middle(scene::Scene& scene);

}  // namespace crescente::app
