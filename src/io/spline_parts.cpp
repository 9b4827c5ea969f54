#include "io/spline_parts.h"

#include <array>

namespace crescente::io {
namespace {

using geometry::Curve;
using math::Vec3;
using nlohmann::ordered_json;

// Calls visit(name, list, whether it must be there, doc) for each list of the shape.
template <class Visit>
void each(auto& s, const geometry::Bicubic*, Visit&& visit) {
    visit("patches", s.points, true, "A list of patches; each a list of 16 points [x, y, z], four rows of four; rows run along u");
    visit("weights", s.weights, false, "For each patch a list of 16 positive weights; all 1 if left out. Not for the hermite basis");
}
template <class Visit>
void each(auto& s, const geometry::Nurbs*, Visit&& visit) {
    visit("points", s.points, true, "Rows along u of control points [x, y, z] along v");
    visit("weights", s.weights, false, "Rows of positive weights, as the points; all 1 if left out");
    visit("knots_u", s.knots_u, true, "As many as rows, the degree and 1 more, none less than the one before");
    visit("knots_v", s.knots_v, true, "The same for the points of a row");
}
template <class Visit>
void each(auto& s, const geometry::Revolution*, Visit&& visit) {
    visit("profile", s.profile, true, "A curve, or a list of curves one after another: x is the distance from the y axis, z is 0");
    visit("directrix", s.directrix, false, "What the distance from the axis is multiplied by, at equal angles; a circle if left out");
}
template <class Visit>
void each(auto& s, const geometry::Extrusion*, Visit&& visit) {
    visit("profile", s.profile, true, "A curve, or a list of curves one after another");
}
template <class Visit>
void each(auto& s, const geometry::Ruled*, Visit&& visit) {
    visit("from", s.from, true, "A curve, or a list of curves one after another");
    visit("to", s.to, true, "The other curve; straight lines join points at the same share of the two");
}
template <class Visit>
void each(auto& s, const Curve*, Visit&& visit) {
    visit("points", s.points, true, "Points [x, y, z]");
    visit("weights", s.weights, false, "One for each point, positive; all 1 if left out. Of bezier, b_spline and nurbs");
    visit("knots", s.knots, false, "Of nurbs: as many as points, the degree and 1 more, none less than the one before");
}
template <class Kind, class Visit>
void each_list(Kind& s, Visit&& visit) {
    each(s, static_cast<const std::remove_const_t<Kind>*>(nullptr), visit);
}

// --- reading

void must_be(const Json& json, const Place& place, const std::string& wanted, ProblemList& problems) {
    problems.add(json, place, "is " + std::string(json.kind()) + ", must be " + wanted);
}

void read(const Json& json, double& number, const Measure&, const Place& place, ProblemList& problems) {
    if (const auto value = json.number()) number = *value;
    else must_be(json, place, "a number", problems);
}
void read(const Json& json, Vec3& point, const Measure& measure, const Place& place, ProblemList& problems) {
    if (const auto p = read_vector(json, place, problems)) point = Vec3{(*p)[0], (*p)[1], (*p)[2]} * measure.metres;
}
void read(const Json& json, Curve& curve, const Measure& measure, const Place& place, ProblemList& problems);
void read(const Json& json, std::vector<Curve>& curves, const Measure& measure, const Place& place, ProblemList& problems);

template <class T, std::size_t n>
void read(const Json& json, std::array<T, n>& values, const Measure& measure, const Place& place, ProblemList& problems) {
    if (!json.array()) return must_be(json, place, "a list of " + std::to_string(n), problems);
    if (json.array()->size() != n) {
        return problems.add(json, place, "has " + std::to_string(json.array()->size()) + " elements, must have " + std::to_string(n));
    }
    for (std::size_t i = 0; i < n; ++i) read((*json.array())[i], values[i], measure, place / i, problems);
}
template <class T>
void read(const Json& json, std::vector<T>& values, const Measure& measure, const Place& place, ProblemList& problems) {
    if (!json.array()) return must_be(json, place, "a list", problems);
    values.resize(json.array()->size());
    for (std::size_t i = 0; i < values.size(); ++i) read((*json.array())[i], values[i], measure, place / i, problems);
}
template <class Kind>
void read_lists(const Json& json, Kind& shape, const Measure& measure, const Place& place, ProblemList& problems) {
    each_list(shape, [&](const char* name, auto& values, bool required, const char*) {
        if (const Json* list = json.find(name)) read(*list, values, measure, place / name, problems);
        else if (required && json.object()) problems.add(json, place, std::string(name) + " is missing");
    });
}
void read(const Json& json, Curve& curve, const Measure& measure, const Place& place, ProblemList& problems) {
    read_fields(json, curve, Curve::fields(), measure, place, problems, names_of(curve_words()));
    read_lists(json, curve, measure, place, problems);
}
void read(const Json& json, std::vector<Curve>& curves, const Measure& measure, const Place& place, ProblemList& problems) {
    if (json.object()) return read(json, curves.emplace_back(), measure, place, problems);
    read<Curve>(json, curves, measure, place, problems);
}

// --- writing

ordered_json written(double number, const Measure&) { return number; }
ordered_json written(Vec3 p, const Measure& measure) {
    return {length_in(p.x, measure.metres), length_in(p.y, measure.metres), length_in(p.z, measure.metres)};
}
ordered_json written(const Curve& curve, const Measure& measure);
template <class T, std::size_t n>
ordered_json written(const std::array<T, n>& values, const Measure& measure);
template <class T>
ordered_json written(const std::vector<T>& values, const Measure& measure);
ordered_json written_list(const auto& values, const Measure& measure) {
    ordered_json list = ordered_json::array();
    for (const auto& value : values) list.push_back(written(value, measure));
    return list;
}
template <class T, std::size_t n>
ordered_json written(const std::array<T, n>& values, const Measure& measure) { return written_list(values, measure); }
template <class T>
ordered_json written(const std::vector<T>& values, const Measure& measure) { return written_list(values, measure); }
template <class Kind>
void write_lists(const Kind& shape, const Measure& measure, ordered_json& json) {
    each_list(shape, [&](const char* name, const auto& values, bool required, const char*) {
        if (required || !values.empty()) json[name] = written_list(values, measure);
    });
}
ordered_json written(const Curve& curve, const Measure& measure) {
    ordered_json json = ordered_json::object();
    write_fields(curve, Curve::fields(), measure, json);
    write_lists(curve, measure, json);
    return json;
}

// --- schema

ordered_json list_schema(ordered_json items) { return {{"type", "array"}, {"items", std::move(items)}}; }
ordered_json schema_for(const double*) { return {{"type", "number"}}; }
ordered_json schema_for(const Vec3*) {
    ordered_json schema = list_schema({{"type", "number"}});
    schema["minItems"] = 3, schema["maxItems"] = 3;
    return schema;
}
ordered_json schema_for(const Curve*);
template <class T, std::size_t n>
ordered_json schema_for(const std::array<T, n>*) {
    ordered_json schema = list_schema(schema_for(static_cast<const T*>(nullptr)));
    schema["minItems"] = n, schema["maxItems"] = n;
    return schema;
}
ordered_json schema_for(const std::vector<Curve>*) {
    const ordered_json curve = schema_for(static_cast<const Curve*>(nullptr));
    return {{"anyOf", {curve, list_schema(curve)}}};
}
template <class T>
ordered_json schema_for(const std::vector<T>*) { return list_schema(schema_for(static_cast<const T*>(nullptr))); }
template <class Kind>
void add_lists(ordered_json& schema) {
    Kind standard{};
    ordered_json required = ordered_json::array();
    each_list(standard, [&]<class List>(const char* name, const List&, bool must, const char* doc) {
        schema["properties"][name] = {{"description", doc}};
        schema["properties"][name].update(schema_for(static_cast<const List*>(nullptr)));
        if (must) required.push_back(name);
    });
    schema["required"] = required;
}
ordered_json schema_for(const Curve*) {
    ordered_json schema = schema_of(Curve::fields());
    add_lists<Curve>(schema);
    return schema;
}

// What the value looks like, for the reference.
const char* form(const std::vector<Curve>*) { return "curve, or list of curves"; }
const char* form(const std::vector<Vec3>*) { return "list of points"; }
const char* form(const std::vector<double>*) { return "list of numbers"; }
const char* form(const std::vector<std::vector<Vec3>>*) { return "list of rows of points"; }
const char* form(const std::vector<std::vector<double>>*) { return "list of rows of numbers"; }
const char* form(const std::vector<std::array<Vec3, 16>>*) { return "list of 16 points each"; }
const char* form(const std::vector<std::array<double, 16>>*) { return "list of 16 numbers each"; }

template <class Kind>
std::vector<Word> words() {
    std::vector<Word> result;
    Kind standard{};
    each_list(standard, [&]<class List>(const char* name, const List&, bool, const char* doc) {
        result.push_back({name, form(static_cast<const List*>(nullptr)), doc});
    });
    return result;
}

}  // namespace

template <class Kind>
std::span<const Word> spline_words() {
    static const std::vector<Word> list = words<Kind>();
    return list;
}
template <class Kind>
void read_spline_arrays(const Json& json, Kind& shape, const Measure& measure, const Place& place, ProblemList& problems) {
    read_lists(json, shape, measure, place, problems);
}
template <class Kind>
void write_spline_arrays(const Kind& shape, const Measure& measure, ordered_json& json) {
    write_lists(shape, measure, json);
}
template <class Kind>
void add_spline_schema(ordered_json& schema) {
    add_lists<Kind>(schema);
}

std::span<const Word> curve_words() {
    static const std::vector<Word> list = words<Curve>();
    return list;
}

template std::span<const Word> spline_words<geometry::Bicubic>();
template std::span<const Word> spline_words<geometry::Nurbs>();
template std::span<const Word> spline_words<geometry::Revolution>();
template std::span<const Word> spline_words<geometry::Extrusion>();
template std::span<const Word> spline_words<geometry::Ruled>();
template void read_spline_arrays(const Json&, geometry::Bicubic&, const Measure&, const Place&, ProblemList&);
template void read_spline_arrays(const Json&, geometry::Nurbs&, const Measure&, const Place&, ProblemList&);
template void read_spline_arrays(const Json&, geometry::Revolution&, const Measure&, const Place&, ProblemList&);
template void read_spline_arrays(const Json&, geometry::Extrusion&, const Measure&, const Place&, ProblemList&);
template void read_spline_arrays(const Json&, geometry::Ruled&, const Measure&, const Place&, ProblemList&);
template void write_spline_arrays(const geometry::Bicubic&, const Measure&, ordered_json&);
template void write_spline_arrays(const geometry::Nurbs&, const Measure&, ordered_json&);
template void write_spline_arrays(const geometry::Revolution&, const Measure&, ordered_json&);
template void write_spline_arrays(const geometry::Extrusion&, const Measure&, ordered_json&);
template void write_spline_arrays(const geometry::Ruled&, const Measure&, ordered_json&);
template void add_spline_schema<geometry::Bicubic>(ordered_json&);
template void add_spline_schema<geometry::Nurbs>(ordered_json&);
template void add_spline_schema<geometry::Revolution>(ordered_json&);
template void add_spline_schema<geometry::Extrusion>(ordered_json&);
template void add_spline_schema<geometry::Ruled>(ordered_json&);

}  // namespace crescente::io
