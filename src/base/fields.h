// Fields declared once: name, unit, range and doc line of each member of a plain struct. Reading and writing JSON, validation,
// the JSON Schema, `--set` overrides and the reference manual derive from the same table. Defaults are those of a
// default-constructed owner.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

namespace crescente {

// What a field can hold, in terms that need no upper layer. An enumeration travels as its index into `choices`.
using FieldValue = std::variant<bool, std::int64_t, double, std::string, std::array<double, 3>, std::vector<std::string>>;

enum class FieldType { boolean, integer, number, text, choice, vector, color, angle, names };

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

struct FieldInfo {
    std::string name;
    FieldType type = FieldType::number;
    std::string unit;            // "m", "deg", "cd", "px", "1/m"; empty where there is none
    double minimum = -unbounded;  // of the number, or of every component; in the unit of the file (angles: degrees)
    double maximum = unbounded;
    std::string doc;             // one line for the reference manual
    std::vector<std::string> choices{};  // spellings of an enumeration, in its order
};

template <class Owner>
struct Field {
    FieldInfo info;
    std::function<FieldValue(const Owner&)> get;
    std::function<void(Owner&, const FieldValue&)> set;  // the value must hold the alternative that get returns
};

template <class Owner>
using FieldTable = std::vector<Field<Owner>>;

// Makes a field from a member. T is bool, an integer, double, float, std::string, a list of names (std::vector<std::string>), an enumeration (with choices), or any
// struct of three numbers constructible as T{a, b, c} and readable as value[0..2] (vectors and colours). A field of type angle is
// given in degrees in files and kept in radians in the member.
template <class Owner, class T>
Field<Owner> field(T Owner::*member, FieldInfo info) {
    constexpr double degree = 3.14159265358979323846 / 180.0;
    if constexpr (std::is_same_v<T, bool> || std::is_same_v<T, std::string> || std::is_same_v<T, std::vector<std::string>>) {
        return {std::move(info), [member](const Owner& o) { return FieldValue{o.*member}; },
                [member](Owner& o, const FieldValue& v) { o.*member = std::get<T>(v); }};
    } else if constexpr (std::is_enum_v<T> || std::is_integral_v<T>) {
        return {std::move(info), [member](const Owner& o) { return FieldValue{static_cast<std::int64_t>(o.*member)}; },
                [member](Owner& o, const FieldValue& v) { o.*member = static_cast<T>(std::get<std::int64_t>(v)); }};
    } else if constexpr (std::is_floating_point_v<T>) {
        const double scale = info.type == FieldType::angle ? degree : 1.0;
        return {std::move(info), [member, scale](const Owner& o) { return FieldValue{static_cast<double>(o.*member) / scale}; },
                [member, scale](Owner& o, const FieldValue& v) { o.*member = static_cast<T>(std::get<double>(v) * scale); }};
    } else {
        using Component = std::remove_cvref_t<decltype(std::declval<const T&>()[0])>;
        return {std::move(info),
                [member](const Owner& o) {
                    const T& value = o.*member;
                    return FieldValue{std::array<double, 3>{double(value[0]), double(value[1]), double(value[2])}};
                },
                [member](Owner& o, const FieldValue& v) {
                    const auto& a = std::get<std::array<double, 3>>(v);
                    o.*member = T{static_cast<Component>(a[0]), static_cast<Component>(a[1]), static_cast<Component>(a[2])};
                }};
    }
}

}  // namespace crescente
