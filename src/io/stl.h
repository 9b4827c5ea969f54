// Stereolithography, text and binary (3D Systems 1989). Units, axes and normals: docs/formats.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/formats.h"

namespace crescente::io {

// Errors (input): damaged or cut files, coordinates that are not finite, no triangle.
Expected<Loaded> read_stl_file(const std::filesystem::path& file);

// The same from memory; `file_name` is named in the problems.
Expected<Loaded> read_stl(std::string_view bytes, const std::string& file_name);

}  // namespace crescente::io
