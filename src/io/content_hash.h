// A number that tells one file's content from another's.
#pragma once

#include <filesystem>
#include <string>

#include "base/error.h"

namespace crescente::io {

// XXH64 (Collet 2014) with seed 0 of the bytes of the file, as 16 hexadecimal digits: what `xxh64sum` prints. Files that it
// refers to do not count. Error: it cannot be read.
Expected<std::string> content_hash(const std::filesystem::path& file);

}  // namespace crescente::io
