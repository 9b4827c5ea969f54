// What a reader found, as bytes from one process to another of the same program.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "io/formats.h"

namespace crescente::io {

// Shapes must be meshes, materials physical.
std::string pack(const Expected<Loaded>& result);

// Nothing if the bytes are not whole: they come from a process that may have gone astray. The scene is as valid as it was.
std::optional<Expected<Loaded>> unpack(std::string_view bytes);

}  // namespace crescente::io
