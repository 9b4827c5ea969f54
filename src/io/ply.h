// Polygon File Format (Turk 1994, "The PLY Polygon File Format"), text and binary of either byte order. Units, axes and colours:
// docs/formats.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/formats.h"

namespace crescente::io {

// Errors (input): damaged or cut files, coordinates that are not finite, no face.
Expected<Loaded> read_ply_file(const std::filesystem::path& file);

// The same from memory; `file_name` is named in the problems.
Expected<Loaded> read_ply(std::string_view bytes, const std::string& file_name);

}  // namespace crescente::io
