// The tree of a document: parts, assemblies, instances.
#pragma once

#include "base/error.h"
#include "io/cad_model.h"
#include "io/occt/document.h"
#include "io/occt/parts.h"

namespace crescente::io::occt {

// Every part once, however often it is shown. Errors (input): there is no face in it.
Expected<CadModel> model_of(const CadDocument& document, const PartOptions& options, const Progress& progress);

}  // namespace crescente::io::occt
