// From a file and the options to a scene that can be rendered.
#pragma once

#include "app/cli/scene_options.h"
#include "base/error.h"
#include "io/formats.h"

namespace crescente::app {

// Reads the file, applies the options, validates, and adds the studio where something is missing. Every problem of the step that
// fails is told.
Expected<io::Loaded> load(const SceneRequest& request, const io::ReadOptions& options);

}  // namespace crescente::app
