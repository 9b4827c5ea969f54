// The pictures of a scene's textures: found, decoded, and held to what memory they may take.
#pragma once

#include <span>

#include "io/formats.h"

namespace crescente::io {

struct TextureOptions {
    bool pattern = false;                          // what cannot be shown is replaced by a pattern of magenta and black, and told as a warning; else it is an error
    std::size_t memory = std::size_t{2} << 30;     // of all pictures together, bytes; those that would exceed it are halved in size until they do not, which is told
};

// Decodes the pictures of these materials that are not decoded yet, in a process of its own (io/isolated.h), each once however many textures show it. Samples that
// are not finite become 0, which is told. Returns warnings. Errors (input), each with the picture's file, or that of the scene and where in it the picture is, and why: missing, damaged,
// of another number of channels than 1 to 4, of more than 2^28 pixels. Without OpenImageIO in this build textures that show pictures are left out, with a warning.
Expected<Problems> load_textures(std::span<scene::Material> materials, const std::string& scene_file, const TextureOptions& options);

}  // namespace crescente::io
