// The reference manual of the language of edits, generated from its words.
#pragma once

#include <string>

namespace crescente::io {

// docs/edits.md.
std::string edit_reference();

}  // namespace crescente::io
