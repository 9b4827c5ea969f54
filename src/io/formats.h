// The table of formats: the one place that knows which file is read by what.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "scene/scene.h"

namespace crescente::io {

// A scene read from a file, with what the reader could not honour (textures, animations, repaired faces).
struct Loaded {
    scene::Scene scene;
    Problems warnings;
};

struct Format {
    std::string name;                     // "NFF"
    std::vector<std::string> extensions;  // lower case, with the dot
    std::string doc;                      // units, axes, what is read: one paragraph for the manual
    Expected<Loaded> (*read)(const std::filesystem::path& file);
};

std::span<const Format> formats();

// Reads any format, chosen by extension. Errors: missing file, unknown extension (with what is known), and what the reader finds. The scene
// is not validated yet (scene/validate.h).
Expected<Loaded> read_scene(const std::filesystem::path& file);

}  // namespace crescente::io
