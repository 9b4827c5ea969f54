// STEP, IGES and BREP files as scenes.
#pragma once

#include <filesystem>

#include "io/formats.h"

namespace crescente::io {

// The faces become a Brep for each part, colours become materials (io/cad_material.h). The topmost node turns z up to y up and scales to metres. Faces
// that the tracer cannot prepare are read again as triangles. Errors: as read_cad_model().
Expected<Loaded> read_cad_file(const std::filesystem::path& file, const ReadOptions& options);

}  // namespace crescente::io
