#include "io/overrides.h"

#include <algorithm>

#include "base/spelling.h"
#include "io/json_fields.h"

namespace crescente::io {
namespace {

using scene::Scene;

tl::unexpected<Error> wrong(std::string_view assignment, std::string reason, std::string hint = {}) {
    return failure(ErrorKind::usage, {{}, std::string(assignment.substr(0, 300)), std::move(reason), std::move(hint)});
}

// "material.chrome.roughness=0.1" in its parts; the name is empty where there is none.
struct Assignment {
    std::string_view whole, what, name, field, value;
    bool has_name = false;
};

Expected<Assignment> split(std::string_view text) {
    Assignment parts;
    parts.whole = text;
    // Neither values nor fields have an equals sign, but names may.
    const auto equals = text.rfind('=');
    if (equals == std::string_view::npos) return wrong(text, "has no '='", "write what.name.field=value");
    parts.value = text.substr(equals + 1);
    const std::string_view path = text.substr(0, equals);
    const auto first = path.find('.'), last = path.rfind('.');
    if (first == std::string_view::npos) return wrong(text, "has no '.'", "write what.name.field=value, such as settings.threshold=0.01");
    parts.what = path.substr(0, first);
    parts.field = path.substr(last + 1);
    parts.has_name = last > first;
    if (parts.has_name) parts.name = path.substr(first + 1, last - first - 1);
    if (parts.name.size() >= 2 && parts.name.front() == '"' && parts.name.back() == '"') parts.name = parts.name.substr(1, parts.name.size() - 2);
    return parts;
}

// The value as JSON: what is no JSON by itself is a list without its brackets, or a text without its quotes.
Json value_json(std::string_view text, FieldType type) {
    ProblemList ignored{""};
    if (auto json = parse_json(text, ignored)) return std::move(*json);
    if (type == FieldType::vector || type == FieldType::color) {
        if (auto json = parse_json("[" + std::string(text) + "]", ignored)) return std::move(*json);
    }
    return Json{std::string(text)};
}

template <class Owner>
Expected<void> set_field(Owner& owner, const Assignment& parts, const Measure& measure) {
    const auto& table = Owner::fields();
    const auto found = std::find_if(table.begin(), table.end(), [&](const auto& f) { return f.info.name == parts.field; });
    if (found == table.end()) {
        return wrong(parts.whole, "'" + std::string(parts.field) + "' is no field of " + std::string(parts.what), spelling_hint(parts.field, names_of(table)));
    }
    ProblemList problems{""};
    const auto value = read_value(value_json(parts.value, found->info.type), found->info, measure, Place{}, problems);
    if (value) {
        found->set(owner, *value);
        return {};
    }
    Error error{ErrorKind::usage, problems.take()};
    for (Problem& problem : error.problems) problem.place = parts.whole;
    return tl::unexpected(std::move(error));
}

Expected<void> set_model(scene::Material& material, const Assignment& parts, const Measure& measure) {
    return std::visit([&](auto& model) { return set_field(model, parts, measure); }, material.model);
}
Expected<void> set_model(scene::NamedShape& shape, const Assignment& parts, const Measure& measure) {
    return std::visit([&](auto& s) { return set_field(s, parts, measure); }, shape.shape);
}
Expected<void> set_model(scene::Light& light, const Assignment& parts, const Measure& measure) { return set_field(light, parts, measure); }

// All things of the name; all or none are changed.
template <class Things>
Expected<void> set_named(Things& things, const Assignment& parts, const Measure& measure) {
    const std::string what{parts.what};
    if (!parts.has_name) return wrong(parts.whole, "which " + what + " is meant?", "write " + what + ".name.field=value");
    std::vector<std::pair<std::size_t, typename Things::value_type>> changed;
    for (std::size_t i = 0; i < things.size(); ++i) {
        if (things[i].name.empty() ? std::to_string(i) != parts.name : things[i].name != parts.name) continue;
        changed.emplace_back(i, things[i]);
        if (auto done = set_model(changed.back().second, parts, measure); !done) return done;
    }
    if (changed.empty()) {
        std::vector<std::string> names;
        constexpr std::size_t most_candidates = 10000;
        for (std::size_t i = 0; i < std::min(things.size(), most_candidates); ++i) {
            names.push_back(things[i].name.empty() ? std::to_string(i) : things[i].name);
        }
        return wrong(parts.whole, "there is no " + what + " '" + std::string(parts.name) + "'", spelling_hint(parts.name, names));
    }
    for (auto& [index, thing] : changed) things[index] = std::move(thing);
    return {};
}

template <class Owner>
Expected<void> set_single(Owner& owner, const Assignment& parts, const Measure& measure) {
    if (parts.has_name) return wrong(parts.whole, "there is only one " + std::string(parts.what), "write " + std::string(parts.what) + "." + std::string(parts.field));
    return set_field(owner, parts, measure);
}

}  // namespace

Expected<void> apply_override(Scene& scene, std::string_view assignment) {
    const auto parts = split(assignment);
    if (!parts) return tl::unexpected(parts.error());
    const Measure measure{scene.unit.metres, scene.unit.name};
    if (parts->what == "settings") return set_single(scene.settings, *parts, measure);
    if (parts->what == "light") return set_named(scene.lights, *parts, measure);
    if (parts->what == "material") return set_named(scene.materials, *parts, measure);
    if (parts->what == "shape") return set_named(scene.shapes, *parts, measure);
    if (parts->what == "camera") {
        if (!scene.camera) return wrong(assignment, "the scene has no camera yet");
        return set_single(*scene.camera, *parts, measure);
    }
    if (parts->what == "environment") {
        scene::Environment environment = scene.environment.value_or(scene::Environment{});
        auto done = set_single(environment, *parts, measure);
        if (done) scene.environment = environment;
        return done;
    }
    const std::vector<std::string> known{"settings", "camera", "environment", "light", "material", "shape"};
    return wrong(assignment, "'" + std::string(parts->what) + "' is nothing that can be set", spelling_hint(parts->what, known));
}

}  // namespace crescente::io
