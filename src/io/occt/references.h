// The files that a STEP file refers to, found in its text before OpenCASCADE follows them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"

namespace crescente::io::occt {

// Those that are there, relative to the folder of the main file, with those that they refer to in turn. Names are taken from document files, external identifications and external sources (ISO 10303-21, CAx-IF recommended practices for external references).
// Error (input): one names a file outside of the folder that exists, which must not be read on behalf of a file from a stranger.
Expected<std::vector<std::string>> references_of(const std::filesystem::path& file, const std::string& shown_name);

}  // namespace crescente::io::occt
