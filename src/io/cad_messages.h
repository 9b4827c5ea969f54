// A CAD model as bytes: between the process that reads it and this one, and in the cache.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/error.h"
#include "io/cad_model.h"

namespace crescente::io {

// To be raised whenever the bytes of a model, or what the reader makes of a file, change: it is part of the cache's key.
inline constexpr std::uint32_t cad_message_version = 4;

std::string pack_cad(const Expected<CadModel>& result);

// Nothing if the bytes are not whole or the model does not hold together: every index is in range, nodes form a tree or share children without
// cycles, numbers are finite, patches have the points that their degrees want.
std::optional<Expected<CadModel>> unpack_cad(std::string_view bytes);

}  // namespace crescente::io
