// PNG pictures (ISO/IEC 15948), by libpng.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "base/error.h"

namespace crescente::io {

// Encodes 8 or 16 bits RGB, or RGB and alpha (4 channels; the colours are then not multiplied by it), row by row from the top, tagged as sRGB. Metadata becomes text chunks: iTXt, or tEXt where the
// text is ASCII; a key longer than PNG allows (79 bytes) is cut. Errors: resource (too large for PNG or for the memory).
Expected<std::string> encode_png(int width, int height, int channels, std::span<const std::uint8_t> samples, const std::map<std::string, std::string>& metadata);
Expected<std::string> encode_png(int width, int height, int channels, std::span<const std::uint16_t> samples, const std::map<std::string, std::string>& metadata);

}  // namespace crescente::io
