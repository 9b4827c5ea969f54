// Neutral File Format (Haines 1987, "A Proposal for Standard Graphics Environments", IEEE CG&A 7(11); the NFF description of the
// Standard Procedural Databases, version 3.1). What each entity becomes is in docs/formats.md.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/formats.h"

namespace crescente::io {

// Errors (input): what cannot be read, with its line, at most 50 of them.
Expected<Loaded> read_nff_file(const std::filesystem::path& file);

// The same from memory; `file_name` is named in the problems.
Expected<Loaded> read_nff(std::string_view text, const std::string& file_name);

}  // namespace crescente::io
