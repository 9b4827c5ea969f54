#include "scene/field_check.h"

#include <charconv>
#include <cmath>

namespace crescente::scene {
namespace {

std::string unit_text(const FieldInfo& info, const std::string& unit_name) {
    if (info.unit.empty()) return {};
    if (info.unit == "m") return " " + unit_name;
    if (info.unit == "1/m") return " 1/" + unit_name;
    if (info.unit == "1/m^2") return " 1/" + unit_name + "^2";
    return " " + info.unit;
}

std::optional<std::string> range_problem_of(double value, const FieldInfo& info, double scale, const std::string& unit,
                                            const std::string& subject) {
    if (!std::isfinite(value)) return subject + "is not a finite number";
    if (value >= info.minimum && value <= info.maximum) return std::nullopt;
    const std::string low = number_text(info.minimum / scale), high = number_text(info.maximum / scale);
    const std::string is = subject + "is " + number_text(value / scale) + unit;
    if (info.maximum == unbounded) return is + ", must be at least " + low + unit;
    if (info.minimum == -unbounded) return is + ", must be at most " + high + unit;
    return is + ", must be from " + low + " to " + high + unit;
}

}  // namespace

double file_scale(const FieldInfo& info, double metres) {
    if (info.unit == "m") return metres;
    if (info.unit == "1/m") return 1 / metres;
    if (info.unit == "1/m^2") return 1 / (metres * metres);
    return 1;
}

std::string number_text(double value) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
    return {buffer, end};
}

std::optional<std::string> range_problem(const FieldInfo& info, const FieldValue& value, double metres, const std::string& unit_name) {
    const double scale = file_scale(info, metres);
    const std::string unit = unit_text(info, unit_name);
    if (const auto* number = std::get_if<double>(&value)) return range_problem_of(*number, info, scale, unit, "");
    if (const auto* integer = std::get_if<std::int64_t>(&value)) {
        if (info.type != FieldType::choice) return range_problem_of(static_cast<double>(*integer), info, scale, unit, "");
        const bool known = *integer >= 0 && *integer < static_cast<std::int64_t>(info.choices.size());
        return known ? std::nullopt : std::optional<std::string>{"is no known choice"};
    }
    if (const auto* three = std::get_if<std::array<double, 3>>(&value)) {
        const char* names = info.type == FieldType::color ? "rgb" : "xyz";
        for (int i = 0; i < 3; ++i) {
            if (auto text = range_problem_of((*three)[i], info, scale, unit, std::string("component ") + names[i] + " ")) return text;
        }
    }
    return std::nullopt;
}

}  // namespace crescente::scene
