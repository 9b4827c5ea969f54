#include "io/overrides.h"

#include "io/set_value.h"

namespace crescente::io {
namespace {

// The value as JSON: what is no JSON by itself is a list without its brackets, or a text without its quotes.
Json value_json(std::string_view text) {
    ProblemList ignored{""};
    if (auto json = parse_json(text, ignored)) return std::move(*json);
    if (text.find(',') != std::string_view::npos) {
        if (auto json = parse_json("[" + std::string(text) + "]", ignored)) return std::move(*json);
    }
    return Json{std::string(text)};
}

}  // namespace

Expected<Problems> apply_override(scene::Scene& scene, std::string_view assignment) {
    const std::string whole{assignment.substr(0, 300)};
    // Neither values nor fields have an equals sign, but names may.
    const auto equals = assignment.rfind('=');
    if (equals == std::string_view::npos) return failure(ErrorKind::usage, {{}, whole, "has no '='", "write what.name.field=value"});

    const std::string_view value = assignment.substr(equals + 1);
    const auto set = [&](const Json& json) -> Expected<Problems> {
        ProblemList problems{""};
        scene::Draft draft(scene);
        set_value(draft, assignment.substr(0, equals), json, {scene.unit.metres, scene.unit.name}, Place{}, problems);
        Error error{ErrorKind::usage, problems.take()};
        for (Problem& problem : error.problems) problem.place = whole;
        if (!error.problems.empty()) return tl::unexpected(std::move(error));
        apply_unchecked(draft.edits(), scene);
        return problems.warnings();
    };
    auto warnings = set(value_json(value));
    if (warnings) return warnings;
    auto as_text = set(Json{std::string(value)});  // "160,40" may be meant as a text
    return as_text ? as_text : warnings;
}

}  // namespace crescente::io
