// Checkpoints as bytes, for tests and fuzzing.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "base/checksum.h"

namespace crescente::render::testing {

inline std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    content << stream.rdbuf();
    return content.str();
}
inline void write_bytes(const std::filesystem::path& file, std::string_view bytes) { std::ofstream(file, std::ios::binary).write(bytes.data(), std::ssize(bytes)); }

// The file with checksums that fit, so that what lies behind them is reached. A section that is said to be longer than the file ends with it.
inline std::string resealed(std::string bytes) {
    constexpr std::size_t beginning = 17 + 4, head = 16;  // mark and version; length and checksum of a section
    std::uint64_t number = 0;
    for (std::size_t at = beginning; at + head <= bytes.size(); ++number) {
        std::uint64_t length;
        std::memcpy(&length, &bytes[at], sizeof length);
        length = std::min<std::uint64_t>(length, bytes.size() - at - head);
        const std::uint64_t sum = checksum(std::string_view(bytes).substr(at + head, length), number);
        std::memcpy(&bytes[at], &length, sizeof length);
        std::memcpy(&bytes[at + 8], &sum, sizeof sum);
        at += head + length;
    }
    return bytes;
}

}  // namespace crescente::render::testing
