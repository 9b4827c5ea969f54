// The options that say where a picture goes and how it is written, shared by `render` and `edit`.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "base/error.h"
#include "io/image_file.h"
#include "scene/scene.h"

namespace crescente::app {

struct PictureOptions {
    std::vector<std::string> outputs;
    std::string tonemap;  // empty: as the scene's settings say
    std::optional<std::string> exposure;  // stops, or "auto"
    int bits = 8;
};

// Declares the options; `options` must outlive the parsing. `required`: a picture must be asked for.
void add_picture_options(CLI::App& command, PictureOptions& options, bool required);

// Collects what makes files unwritable, before anything is rendered.
class OutputCheck {
public:
    void add(const Expected<void>& writable);
    Expected<void> result() const;

private:
    Error unwritable_{ErrorKind::output, {}};
};

// EXR keeps every layer; the other formats show the first.
bool needs_all_layers(const std::vector<std::string>& outputs);

// How pictures of the scene are written.
io::ImageOptions image_options(const PictureOptions& options, const scene::Scene& scene, const scene::Image& picture);

// The fastest way to the finished picture, where nobody watches it grow and nobody comes back to the rays. `trees_needed`: the finished picture is made of all trees (layers, replay).
void prefer_finish(scene::Settings& settings, bool trees_needed);

// Every output that cannot keep the alpha channel that the scene's background asks for.
Expected<void> check_alpha(const std::vector<std::string>& outputs, const scene::Scene& scene);

}  // namespace crescente::app
