#include "io/scene_parts.h"

#include <cmath>

#include "base/spelling.h"
#include "io/scene_words.h"
#include "io/spline_parts.h"
#include "io/texture_parts.h"

namespace crescente::io {
namespace {

using geometry::Shape;
using math::Affine;
using math::Vec3;

void must_be(const Json& json, const Place& place, const std::string& wanted, ProblemList& problems) {
    problems.add(json, place, "is " + std::string(json.kind()) + ", must be " + wanted);
}

// Calls `take` for each number of a list, flat or in lists of three.
template <class Take>
void for_each_number(const Json& json, const Place& place, ProblemList& problems, Take&& take) {
    if (!json.array()) return must_be(json, place, "a list of numbers", problems);
    std::size_t index = 0;
    for (const Json& element : *json.array()) {
        const Place here = place / index++;
        if (!element.array()) {
            take(element, here);
            continue;
        }
        if (element.array()->size() != 3) {
            problems.add(element, here, "has " + std::to_string(element.array()->size()) + " elements, must have 3");
            continue;
        }
        std::size_t inner = 0;
        for (const Json& component : *element.array()) take(component, here / inner++);
    }
}

std::vector<double> read_numbers(const Json& json, const Place& place, ProblemList& problems) {
    std::vector<double> numbers;
    if (json.array()) numbers.reserve(json.array()->size());
    for_each_number(json, place, problems, [&](const Json& element, const Place& here) {
        if (const auto number = element.number()) numbers.push_back(*number);
        else must_be(element, here, "a number", problems);
    });
    return numbers;
}

template <class Integer>
std::vector<Integer> read_indices(const Json& json, const Place& place, ProblemList& problems) {
    constexpr auto largest = std::numeric_limits<Integer>::max() - 1;
    std::vector<Integer> indices;
    if (json.array()) indices.reserve(json.array()->size());
    for_each_number(json, place, problems, [&](const Json& element, const Place& here) {
        const auto* integer = element.integer();
        if (integer && *integer >= 0 && *integer <= static_cast<std::int64_t>(largest)) indices.push_back(static_cast<Integer>(*integer));
        else problems.add(element, here, "must be a whole number from 0 to " + std::to_string(largest));
    });
    return indices;
}

bool threes(std::size_t size, const Json& json, const Place& place, ProblemList& problems) {
    if (size % 3 == 0) return true;
    problems.add(json, place, "has " + std::to_string(size) + " numbers, which is no multiple of 3");
    return false;
}

// A flat list of numbers, n for each vertex.
template <std::size_t n>
void read_attributes(const Json& json, std::string_view key, std::vector<std::array<float, n>>& attributes, const Place& place, ProblemList& problems) {
    const Json* list = json.find(key);
    if (!list) return;
    const auto numbers = read_numbers(*list, place / key, problems);
    if (numbers.size() % n != 0) return problems.add(*list, place / key, "has " + std::to_string(numbers.size()) + " numbers, which is no multiple of " + std::to_string(n));
    for (std::size_t i = 0; i < numbers.size(); i += n) {
        std::array<float, n> one;
        for (std::size_t k = 0; k < n; ++k) one[k] = static_cast<float>(numbers[i + k]);
        attributes.push_back(one);
    }
}

void read_arrays(const Json& json, geometry::Mesh& mesh, const Measure& measure, const Place& place, ProblemList& problems) {
    if (const Json* positions = json.find("positions")) {
        const Place here = place / "positions";
        const auto numbers = read_numbers(*positions, here, problems);
        if (threes(numbers.size(), *positions, here, problems)) {
            mesh.positions.reserve(numbers.size() / 3);
            for (std::size_t i = 0; i < numbers.size(); i += 3) {
                mesh.positions.push_back(Vec3{numbers[i], numbers[i + 1], numbers[i + 2]} * measure.metres);
            }
        }
    }
    if (const Json* triangles = json.find("triangles")) {
        const Place here = place / "triangles";
        const auto indices = read_indices<std::uint32_t>(*triangles, here, problems);
        if (threes(indices.size(), *triangles, here, problems)) {
            mesh.triangles.reserve(indices.size() / 3);
            for (std::size_t i = 0; i < indices.size(); i += 3) mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
        }
    }
    if (const Json* normals = json.find("normals")) {
        const Place here = place / "normals";
        const auto numbers = read_numbers(*normals, here, problems);
        if (threes(numbers.size(), *normals, here, problems)) {
            mesh.normals.reserve(numbers.size() / 3);
            for (std::size_t i = 0; i < numbers.size(); i += 3) {
                mesh.normals.push_back({float(numbers[i]), float(numbers[i + 1]), float(numbers[i + 2])});
            }
        }
    }
    read_attributes(json, "coordinates", mesh.coordinates[0], place, problems);
    read_attributes(json, "coordinates_2", mesh.coordinates[1], place, problems);
    read_attributes(json, "colors", mesh.colors, place, problems);
    read_attributes(json, "tangents", mesh.tangents, place, problems);
    if (const Json* slots = json.find("slots")) mesh.slots = read_indices<std::uint16_t>(*slots, place / "slots", problems);
}

void read_arrays(const Json& json, geometry::Polygon& polygon, const Measure& measure, const Place& place, ProblemList& problems) {
    const Json* loops = json.find("loops");
    if (!loops) return;
    const Place here = place / "loops";
    if (!loops->array()) return must_be(*loops, here, "a list of loops", problems);
    std::size_t index = 0;
    for (const Json& loop : *loops->array()) {
        const Place there = here / index++;
        auto& points = polygon.loops.emplace_back();
        if (!loop.array()) {
            must_be(loop, there, "a list of points", problems);
            continue;
        }
        std::size_t number = 0;
        for (const Json& point : *loop.array()) {
            const auto p = read_vector(point, there / number++, problems);
            if (p) points.push_back(Vec3{(*p)[0], (*p)[1], (*p)[2]} * measure.metres);
        }
    }
}

template <class Kind>
void read_arrays(const Json& json, Kind& shape, const Measure& measure, const Place& place, ProblemList& problems) {
    if constexpr (has_spline_arrays<Kind>) read_spline_arrays(json, shape, measure, place, problems);
}

template <class Kind>
std::vector<std::string> array_names() {
    if constexpr (std::is_same_v<Kind, geometry::Mesh>) return names_of(mesh_words());
    else if constexpr (std::is_same_v<Kind, geometry::Polygon>) return names_of(polygon_words());
    else if constexpr (has_spline_arrays<Kind>) return names_of(spline_words<Kind>());
    else return {};
}

// The variant's default of the kind with this index.
template <std::size_t i = 0>
Shape shape_of_kind(std::size_t kind) {
    if constexpr (i + 1 < std::variant_size_v<Shape>) {
        if (kind != i) return shape_of_kind<i + 1>(kind);
    }
    return Shape{std::in_place_index<i>};
}

std::optional<Vec3> read_axis(const Json& json, const Place& place, ProblemList& problems) {
    if (const auto* text = json.text()) {
        if (*text == "x") return Vec3{1, 0, 0};
        if (*text == "y") return Vec3{0, 1, 0};
        if (*text == "z") return Vec3{0, 0, 1};
        problems.add(json, place, "'" + text->substr(0, 100) + "' is no axis", "\"x\", \"y\", \"z\" or [x, y, z]");
        return std::nullopt;
    }
    const auto v = read_vector(json, place, problems);
    if (!v) return std::nullopt;
    const Vec3 axis{(*v)[0], (*v)[1], (*v)[2]};
    const double l = length(axis);
    if (l > 0 && std::isfinite(l)) return axis;
    problems.add(json, place, "the axis has no direction: its length is " + scene::number_text(l));
    return std::nullopt;
}

Affine read_rotation(const Json& json, const Place& place, ProblemList& problems) {
    if (!json.object()) return must_be(json, place, "an object with axis and angle", problems), Affine{};
    const auto known = names_of(rotate_words());
    for (const auto& member : *json.object()) {
        if (std::find(known.begin(), known.end(), member.key) == known.end()) unknown_member(member, place, known, problems);
    }
    const Json *axis = json.find("axis"), *angle = json.find("angle");
    if (!axis || !angle) return problems.add(json, place, std::string(axis ? "angle" : "axis") + " is missing"), Affine{};
    const auto direction = read_axis(*axis, place / "axis", problems);
    const auto degrees = angle->number();
    if (!degrees) must_be(*angle, place / "angle", "a number of degrees", problems);
    return direction && degrees ? Affine::rotation(*direction, *degrees * math::pi / 180) : Affine{};
}

Affine read_scale(const Json& json, const Place& place, ProblemList& problems) {
    if (const auto factor = json.number()) return Affine::scaling({*factor, *factor, *factor});
    if (!json.array()) return must_be(json, place, "a number or three", problems), Affine{};
    const auto v = read_vector(json, place, problems);
    return v ? Affine::scaling({(*v)[0], (*v)[1], (*v)[2]}) : Affine{};
}

Affine read_matrix(const Json& json, const Measure& measure, const Place& place, ProblemList& problems) {
    if (!json.array() || (json.array()->size() != 12 && json.array()->size() != 16)) {
        return must_be(json, place, "a list of 12 or 16 numbers", problems), Affine{};
    }
    double m[16] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1};
    for (std::size_t i = 0; i < json.array()->size(); ++i) {
        const Json& element = (*json.array())[i];
        const auto number = element.number();
        if (!number) return must_be(element, place / i, "a number", problems), Affine{};
        m[i] = *number;
    }
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) {
        problems.add(json, place, "the fourth row must be 0, 0, 0, 1", "matrices are written row by row");
    }
    return {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}, Vec3{m[3], m[7], m[11]} * measure.metres};
}

Affine read_step(const Json& json, const Measure& measure, const Place& place, ProblemList& problems) {
    const auto known = names_of(transform_words());
    if (!json.object() || json.object()->size() != 1) {
        problems.add(json, place, "a step of a transform is an object with one member", spelling_hint("", known));
        return {};
    }
    const auto& step = json.object()->front();
    const Place here = place / step.key;
    if (step.key == "rotate") return read_rotation(step.value, here, problems);
    if (step.key == "scale") return read_scale(step.value, here, problems);
    if (step.key == "matrix") return read_matrix(step.value, measure, here, problems);
    if (step.key == "translate") {
        const auto v = read_vector(step.value, here, problems);
        return v ? Affine::translation(Vec3{(*v)[0], (*v)[1], (*v)[2]} * measure.metres) : Affine{};
    }
    unknown_member(step, place, known, problems);
    return {};
}

}  // namespace

std::optional<Shape> read_shape(const Json& json, const Measure& measure, const Place& place, ProblemList& problems) {
    if (!json.object()) {
        must_be(json, place, "an object that says a shape's kind", problems);
        return std::nullopt;
    }
    std::vector<std::string> kinds(std::begin(geometry::shape_names), std::end(geometry::shape_names));
    static_assert(std::is_same_v<std::variant_alternative_t<std::variant_size_v<Shape> - 1, Shape>, geometry::Brep>);
    kinds.pop_back();  // its faces come from CAD files
    std::optional<Shape> shape;
    bool says_a_kind = false;
    for (const auto& member : *json.object()) {
        if (member.key == name_word().name) continue;
        says_a_kind = true;
        if (member.key == *std::rbegin(geometry::shape_names)) {
            problems.add(member.value, place / member.key, "exact faces of a model file are named among the `shapes` of a scene file only");
            continue;
        }
        const auto kind = std::find(kinds.begin(), kinds.end(), member.key);
        if (kind == kinds.end()) {
            unknown_member(member, place, kinds, problems);
            continue;
        }
        if (shape) {
            problems.add(member.value, place / member.key, "a shape has one kind only");
            continue;
        }
        shape = shape_of_kind(static_cast<std::size_t>(kind - kinds.begin()));
        std::visit([&](auto& s) {
            using Kind = std::remove_cvref_t<decltype(s)>;
            const Place here = place / member.key;
            read_fields(member.value, s, Kind::fields(), measure, here, problems, array_names<Kind>());
            read_arrays(member.value, s, measure, here, problems);
        }, *shape);
    }
    if (!says_a_kind) problems.add(json, place, "says no kind of shape", spelling_hint("", kinds));
    return shape;
}

const scene::LibraryMaterial* read_library_material(const Json& json, const Place& place, ProblemList& problems) {
    if (!json.text()) return must_be(json, place, "a text", problems), nullptr;
    if (const scene::LibraryMaterial* found = scene::find_in_library(*json.text())) return found;
    const std::string hint = spelling_hint(*json.text(), scene::library_names());
    problems.add(json, place, "there is no material '" + json.text()->substr(0, 100) + "' in the library", hint.empty() ? "see crescente materials" : hint);
    return nullptr;
}

scene::Material read_material(const Json& json, const Measure& measure, const Place& place, ProblemList& problems) {
    scene::Material material;
    const std::string own[] = {name_word().name, model_word().name, library_word().name, textures_word().name};
    const std::vector<std::string> models{"physical", "classic"};
    if (const Json* model = json.find(own[1])) {
        if (!model->text()) must_be(*model, place / own[1], "a text", problems);
        else if (*model->text() == "classic") material.model = scene::ClassicMaterial{};
        else if (*model->text() != "physical") {
            problems.add(*model, place / own[1], "'" + model->text()->substr(0, 100) + "' is no model", spelling_hint(*model->text(), models));
            return material;  // its fields would all be unknown to the wrong model
        }
    }
    const scene::LibraryMaterial* found = nullptr;
    if (const Json* library = json.find(own[2])) {
        found = read_library_material(*library, place / own[2], problems);
        auto* physical = std::get_if<scene::PhysicalMaterial>(&material.model);
        if (!physical) problems.add(*library, place / own[2], "a classic material is not in the library");
        else if (found) *physical = found->material;
    }
    std::visit([&](auto& m) {
        read_fields(json, m, std::remove_cvref_t<decltype(m)>::fields(), measure, place, problems, own);
    }, material.model);
    if (const Json* textures = json.find(own[3])) read_textures(*textures, material, measure, place / own[3], problems);
    if (found && std::holds_alternative<scene::PhysicalMaterial>(material.model)) {  // textures that are said stand in for the library's
        const std::vector<scene::TextureBinding> said = material.textures;
        for (const scene::TextureBinding& binding : found->textures) {
            if (std::none_of(said.begin(), said.end(), [&](const auto& one) { return one.target == binding.target; })) material.textures.push_back(binding);
        }
    }
    return material;
}

scene::Material read_own_material(const Json& json, const Measure& measure, const Place& place, ProblemList& problems) {
    scene::Material material = read_material(json, measure, place, problems);
    const Json* library = json.find(library_word().name);
    const Json* name = json.find(name_word().name);
    if (name && !name->text()) must_be(*name, place / name_word().name, "a text", problems);
    else if (name) material.name = *name->text();
    else if (library && library->text()) material.name = *library->text();
    return material;
}

Affine read_transform(const Json& json, const Measure& measure, const Place& place, ProblemList& problems) {
    if (!json.array()) return read_step(json, measure, place, problems);
    Affine transform;
    std::size_t index = 0;
    for (const Json& step : *json.array()) transform = read_step(step, measure, place / index++, problems) * transform;
    return transform;
}

Measure measure_of(const scene::Scene& scene) {
    const LengthUnit* unit = find_unit(scene.unit.name);
    if (unit && unit->metres == scene.unit.metres) return {unit->metres, unit->name};
    return {};
}

void write_material(const scene::Material& material, const Measure& measure, nlohmann::ordered_json& object) {
    if (std::holds_alternative<scene::ClassicMaterial>(material.model)) object[model_word().name] = "classic";
    std::visit([&](const auto& model) { write_fields(model, std::remove_cvref_t<decltype(model)>::fields(), measure, object); }, material.model);
    if (!material.textures.empty()) object[textures_word().name] = write_textures(material, measure);
}

}  // namespace crescente::io
