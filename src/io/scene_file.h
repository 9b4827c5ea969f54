// The native scene format: JSON with comments (docs/scene_format.md).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"
#include "io/formats.h"
#include "scene/scene.h"

namespace crescente::io {

// Reads a scene file and the model files that it refers to, each once. Errors (input): all problems of all files, with line and JSON
// pointer; files that refer to each other in a ring, with the chain. The scene is not validated yet (scene/validate.h).
Expected<Loaded> read_scene_file(const std::filesystem::path& file, const ReadOptions& options = {});

// The same from memory: `name` stands for the file in problems, `folder` is where relative paths begin.
Expected<Loaded> read_scene_text(std::string_view text, const std::string& name, const std::filesystem::path& folder);

// The scene as a text that reads back to an equal scene: same values to the bit, same names, same sharing. Lengths are written in
// scene.unit where that is a unit of the format, else in metres; a length that no number of that unit gives exactly is rounded
// to the nearest. What came from other files is written out, but for exact faces of CAD files, which refer to theirs; each of them must have a source.
// The scene must be valid.
std::string write_scene_text(const scene::Scene& scene, const ShapeSources& sources = {});

// The same into a file, which refers to model files in its folder, or below, by where they are from there. Errors (output): it cannot be written.
Expected<void> write_scene_file(const std::filesystem::path& file, const scene::Scene& scene, ShapeSources sources = {});

}  // namespace crescente::io
