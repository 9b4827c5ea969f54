#include "io/json_fields.h"

#include <charconv>
#include <cmath>

#include "base/spelling.h"
#include "scene/tonemap.h"

namespace crescente::io {
namespace {

using nlohmann::ordered_json;

std::optional<FieldValue> value_of(const Json& json, const FieldInfo& info, double scale, const Place& place, ProblemList& problems) {
    const auto wrong = [&](const std::string& wanted) {
        problems.add(json, place, "is " + std::string(json.kind()) + ", must be " + wanted);
        return std::nullopt;
    };
    switch (info.type) {
    case FieldType::boolean:
        if (json.boolean()) return FieldValue{*json.boolean()};
        return wrong("true or false");
    case FieldType::integer:
        if (json.integer()) return FieldValue{*json.integer()};
        if (const auto number = json.number()) {
            constexpr double exact = 9007199254740992.0;  // 2^53
            if (*number == std::floor(*number) && std::abs(*number) <= exact) return FieldValue{static_cast<std::int64_t>(*number)};
            problems.add(json, place, "is " + scene::number_text(*number) + ", must be a whole number");
            return std::nullopt;
        }
        return wrong("a whole number");
    case FieldType::number:
    case FieldType::angle:
        if (const auto number = json.number()) return FieldValue{*number * scale};
        return wrong("a number");
    case FieldType::text:
        if (json.text()) return FieldValue{*json.text()};
        return wrong("a text");
    case FieldType::names: {
        if (json.text()) return FieldValue{std::vector<std::string>{*json.text()}};
        if (!json.array()) return wrong("a list of names");
        std::vector<std::string> names;
        for (std::size_t i = 0; i < json.array()->size(); ++i) {
            const Json& name = (*json.array())[i];
            if (!name.text()) {
                problems.add(name, place / i, "is " + std::string(name.kind()) + ", must be a name");
                return std::nullopt;
            }
            names.push_back(*name.text());
        }
        return FieldValue{std::move(names)};
    }
    case FieldType::choice: {
        if (!json.text()) return wrong("one of its choices as a text");
        const auto found = std::find(info.choices.begin(), info.choices.end(), *json.text());
        if (found != info.choices.end()) return FieldValue{static_cast<std::int64_t>(found - info.choices.begin())};
        problems.add(json, place, "'" + json.text()->substr(0, 100) + "' is no choice for " + info.name,
                     spelling_hint(*json.text(), info.choices));
        return std::nullopt;
    }
    case FieldType::color:
        if (const auto grey = json.number()) return FieldValue{std::array<double, 3>{*grey, *grey, *grey}};
        if (json.text()) {
            if (const auto color = color_of_text(*json.text())) return FieldValue{std::array<double, 3>{color->r, color->g, color->b}};
            problems.add(json, place, "'" + json.text()->substr(0, 100) + "' is no colour", "write \"#rrggbb\", [r, g, b] or one number for grey");
            return std::nullopt;
        }
        [[fallthrough]];
    case FieldType::vector:
        if (!json.array()) return wrong(info.type == FieldType::color ? "a colour: [r, g, b], \"#rrggbb\" or one number" : "three numbers");
        if (auto three = read_vector(json, place, problems)) {
            for (double& component : *three) component *= scale;
            return FieldValue{*three};
        }
        return std::nullopt;
    }
    return std::nullopt;
}

// The same for a colour's component, a float: attenuation is a colour measured by length.
double component_in(float component, double scale) {
    if (scale == 1) return short_double(component);
    const double nearest = double{component} / scale;
    for (int digits = 6; digits < 17; ++digits) {
        const double rounded = rounded_to(nearest, digits);
        if (static_cast<float>(rounded * scale) == component) return rounded;
    }
    return nearest;
}

// A number with the fewest digits that `same` accepts, near `value`; nothing if none is accepted.
template <class Same>
std::optional<double> shortest(double value, Same&& same) {
    for (const int digits : {15, 16}) {
        const double rounded = rounded_to(value, digits);
        if (same(rounded)) return rounded;
    }
    for (const double candidate : {value, std::nextafter(value, -unbounded), std::nextafter(value, unbounded)}) {
        if (same(candidate)) return candidate;
    }
    return std::nullopt;
}

ordered_json number_json(double value) {
    constexpr double exact = 9007199254740992.0;
    if (value == std::floor(value) && std::abs(value) <= exact && !(value == 0 && std::signbit(value))) return static_cast<std::int64_t>(value);
    return value;
}

}  // namespace

std::optional<math::Rgb> color_of_text(const std::string& text) {
    unsigned code = 0;
    const auto [end, error] = std::from_chars(text.data() + std::min<std::size_t>(1, text.size()), text.data() + text.size(), code, 16);
    if (text.size() != 7 || text[0] != '#' || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    const auto linear = [&](int shift) { return scene::srgb_decode(static_cast<float>((code >> shift) & 255) / 255.0f); };
    return math::Rgb{linear(16), linear(8), linear(0)};
}

double short_double(float component) {
    char buffer[32];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, component).ptr;
    double value = component;
    std::from_chars(buffer, end, value);
    return value;
}

double rounded_to(double value, int digits) {
    if (!std::isfinite(value)) return value;
    char buffer[48];
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr;
    std::from_chars(buffer, end, value);
    return value;
}

std::optional<std::array<double, 3>> read_vector(const Json& json, const Place& place, ProblemList& problems) {
    std::array<double, 3> result{};
    if (!json.array() || json.array()->size() != 3) {
        problems.add(json, place, json.array() ? "has " + std::to_string(json.array()->size()) + " elements, must have 3"
                                               : "is " + std::string(json.kind()) + ", must be three numbers");
        return std::nullopt;
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const auto number = (*json.array())[i].number();
        if (!number) {
            problems.add((*json.array())[i], place / i, "is " + std::string((*json.array())[i].kind()) + ", must be a number");
            return std::nullopt;
        }
        result[i] = *number;
    }
    return result;
}

std::optional<FieldValue> read_value(const Json& json, const FieldInfo& info, const Measure& measure, const Place& place,
                                     ProblemList& problems) {
    auto value = value_of(json, info, scene::file_scale(info, measure.metres), place, problems);
    if (!value) return std::nullopt;
    auto wrong = scene::range_problem(info, *value, measure.metres, measure.name);
    if (const auto* color = std::get_if<std::array<double, 3>>(&*value); !wrong && color && info.type == FieldType::color) {
        constexpr double largest = std::numeric_limits<float>::max();
        for (const double component : *color) {
            if (std::abs(component) > largest) wrong = "is too large for a colour";
        }
    }
    if (!wrong) return value;
    problems.add(json, place, *wrong);
    return std::nullopt;
}

double length_in(double metres_value, double scale) {
    if (scale == 1) return metres_value;
    const auto reads_back = [scale](double wanted) { return [scale, wanted](double v) { return v * scale == wanted; }; };
    const double nearest = metres_value / scale;
    if (const auto v = shortest(nearest, reads_back(metres_value))) return *v;
    const double moved = nearest * scale;  // this length does read back
    return shortest(moved / scale, reads_back(moved)).value_or(nearest);
}

ordered_json write_value(const FieldValue& value, const FieldInfo& info, const Measure& measure) {
    const double scale = scene::file_scale(info, measure.metres);
    if (const auto* number = std::get_if<double>(&value)) return number_json(length_in(*number, scale));
    if (const auto* three = std::get_if<std::array<double, 3>>(&value)) {
        ordered_json array = ordered_json::array();
        for (const double component : *three) {
            const bool color = info.type == FieldType::color;
            array.push_back(number_json(color ? component_in(static_cast<float>(component), scale) : length_in(component, scale)));
        }
        return array;
    }
    if (const auto* text = std::get_if<std::string>(&value)) return *text;
    if (const auto* names = std::get_if<std::vector<std::string>>(&value)) return *names;
    if (const auto* boolean = std::get_if<bool>(&value)) return *boolean;
    const auto integer = std::get<std::int64_t>(value);
    if (info.type != FieldType::choice) return integer;
    return info.choices.at(static_cast<std::size_t>(integer));
}

ordered_json schema_of_field(const FieldInfo& info, const FieldValue& default_value) {
    ordered_json schema;
    std::string doc = info.doc;
    if (!info.unit.empty()) doc += info.unit == "m" ? " (length)" : info.unit == "1/m" ? " (1/length)" : " (" + info.unit + ")";
    schema["description"] = doc;
    const bool length = info.unit == "m" || info.unit == "1/m" || info.unit == "1/m^2";
    const auto limits = [&](ordered_json& to) {
        if (info.minimum != -unbounded && (!length || info.minimum == 0)) to["minimum"] = number_json(info.minimum);
        if (info.maximum != unbounded && !length) to["maximum"] = number_json(info.maximum);
    };
    switch (info.type) {
    case FieldType::boolean: schema["type"] = "boolean"; break;
    case FieldType::integer: schema["type"] = "integer", limits(schema); break;
    case FieldType::number:
    case FieldType::angle: schema["type"] = "number", limits(schema); break;
    case FieldType::text: schema["type"] = "string"; break;
    case FieldType::names: {
        const ordered_json name{{"type", "string"}};
        schema["anyOf"] = {{{"type", "array"}, {"items", name}}, name};
        break;
    }
    case FieldType::choice: schema["enum"] = info.choices; break;
    case FieldType::vector:
        schema["type"] = "array";
        schema["items"]["type"] = "number", limits(schema["items"]);
        schema["minItems"] = 3, schema["maxItems"] = 3;
        break;
    case FieldType::color: {
        ordered_json number{{"type", "number"}};
        limits(number);
        schema["anyOf"] = {{{"type", "array"}, {"items", number}, {"minItems", 3}, {"maxItems", 3}},
                           {{"type", "string"}, {"pattern", "^#[0-9a-fA-F]{6}$"}},
                           number};
        break;
    }
    }
    schema["default"] = write_value(default_value, info, {});
    return schema;
}

}  // namespace crescente::io
