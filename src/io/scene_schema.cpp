#include "io/scene_schema.h"

#include "io/json_fields.h"
#include "io/json_print.h"
#include "io/scene_words.h"
#include "io/spline_parts.h"
#include "scene/material_library.h"
#include "io/texture_parts.h"
#include "scene/scene.h"

namespace crescente::io {
namespace {

using nlohmann::ordered_json;

ordered_json ref(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }
ordered_json text() { return {{"type", "string"}}; }
ordered_json number() { return {{"type", "number"}}; }
ordered_json list_of(ordered_json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

ordered_json by_name_or_list(const std::string& name) {
    return {{"anyOf", {{{"type", "object"}, {"additionalProperties", ref(name)}}, list_of(ref(name))}}};
}

ordered_json numbers_of(std::size_t count) {
    ordered_json list = list_of(number());
    list["minItems"] = count;
    list["maxItems"] = count;
    return list;
}

// An object with these words, whose values have the given schemas.
ordered_json object_with(std::span<const Word> words, const ordered_json& schemas) {
    ordered_json properties = ordered_json::object();
    for (const Word& word : words) {
        properties[word.name] = {{"description", word.doc}};
        properties[word.name].update(schemas.at(word.name));
    }
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

template <class Owner>
ordered_json schema_with_name(const FieldTable<Owner>& table) {
    ordered_json schema = schema_of(table);
    schema["properties"][name_word().name] = {{"description", name_word().doc}, {"type", "string"}};
    return schema;
}

ordered_json material_schema() {
    ordered_json physical = schema_with_name(scene::PhysicalMaterial::fields());
    physical["properties"][model_word().name] = {{"description", model_word().doc}, {"const", "physical"}};
    physical["properties"][library_word().name] = {{"description", library_word().doc}, {"enum", scene::library_names()}};
    ordered_json classic = schema_with_name(scene::ClassicMaterial::fields());
    classic["properties"][model_word().name] = {{"description", model_word().doc}, {"const", "classic"}};
    classic["required"] = {model_word().name};
    for (auto* schema : {&physical, &classic}) {
        scene::Material model;
        if (schema == &classic) model.model = scene::ClassicMaterial{};
        ordered_json textures{{"description", textures_word().doc}};
        textures.update(textures_schema(model));
        (*schema)["properties"][textures_word().name] = textures;
    }
    // By the model, not by trying both: so that an editor tells what is wrong with the kind that is meant.
    return {{"type", "object"},
            {"if", {{"properties", {{model_word().name, {{"const", "classic"}}}}}, {"required", {model_word().name}}}},
            {"then", classic},
            {"else", physical}};
}

ordered_json texture_schema() {
    ordered_json schema = schema_of(scene::Texture::fields());
    schema["properties"].update(object_with(texture_words(), {{"image", text()}})["properties"]);
    return schema;
}

ordered_json numbers_or_threes(ordered_json one) {
    ordered_json three = list_of(one);
    three["minItems"] = 3;
    three["maxItems"] = 3;
    return list_of({{"anyOf", {std::move(one), std::move(three)}}});
}

void add_arrays(const geometry::Mesh&, ordered_json& schema) {
    const ordered_json whole{{"type", "integer"}, {"minimum", 0}};
    const ordered_json schemas{{"positions", numbers_or_threes(number())}, {"triangles", numbers_or_threes(whole)},
                               {"normals", numbers_or_threes(number())}, {"slots", list_of(whole)},
                               {"coordinates", list_of(number())}, {"coordinates_2", list_of(number())}, {"colors", list_of(number())}, {"tangents", list_of(number())}};
    schema["properties"].update(object_with(mesh_words(), schemas)["properties"]);
    schema["required"] = {"positions", "triangles"};
}
void add_arrays(const geometry::Polygon&, ordered_json& schema) {
    ordered_json loop = list_of(numbers_of(3));
    loop["minItems"] = 3;
    schema["properties"].update(object_with(polygon_words(), {{"loops", list_of(loop)}})["properties"]);
    schema["required"] = {"loops"};
}
void add_arrays(const geometry::Brep&, ordered_json& schema) {
    schema["properties"].update(object_with(brep_words(), {{"file", text()}, {"index", {{"type", "integer"}, {"minimum", 0}}}})["properties"]);
    schema["required"] = {"file"};
}
template <class Kind>
void add_arrays(const Kind&, ordered_json& schema) {
    if constexpr (has_spline_arrays<Kind>) add_spline_schema<Kind>(schema);
}

// Calls visit(name, a default shape) for each kind.
template <class Visit, std::size_t i = 0>
void for_each_kind(Visit&& visit) {
    if constexpr (i < std::variant_size_v<geometry::Shape>) {
        using Kind = std::variant_alternative_t<i, geometry::Shape>;
        visit(std::string(geometry::shape_names[i]), Kind{});
        for_each_kind<Visit, i + 1>(std::forward<Visit>(visit));
    }
}

ordered_json shape_schema() {
    ordered_json properties = ordered_json::object();
    ordered_json one_of = ordered_json::array();
    for_each_kind([&](const std::string& name, const auto& shape) {
        ordered_json schema = schema_of(std::remove_cvref_t<decltype(shape)>::fields());
        add_arrays(shape, schema);
        properties[name] = schema;
        one_of.push_back({{"required", ordered_json::array({name})}});
    });
    properties[name_word().name] = {{"description", name_word().doc}, {"type", "string"}};
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}, {"oneOf", one_of}};
}

ordered_json transform_schema() {
    const ordered_json axis{{"anyOf", {{{"enum", {"x", "y", "z"}}}, numbers_of(3)}}};
    ordered_json rotate = object_with(rotate_words(), {{"axis", axis}, {"angle", number()}});
    rotate["required"] = {"axis", "angle"};
    ordered_json step = object_with(transform_words(), {{"translate", numbers_of(3)},
                                                        {"rotate", rotate},
                                                        {"scale", {{"anyOf", {number(), numbers_of(3)}}}},
                                                        {"matrix", {{"anyOf", {numbers_of(12), numbers_of(16)}}}}});
    step["minProperties"] = 1;
    step["maxProperties"] = 1;
    return {{"anyOf", {step, list_of(step)}}};
}

ordered_json object_schema() {
    return object_with(object_words(), {{"name", text()},
                                        {"shape", {{"anyOf", {text(), ref("shape")}}}},
                                        {"material", {{"anyOf", {text(), ref("material")}}}},
                                        {"materials", list_of({{"anyOf", {text(), ref("material")}}})},
                                        {"transform", ref("transform")},
                                        {"motion", ref("transform")},
                                        {"instance", text()},
                                        {"file", text()},
                                        {"children", by_name_or_list("object")},
                                        {"visible", {{"type", "boolean"}}}});
}

// --- the reference

std::string type_text(const FieldInfo& info) {
    switch (info.type) {
    case FieldType::boolean: return "boolean";
    case FieldType::integer: return "whole number";
    case FieldType::number: return "number";
    case FieldType::angle: return "angle";
    case FieldType::text: return "text";
    case FieldType::names: return "names";
    case FieldType::vector: return "vector";
    case FieldType::color: return "colour";
    case FieldType::choice: {
        std::string choices;
        for (const auto& choice : info.choices) choices += (choices.empty() ? "`\"" : ", `\"") + choice + "\"`";
        return choices;
    }
    }
    return {};
}

std::string range_text(const FieldInfo& info) {
    if (info.type == FieldType::boolean || info.type == FieldType::choice || info.type == FieldType::text || info.type == FieldType::names) return {};
    if (info.minimum == -unbounded && info.maximum == unbounded) return {};
    if (info.maximum == unbounded) return "≥ " + scene::number_text(info.minimum);
    if (info.minimum == -unbounded) return "≤ " + scene::number_text(info.maximum);
    return scene::number_text(info.minimum) + " to " + scene::number_text(info.maximum);
}

std::string unit_text(const FieldInfo& info) {
    if (info.unit == "m") return "length";
    if (info.unit == "1/m") return "1/length";
    if (info.unit == "1/m^2") return "1/length²";
    return info.unit == "cd|lx" ? "cd, lx" : info.unit;
}

template <class Owner>
std::string field_table(const FieldTable<Owner>& table) {
    std::string out = "| field | type | unit | range | default | |\n|---|---|---|---|---|---|\n";
    const Owner standard{};
    for (const auto& f : table) {
        std::string value;
        print_json(write_value(f.get(standard), f.info, {}), value);
        out += "| `" + f.info.name + "` | " + type_text(f.info) + " | " + unit_text(f.info) + " | " + range_text(f.info) + " | `" + value + "` | " +
               table_cell(f.info.doc) + " |\n";
    }
    return out;
}

constexpr const char* introduction = R"(# The scene format

<!-- Generated by `crescente schema --manual`; do not edit. -->

A scene is a JSON file (`.json`). Unlike plain JSON it may have comments, `// to the end of the line` and `/* between */`. An editor that is
given [scene.schema.json](scene.schema.json) completes and checks it. A whole scene:

```json
{
  "unit": "cm",
  "camera": {"position": [0, 30, 80], "target": [0, 5, 0]},
  "lights": {"key": {"position": [40, 60, 40], "intensity": 0.8}},
  "materials": {
    "steel": {"base_color": 0.6, "metallic": 1, "roughness": 0.2},
    "glass": {"model": "classic", "diffuse": 0, "transmission": 0.9, "ior": 1.5, "fresnel": true}
  },
  "objects": {
    "ground": {"shape": {"plane": {}}},
    "ball": {"shape": {"sphere": {"radius": 10}}, "material": "steel", "transform": {"translate": [0, 10, 0]}}
  }
}
```

Everything may be left out but what is to be seen. A key that is not known, a value of the wrong type or out of range is an error; all are told at
once, each with its line and its JSON pointer, and the nearest spelling.

* **Lengths** are in the file's `unit`. Defaults below are in metres, whatever the unit. Distances and sizes inside the program are metres.
* **Axes**: right-handed, y up (or see `up`). Shapes keep their own axes: a cylinder stands along y.
* **Angles** are in degrees.
* **Colours** are `[r, g, b]` in linear light (Rec. 709 primaries), one number for grey, or `"#rrggbb"` as on the web (sRGB).
* **By name, or a list**: `{"key": {...}, "fill": {...}}` or `[{"name": "key", ...}, ...]`. References go by the key; a thing may bear another `name` than
  its key. In a list it goes by its `name`.
* **A material of the [library](materials.md)** is `{"library": "gold satin"}`, among the scene's materials or at the object itself.
* **Materials** that an object does not name come from the nearest object above that names some.

)";

constexpr const char* texture_introduction = R"(
```json
"plate": {"base_color": 0.7, "metallic": 1, "textures": {
  "roughness": {"kind": "brushed", "projection": "box", "size": 0.0005, "color_a": 0.9, "color_b": 0.4},
  "bump": {"kind": "brushed", "projection": "box", "size": 0.0005, "strength": 2e-6}
}}
```

A texture multiplies the field that it acts on: any colour or number of the material but `ior`, `attenuation` and `dispersion`, which are the same everywhere in a body. Besides it can act on
`normal` (a normal map, its green up the picture as in glTF), `bump` (a height), and `occlusion` (light from around that does not reach into creases). A list of textures acts one after the other.

Coordinates: with `uv` those of a mesh, or the parameters of an exact surface, with pictures upright: of native shapes shares of a turn and of the height, of faces of CAD files as their surface has them (of a cylinder
radians about its axis and metres along it); `box`, `planar`, `cylindrical` and `spherical` project from the place in the
shape's own space, from the middle of its box, in metres as the shape stands in the scene, so that a texture has its true size on a part without coordinates; around an axis whole repeats close the circle.

)";

}  // namespace

std::string scene_schema() {
    ordered_json units = ordered_json::array();
    for (const auto& unit : length_units()) units.push_back(unit.name);
    ordered_json document = object_with(document_words(), {{"$schema", text()},
                                                           {"name", text()},
                                                           {"unit", {{"enum", units}, {"default", "m"}}},
                                                           {"up", {{"enum", {"y", "z"}}, {"default", "y"}}},
                                                           {"settings", ref("settings")},
                                                           {"camera", ref("camera")},
                                                           {"environment", ref("environment")},
                                                           {"lights", by_name_or_list("light")},
                                                           {"materials", by_name_or_list("material")},
                                                           {"shapes", by_name_or_list("shape")},
                                                           {"groups", by_name_or_list("object")},
                                                           {"objects", by_name_or_list("object")}});
    ordered_json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Crescente scene"}};
    schema.update(document);
    schema["$defs"] = {{"settings", schema_of(scene::Settings::fields())},
                       {"camera", schema_of(scene::Camera::fields())},
                       {"environment", schema_of(scene::Environment::fields())},
                       {"light", schema_with_name(scene::Light::fields())},
                       {"material", material_schema()},
                       {"texture", texture_schema()},
                       {"shape", shape_schema()},
                       {"transform", transform_schema()},
                       {"object", object_schema()}};
    std::string out;
    print_json(schema, out);
    return out + "\n";
}

std::string scene_reference() {
    std::string out = introduction;
    out += "## The document\n\n" + word_table(document_words());
    out += "\nUnits of length:";
    for (const auto& unit : length_units()) out += (&unit == length_units().data() ? " `\"" : ", `\"") + unit.name + "\"`";
    out += ".\n\n## Settings\n\n" + field_table(scene::Settings::fields());
    out += "\n## Camera\n\n" + field_table(scene::Camera::fields());
    out += "\n## Environment\n\n" + field_table(scene::Environment::fields());
    out += "\n## Lights\n\n" + field_table(scene::Light::fields());
    const Word own[] = {model_word(), library_word()};
    out += "\n## Materials\n\n" + word_table(own);
    out += "\n### Physical\n\n" + field_table(scene::PhysicalMaterial::fields());
    out += "\n### Classic\n\n" + field_table(scene::ClassicMaterial::fields());
    out += "\n### Textures\n\n" + word_table({&textures_word(), 1}) + texture_introduction + word_table(texture_words()) + "\n" + field_table(scene::Texture::fields());
    out += "\n## Shapes\n\nA shape is an object with one member, its kind: `{\"sphere\": {\"radius\": 1}}`.\n";
    for_each_kind([&](const std::string& name, const auto& shape) {
        using Kind = std::remove_cvref_t<decltype(shape)>;
        out += "\n### " + name + "\n\n";
        if (!Kind::fields().empty()) out += field_table(Kind::fields());
        if constexpr (has_spline_arrays<Kind>) out += (Kind::fields().empty() ? "" : "\n") + word_table(spline_words<Kind>());
        else if (!Kind::fields().empty()) return;
        else if constexpr (std::is_same_v<Kind, geometry::Mesh>) out += word_table(mesh_words());
        else if constexpr (std::is_same_v<Kind, geometry::Polygon>) out += word_table(polygon_words());
        else if constexpr (std::is_same_v<Kind, geometry::Brep>) out += "The exact faces of a CAD part, in that file's own units and axes. Only among the scene's `shapes`.\n\n" + word_table(brep_words());
        else out += "No parameters.\n";
    });
    out += "\n### Curves\n\nOf revolution, extrusion and ruled.\n\n" + field_table(geometry::Curve::fields()) + "\n" + word_table(curve_words());
    out += "\n## Objects and groups\n\n" + word_table(object_words());
    out += "\n### Steps of a transform\n\n" + word_table(transform_words());
    out += "\n### rotate\n\n" + word_table(rotate_words());
    return out;
}

}  // namespace crescente::io
