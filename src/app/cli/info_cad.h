// What `crescente info` tells of CAD files besides: kinds of surfaces, and the tree of the assembly.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "io/formats.h"

namespace crescente::app {

// "faces" by kind, counts, and "tree": the nodes as a list whose entries refer to their children by index, so that what is shown often is told once.
nlohmann::ordered_json cad_json(const io::Loaded& loaded);

// The same for people, lines with an end each. Equal neighbours in the tree are told once, with their number.
std::string cad_text(const io::Loaded& loaded);

}  // namespace crescente::app
