// Numbers that tell bytes from other bytes: to find damage and to compare content, not against forgery.
#pragma once

#include <cstdint>
#include <string_view>

namespace crescente {

// XXH3, 64 bits (Collet 2019). Another seed gives another number for the same bytes.
std::uint64_t checksum(std::string_view bytes, std::uint64_t seed = 0);

}  // namespace crescente
