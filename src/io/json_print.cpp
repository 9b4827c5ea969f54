#include "io/json_print.h"

#include <charconv>
#include <cmath>

namespace crescente::io {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t line_width = 118;
constexpr int indent_step = 2;

void print_scalar(const ordered_json& value, std::string& out) {
    if (value.is_string()) out += quoted(value.get_ref<const std::string&>());
    else if (value.is_number_float()) print_number(value.get<double>(), out);
    else out += value.dump();
}

// On one line; false (with `out` in any state) once it is longer than the limit.
bool print_flat(const ordered_json& value, std::string& out, std::size_t limit) {
    if (!value.is_structured()) {
        print_scalar(value, out);
        return out.size() <= limit;
    }
    out += value.is_array() ? '[' : '{';
    bool first = true;
    for (auto element = value.begin(); element != value.end(); ++element) {
        if (!first) out += ", ";
        first = false;
        if (value.is_object()) out += quoted(element.key()) + ": ";
        if (!print_flat(*element, out, limit)) return false;
    }
    out += value.is_array() ? ']' : '}';
    return out.size() <= limit;
}

void new_line(std::string& out, int indent) {
    out += '\n';
    out.append(static_cast<std::size_t>(indent), ' ');
}

}  // namespace

std::string quoted(const std::string& text) {
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

void print_number(double value, std::string& out) {
    if (value == 0 && std::signbit(value)) {  // "-0" would be read as the whole number 0
        out += "-0.0";
        return;
    }
    if (!std::isfinite(value)) {
        out += "null";
        return;
    }
    char buffer[32];
    out.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

void print_json(const ordered_json& value, std::string& out, int indent) {
    const std::size_t start = out.size();
    const std::size_t column = start - (out.rfind('\n') == std::string::npos ? 0 : out.rfind('\n') + 1);
    const bool fits = print_flat(value, out, start + (column < line_width ? line_width - column : 0));
    if (fits || !value.is_structured() || value.empty()) return;
    out.resize(start);
    out += value.is_array() ? '[' : '{';
    bool first = true;
    for (auto element = value.begin(); element != value.end(); ++element) {
        if (!first) out += ',';
        // Numbers run on, so that a long list does not take a line for each.
        const bool runs_on = value.is_array() && element->is_number() && !first;
        if (!runs_on || out.size() - out.rfind('\n') > line_width - 12) new_line(out, indent + indent_step);
        else out += ' ';
        first = false;
        if (value.is_object()) out += quoted(element.key()) + ": ";
        print_json(*element, out, indent + indent_step);
    }
    new_line(out, indent);
    out += value.is_array() ? ']' : '}';
}

}  // namespace crescente::io
