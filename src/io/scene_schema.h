// Schema and reference of the native scene format, made from the field tables and io/scene_words.
#pragma once

#include <string>

namespace crescente::io {

// JSON Schema, draft 2020-12; docs/scene.schema.json is this text. Editors complete and check scene files with it.
std::string scene_schema();

// The reference manual in Markdown; docs/scene_format.md is this text.
std::string scene_reference();

}  // namespace crescente::io
