// The lists of points, weights, knots and curves that spline shapes hold, in scene files: one description of them for reading, writing, schema and
// reference.
#pragma once

#include "io/json_fields.h"
#include "io/scene_words.h"
#include "scene/scene.h"

namespace crescente::io {

template <class Kind>
inline constexpr bool has_spline_arrays = std::is_same_v<Kind, geometry::Bicubic> || std::is_same_v<Kind, geometry::Nurbs> ||
                                          std::is_same_v<Kind, geometry::Revolution> || std::is_same_v<Kind, geometry::Extrusion> ||
                                          std::is_same_v<Kind, geometry::Ruled>;

// For each of the kinds above.
template <class Kind>
std::span<const Word> spline_words();
template <class Kind>
void read_spline_arrays(const Json& json, Kind& shape, const Measure& measure, const Place& place, ProblemList& problems);
template <class Kind>
void write_spline_arrays(const Kind& shape, const Measure& measure, nlohmann::ordered_json& json);
// Adds to the schema of the shape's fields.
template <class Kind>
void add_spline_schema(nlohmann::ordered_json& schema);

std::span<const Word> curve_words();  // of a curve, beside the fields of geometry::Curve

}  // namespace crescente::io
