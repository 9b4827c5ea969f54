// Decodes pictures in a process of its own (io/isolated.h): the libraries that do it are not safe with hostile files.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "scene/pixels.h"

namespace crescente::io {

// A picture, or why there is none: "is damaged: ...", as said of the picture.
struct DecodedPicture {
    std::string error;
    scene::Pixels pixels;
};

// Several in one process, each handed on by its index and in their order, so that only a bunch of them is in memory at a time. What one of them does to the process is told of that one;
// those after it are decoded in another. No larger ones than `most_pixels`.
void decode_pictures(std::span<const std::string> encoded, std::uint64_t most_pixels, const std::function<void(std::size_t, DecodedPicture)>& take);

// Bytes of one channel of a pixel.
std::size_t sample_bytes(scene::SampleType type);

}  // namespace crescente::io
