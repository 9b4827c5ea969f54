// A face of OpenCASCADE as one of ours.
#pragma once

#include <string>

#include <TopoDS_Face.hxx>
#include <tl/expected.hpp>

#include "io/cad_model.h"
#include "io/occt/edge_bands.h"

namespace crescente::io::occt {

struct ConvertedFace {
    geometry::Face face;
    CadSurface kind = CadSurface::other;
    bool approximated = false, healed = false;
};

struct UnconvertedFace {
    CadSurface kind = CadSurface::other;
    bool degenerate = false;  // without area: nothing is missing
    std::string reason;
};

// Converts the face and compares points of the result with OpenCASCADE's; what does not agree, or does not close, is mended by ShapeFix_Face and tried
// once more. Never throws.
tl::expected<ConvertedFace, UnconvertedFace> convert_face(const TopoDS_Face& face, const EdgeBands& bands);

}  // namespace crescente::io::occt
