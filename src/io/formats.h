// The table of formats: the one place that knows which file is read by what.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/log.h"
#include "io/cad_model.h"
#include "scene/scene.h"

namespace crescente::io {

// Where the exact faces of a shape are to be had again: they are known by their file alone.
struct ShapeSource {
    std::filesystem::path file;
    std::uint32_t index = 0;  // among the shapes that the file is read as
};
using ShapeSources = std::map<std::uint32_t, ShapeSource>;  // by index of the shape in the scene, which it keeps for good

// A scene read from a file, with what the reader could not honour (textures, animations, repaired faces).
struct Loaded {
    scene::Scene scene;
    Problems warnings;
    std::optional<CadCounts> cad = {};  // of CAD files: their faces by kind
    ShapeSources sources = {};          // of all shapes that are Breps
};

// What reading a file may use and tell. Formats that are read at once make nothing of it.
struct ReadOptions {
    bool cache = true;                                                      // CAD files may be kept and found in the user's cache
    std::function<void(double fraction, std::string_view stage)> progress;  // called now and then, by the calling thread; may be empty
    std::function<bool()> cancelled;                                        // asked now and then; true ends the reading with an error
    LogSink log;                                                            // what libraries have to say; may be empty
    bool texture_pattern = false;                                           // see TextureOptions::pattern
};

struct Format {
    std::string name;                     // "NFF"
    std::vector<std::string> extensions;  // lower case, with the dot
    std::string doc;                      // units, axes, what is read: one paragraph for the manual
    Expected<Loaded> (*read)(const std::filesystem::path& file, const ReadOptions& options);
};

std::span<const Format> formats();

// Reads any format, chosen by extension, and the pictures of its textures; exact shapes are told with their sources. Errors: missing file, unknown extension (with what is known), and what the reader finds. The scene
// is not validated yet (scene/validate.h).
Expected<Loaded> read_scene(const std::filesystem::path& file, const ReadOptions& options = {});

}  // namespace crescente::io
