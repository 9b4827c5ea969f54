// Writing pictures.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "base/error.h"
#include "scene/image.h"
#include "scene/settings.h"

namespace crescente::io {

struct ImageOptions {
    scene::Tonemap tonemap = scene::Tonemap::srgb;  // must not be automatic; for display formats only: HDR and EXR stay linear
    double exposure = 0;                            // stops, display formats only
    int bits = 8;                                   // PNG and TIFF: 8 or 16
    std::map<std::string, std::string> metadata;    // written as text in the formats that keep it
};

// Finds out before rendering whether `file` can be written: known extension, existing folder, permission. Leaves no trace. `alpha`: a picture
// with an alpha channel.
Expected<void> can_write(const std::filesystem::path& file, bool alpha = false);

// Writes .png .jpg .jpeg .tif .tiff .hdr .exr. EXR gets all layers, the others the first. Alpha: multiplied in in EXR and TIFF, apart in PNG; a format that keeps none is an error (usage). The file is written beside its final place
// and renamed: whatever happens, `file` is the old one or the whole new one.
Expected<void> write_image(const scene::Image& image, const std::filesystem::path& file, const ImageOptions& options);

}  // namespace crescente::io
