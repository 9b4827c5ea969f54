// Where the modules lie that are loaded when they are first needed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace crescente::io {

// The module of that file name: beside the program (or beside the library that holds this code), or in ../lib or ../lib/crescente from it.
std::optional<std::filesystem::path> module_file(const std::string& name);

}  // namespace crescente::io
