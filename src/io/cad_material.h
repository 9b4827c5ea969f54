// Materials for the colours of CAD files, which say no more than red, green, blue and transparency.
#pragma once

#include "io/cad_model.h"
#include "scene/material.h"

namespace crescente::io {

// By the rule of docs/cad.md: transparent colours become glass, greys of medium brightness bare metal, strong colours plastic, muted ones painted
// metal, near black and near white plastic. The name says which and with what colour: "plastic #d42a1e".
scene::Material cad_material(const CadColor& color);

// For faces without any colour.
scene::Material uncolored_cad_material();

}  // namespace crescente::io
