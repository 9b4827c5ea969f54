// Mesh formats read by Assimp. Units, axes and materials of each are in docs/formats.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/formats.h"

namespace crescente::io {

// Errors: what Assimp or the checks after it find wrong (input); this build is without Assimp (unsupported).
Expected<Loaded> read_mesh_file(const std::filesystem::path& file);

// The same from memory. The extension of `file_name` says the format; files that the file names are looked for in `folder` and below.
Expected<Loaded> read_mesh(std::string_view bytes, const std::string& file_name, const std::filesystem::path& folder);

}  // namespace crescente::io
