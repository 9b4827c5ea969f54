// JPEG for pictures that are soon replaced, by libjpeg-turbo.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "base/error.h"

namespace crescente::app {

// RGB, 8 bits, row by row from the top; colours at full resolution (4:4:4), since edges of CAD models are coloured. `quality` from 1 to 100. Errors: resource.
Expected<std::string> encode_jpeg(int width, int height, std::span<const std::uint8_t> rgb, int quality);

}  // namespace crescente::app
