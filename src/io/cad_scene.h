// A CAD model as a scene.
#pragma once

#include <string>

#include "io/formats.h"

namespace crescente::io {

// A face that the tracer cannot prepare.
struct UntraceableFace {
    std::uint32_t part = 0, face = 0;  // index into the part's faces
    std::string reason;
};

// Parts become shapes, colours materials. Untraceable faces are left out and listed.
Loaded cad_scene(const CadModel& model, std::vector<UntraceableFace>& untraceable);

}  // namespace crescente::io
