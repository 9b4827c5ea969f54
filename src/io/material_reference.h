// The page on the library of materials.
#pragma once

#include <string>

namespace crescente::io {

std::string material_reference();

}  // namespace crescente::io
