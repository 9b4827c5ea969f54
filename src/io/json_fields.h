// Structs to and from JSON by their field tables (base/fields.h).
#pragma once

#include <algorithm>

#include <nlohmann/json.hpp>

#include "base/fields.h"
#include "io/json_text.h"
#include "math/color.h"
#include "scene/field_check.h"

namespace crescente::io {

// How lengths are measured in a text.
struct Measure {
    double metres = 1;
    std::string name = "m";
};

// "#rrggbb" (sRGB) as linear colour; nothing if it is no such text.
std::optional<math::Rgb> color_of_text(const std::string& text);

// A field's value from JSON, in the field's own unit, its range checked. Colours: [r, g, b] linear, one number for grey, or "#rrggbb"
// (sRGB). Names: a list of texts, or one alone. Nothing if it is wrong; then the problem is told.
std::optional<FieldValue> read_value(const Json& json, const FieldInfo& info, const Measure& measure, const Place& place,
                                     ProblemList& problems);

// Three numbers; nothing and a problem otherwise.
std::optional<std::array<double, 3>> read_vector(const Json& json, const Place& place, ProblemList& problems);

// The value as it is written: lengths in the measure, choices by name, numbers with as few digits as read back to the same value.
nlohmann::ordered_json write_value(const FieldValue& value, const FieldInfo& info, const Measure& measure);

// The length, in the measure, that reads back as `metres_value` and has the fewest digits. Where no double does (a length
// that never was in this unit), the nearest.
double length_in(double metres_value, double scale);

// The double that has the digits of the float: 0.8f is written 0.8.
double short_double(float value);

// The nearest double that has at most so many significant decimal digits.
double rounded_to(double value, int digits);

// JSON Schema (draft 2020-12) of one field, with default. Ranges of lengths other than zero are left to the reader: they depend on the unit.
nlohmann::ordered_json schema_of_field(const FieldInfo& info, const FieldValue& default_value);

template <class Owner>
std::vector<std::string> names_of(const FieldTable<Owner>& table, std::span<const std::string> more = {}) {
    std::vector<std::string> names(more.begin(), more.end());
    for (const auto& f : table) names.push_back(f.info.name);
    return names;
}

// Sets the members of `owner` that the object gives. `also` are members that the caller reads itself.
template <class Owner>
void read_fields(const Json& json, Owner& owner, const FieldTable<Owner>& table, const Measure& measure, const Place& place,
                 ProblemList& problems, std::span<const std::string> also = {}) {
    if (!json.object()) {
        problems.add(json, place, "is " + std::string(json.kind()) + ", must be an object");
        return;
    }
    for (const auto& member : *json.object()) {
        if (std::find(also.begin(), also.end(), member.key) != also.end()) continue;
        const auto found = std::find_if(table.begin(), table.end(), [&](const auto& f) { return f.info.name == member.key; });
        if (found == table.end()) {
            unknown_member(member, place, names_of(table, also), problems);
        } else if (const auto value = read_value(member.value, found->info, measure, place / member.key, problems)) {
            found->set(owner, *value);
        }
    }
}

// Adds to `object` the members that differ from a default-constructed owner.
template <class Owner>
void write_fields(const Owner& owner, const FieldTable<Owner>& table, const Measure& measure, nlohmann::ordered_json& object) {
    const Owner standard{};
    for (const auto& f : table) {
        const FieldValue value = f.get(owner);
        if (value == f.get(standard)) continue;
        if (f.info.type == FieldType::angle) {  // kept in radians: the fewest digits that give the same angle
            Owner trial = owner;
            double degrees = std::get<double>(value);
            for (const int digits : {15, 16}) {
                const double rounded = rounded_to(std::get<double>(value), digits);
                f.set(trial, FieldValue{rounded});
                if (f.get(trial) == value) {
                    degrees = rounded;
                    break;
                }
            }
            object[f.info.name] = degrees;
        } else {
            object[f.info.name] = write_value(value, f.info, measure);
        }
    }
}

template <class Owner>
nlohmann::ordered_json schema_of(const FieldTable<Owner>& table) {
    const Owner standard{};
    nlohmann::ordered_json properties = nlohmann::ordered_json::object();
    for (const auto& f : table) properties[f.info.name] = schema_of_field(f.info, f.get(standard));
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

}  // namespace crescente::io
