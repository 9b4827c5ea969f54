// CAD models from STEP, IGES and BREP files, read by OpenCASCADE in a process of its own, or from the cache.
#pragma once

#include <filesystem>
#include <vector>

#include "io/cad_model.h"
#include "io/formats.h"

namespace crescente::io {

struct CadFaceNumber {
    std::uint32_t part, number;  // a part by its index, a face by CadPart::numbers
};

struct CadRequest {
    double deflection = 0;                    // everything as triangles that stray by this share of each part's diagonal; 0: exact faces
    std::vector<CadFaceNumber> triangulated;  // faces that are to come as triangles in any case
};

// Errors: unsupported (this build has no OpenCASCADE), input (missing, damaged, empty, of another format; too much for the limits of time, 120 s and 30
// more a megabyte, or of memory, 4 GB and 200 times the file), resource (no process, or options.cancelled).
Expected<CadModel> read_cad_model(const std::filesystem::path& file, const ReadOptions& options);

// Without asking the cache; exact models are put into it.
Expected<CadModel> read_cad_anew(const std::filesystem::path& file, const CadRequest& request, const ReadOptions& options);

}  // namespace crescente::io
