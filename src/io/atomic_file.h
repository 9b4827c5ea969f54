// Writing a file so that its place holds the old file or the whole new one, whatever happens.
#pragma once

#include <filesystem>
#include <string_view>

#include "base/error.h"

namespace crescente::io {

// Whether `file` could be written by write_atomically: an existing folder with permission, no folder or device of that name, not
// write-protected. Leaves no trace. Errors: output.
Expected<void> can_write_file(const std::filesystem::path& file);

// Writes beside the final place, syncs to disk and renames. A symbolic link is followed. On failure the new file is removed and
// the old one stays untouched. Errors: output, with the system's reason.
Expected<void> write_atomically(const std::filesystem::path& file, std::string_view content);

}  // namespace crescente::io
