// Whole files in memory, and where the files that a file names may lie.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "base/error.h"

namespace crescente::io {

// The bytes of a regular file. Errors: missing, not readable, a folder or device (input), larger than memory (resource). `file` is
// named in the problem as given.
Expected<std::string> read_whole_file(const std::filesystem::path& file);

// Whether a name found inside a file is a relative path that stays in the folder: no root, no drive, no scheme (http:), no "..".
// A file from a stranger must not make the program read what lies elsewhere.
bool stays_in_folder(std::string_view name);

}  // namespace crescente::io
