// JSON Schema of the messages between page and program (docs/protocol.md).
#pragma once

#include <string>

namespace crescente::app {

// Draft 2020-12; docs/protocol.schema.json is this text. `$defs/request` is what the page sends, `$defs/reply` what it gets; values of scenes are those of docs/scene.schema.json.
std::string protocol_schema();

}  // namespace crescente::app
