// Whether a CAD model that came from elsewhere holds together.
#pragma once

#include "io/cad_model.h"

namespace crescente::io {

// Indices in range, children without cycles, finite numbers, patches with as many points as their degrees want (1 to 60 each) and positive
// weights, curves with at least two points, no more places in the tree than 10 million.
bool holds_together(const CadModel& model);
bool holds_together(const geometry::Face& face);

}  // namespace crescente::io
