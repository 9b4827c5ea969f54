#include "app/cli/lens_options.h"

#include <cmath>

#include "app/cli/quantities.h"
#include "render/focus.h"
#include "scene/field_check.h"

namespace crescente::app {
namespace {

const Field<scene::Camera>& field_named(const std::string& name) {
    for (const auto& field : scene::Camera::fields()) {
        if (field.info.name == name) return field;
    }
    std::abort();  // an option names a field that does not exist
}

}  // namespace

Expected<LensRequest> parse_lens(const LensOptions& options) {
    LensRequest request;
    Problems problems;
    const auto read = [&](const std::string& option, const std::optional<std::string>& text, std::initializer_list<const char*> names) {
        if (!text) return;
        const auto numbers = parse_numbers(option, *text);
        if (!numbers || numbers->size() != names.size()) {
            const std::string wanted = names.size() == 1 ? "a number" : std::to_string(names.size()) + " numbers between commas";
            problems.push_back({"", option, "'" + *text + "' is not " + wanted, ""});
            return;
        }
        auto number = numbers->begin();
        for (const char* name : names) {
            const auto& field = field_named(name);
            const double v = *number++;
            const bool integer = field.info.type == FieldType::integer;
            const FieldValue value = integer ? FieldValue{static_cast<std::int64_t>(std::clamp(v, -1e9, 1e9))} : FieldValue{v};
            if (integer && v != std::floor(v)) problems.push_back({"", option, "'" + *text + "' is not a whole number", ""});
            else if (const auto wrong = scene::range_problem(field.info, value, 1, "")) problems.push_back({"", option, *wrong, ""});
            else request.fields.emplace_back(&field, value);
        }
    };
    read("--aperture", options.aperture, {"aperture"});
    request.focus_on_middle = options.focus == "auto";
    if (!request.focus_on_middle) read("--focus", options.focus, {"focus_distance"});
    read("--blades", options.blades, {"blades"});
    read("--shutter", options.shutter, {"shutter_open", "shutter_close"});
    if (!problems.empty()) return tl::unexpected<Error>({ErrorKind::usage, std::move(problems)});
    return request;
}

void set_lens(const LensRequest& request, scene::Scene& scene) {
    for (const auto& [field, value] : request.fields) {
        const bool length = field->info.unit == "m";
        field->set(*scene.camera, length ? FieldValue{std::get<double>(value) * scene.unit.metres} : value);
    }
}

Expected<void> focus_on_middle(scene::Scene& scene) {
    const auto distance = render::distance_in_the_middle(scene);
    if (!distance) return tl::unexpected(distance.error());
    if (!*distance) return failure(ErrorKind::usage, {"", "--focus", "there is nothing in the middle of the picture to focus on", "give a distance"});
    scene.camera->focus_distance = **distance;
    return {};
}

}  // namespace crescente::app
