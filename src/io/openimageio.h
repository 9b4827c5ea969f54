// Finds and loads the OpenImageIO module when it is first needed.
#pragma once

#include <string>
#include <string_view>

#include "base/error.h"
#include "io/oiio/module.h"
#include "scene/texture_image.h"

namespace crescente::io {

// Whether the module lies where it belongs: beside the program, or in ../lib or ../lib/crescente from it. Does not load it.
bool has_openimageio();

// Encodes with the module; the request's user, take, fail and version are filled in here. Errors: unsupported (no module, or it does
// not load), resource (the encoder failed).
Expected<std::string> encode_with_openimageio(CrescenteEncodeRequest request);

// Decodes with the module. Nothing of it may be used for bytes from strangers but in a process of its own (io/isolated.h). Errors: unsupported (no module), input (why the
// bytes give no picture that a texture can show).
Expected<scene::Pixels> decode_with_openimageio(std::string_view bytes, std::uint64_t most_pixels);

}  // namespace crescente::io
