// The options that say what is rendered and how, shared by `render` and `bench`.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "app/cli/lens_options.h"
#include "app/cli/view.h"
#include "base/error.h"
#include "scene/studio.h"

namespace crescente::app {

// As the user wrote them.
struct SceneOptions {
    std::string file;
    std::map<std::string, std::optional<std::string>> settings;  // field of scene::Settings -> value
    std::optional<std::string> size, memory, supersampling;
    std::optional<std::string> camera, field_of_view, environment, sky;
    bool orthographic = false;
    LensOptions lens;
    std::vector<std::string> overrides;  // --set path=value
    std::optional<std::string> studio, ground, background;
    bool no_studio = false, no_cache = false, verbose = false;
    std::string missing_textures = "error";
};

// Declares the options; `options` must outlive the parsing.
void add_scene_options(CLI::App& command, SceneOptions& options);

// What they ask for, understood and within range.
struct SceneRequest {
    std::string file;
    std::vector<std::pair<const Field<scene::Settings>*, FieldValue>> settings;
    View view;
    LensRequest lens;
    std::optional<std::string> environment;  // a picture's file
    std::optional<std::string> sky;          // where the sun stands, as scene::daylight_of reads it
    std::vector<std::string> overrides;
    std::optional<scene::Studio> asked_studio;
    std::optional<scene::Ground> ground;
    struct Background {
        std::optional<math::Rgb> color;  // none: transparent
    };
    std::optional<Background> background;
    bool studio = true, cache = true, verbose = false;
    bool texture_pattern = false;
};

// Every problem of the options at once (ErrorKind::usage).
Expected<SceneRequest> understand(const SceneOptions& options);

}  // namespace crescente::app
