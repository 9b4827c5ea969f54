// glTF 2.0, as text (.gltf) and binary (.glb). What is read and what is told to be ignored is in docs/formats.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/formats.h"

namespace crescente::io {

// Errors: what is wrong with the file, with JSON pointers (input); required extensions that are not supported (unsupported).
Expected<Loaded> read_gltf_file(const std::filesystem::path& file);

// The same from memory, text or binary. Buffers and images that it names are looked for in `folder` and below.
Expected<Loaded> read_gltf(std::string_view bytes, const std::string& file_name, const std::filesystem::path& folder);

}  // namespace crescente::io
