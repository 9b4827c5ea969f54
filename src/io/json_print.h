// JSON as a person would set it: what fits on a line stands on a line, numbers with the fewest digits that read back the same.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

namespace crescente::io {

void print_json(const nlohmann::ordered_json& value, std::string& out, int indent = 0);

std::string quoted(const std::string& text);  // bytes that are not UTF-8 are replaced
void print_number(double value, std::string& out);

}  // namespace crescente::io
