// Whether a value lies in the range that its field declares; used when reading files and when validating a scene.
#pragma once

#include <optional>
#include <string>

#include "base/fields.h"

namespace crescente::scene {

// The factor from a length in the file's unit to the field's unit: metres for "m", its powers for "1/m" and "1/m^2", else 1.
double file_scale(const FieldInfo& info, double metres);

// A number as a person writes it: the fewest of at most 17 digits that give the same double.
std::string number_text(double value);

// What is wrong with a value (in the field's own unit), or nothing. `metres` and `unit_name` say how the user measures; the text
// speaks in that unit: "is -2 mm, must be at least 0 mm".
std::optional<std::string> range_problem(const FieldInfo& info, const FieldValue& value, double metres = 1,
                                         const std::string& unit_name = "m");

}  // namespace crescente::scene
