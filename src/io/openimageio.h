// Finds and loads the OpenImageIO module when it is first needed.
#pragma once

#include <string>

#include "base/error.h"
#include "io/oiio/module.h"

namespace crescente::io {

// Whether the module lies where it belongs: beside the program, or in ../lib or ../lib/crescente from it. Does not load it.
bool has_openimageio();

// Encodes with the module; the request's user, take, fail and version are filled in here. Errors: unsupported (no module, or it does
// not load), resource (the encoder failed).
Expected<std::string> encode_with_openimageio(CrescenteEncodeRequest request);

}  // namespace crescente::io
