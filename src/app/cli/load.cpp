#include "app/cli/load.h"

#include <algorithm>

#include "io/overrides.h"
#include "io/panorama_file.h"
#include "scene/studio.h"
#include "scene/validate.h"

namespace crescente::app {
namespace {

bool emits(const scene::Material& material) {
    if (const auto* classic = std::get_if<scene::ClassicMaterial>(&material.model)) return !math::is_black(classic->emission);
    return !math::is_black(std::get<scene::PhysicalMaterial>(material.model).emissive);
}

// Whether something in the scene lights it.
bool lit(const scene::Scene& scene) {
    if (!scene.lights.empty() || (scene.environment && scene.environment->lights())) return true;
    return std::any_of(scene.materials.begin(), scene.materials.end(), emits);
}

Expected<void> apply_overrides(const std::vector<std::string>& overrides, scene::Scene& scene) {
    Error wrong{ErrorKind::usage, {}};
    for (const std::string& text : overrides) {
        if (const auto applied = io::apply_override(scene, text); !applied) {
            wrong.problems.insert(wrong.problems.end(), applied.error().problems.begin(), applied.error().problems.end());
        }
    }
    if (!wrong.problems.empty()) return tl::unexpected<Error>(std::move(wrong));
    return {};
}

// Each option is in range by itself: what is wrong with the settings as a whole (a picture of too many pixels) comes of their combination.
bool concerns_settings_together(const Problem& problem) { return problem.place == "/settings"; }

// Whether camera and lights can be fitted to the scene.
Expected<void> check_extent(const SceneRequest& request, const scene::Scene& scene) {
    const auto box = scene::bounds(scene);
    if (scene::can_be_framed(box)) return {};
    const char* reason = box.empty() ? "the scene is empty: there is nothing to frame" : "the scene is too large to be framed or lit";
    return failure(ErrorKind::input, {request.file, "", reason, ""});
}

// Daylight, if it is asked for; camera, lights and ground for what has none.
Expected<void> furnish(const SceneRequest& request, scene::Scene& scene) {
    if (request.daylight) {
        if (const auto fits = check_extent(request, scene); !fits) return fits;
        const auto box = scene::bounds(scene);
        scene::add_daylight(scene, *request.daylight, box.center(), std::max(length(box.diagonal()) / 2, 1e-9));
    }
    if (const auto placed = place_camera(request.view, scene); !placed) return placed;
    if (!scene.camera || request.asked_studio || (request.studio && !lit(scene))) {
        if (const auto fits = check_extent(request, scene); !fits) return fits;
        if (request.studio) {
            scene::add_studio(scene, request.asked_studio);
        } else {
            scene::Scene framed = scene;  // the camera of the studio without its lights
            scene::add_studio(framed);
            scene.camera = framed.camera;
        }
    }
    set_projection(request.view, *scene.camera);
    return {};
}

// The camera may be one that was made here: what is asked of its lens is looked at as a whole.
Expected<void> look_through_lens(const SceneRequest& request, scene::Scene& scene) {
    set_lens(request.lens, scene);
    if (auto problems = scene::validate(scene, request.file); !problems.empty()) return tl::unexpected<Error>({ErrorKind::usage, std::move(problems)});
    return request.lens.focus_on_middle ? focus_on_middle(scene) : Expected<void>{};
}

}  // namespace

Expected<io::Loaded> load(const SceneRequest& request, const io::ReadOptions& options) {
    io::ReadOptions reading = options;
    reading.texture_pattern = request.texture_pattern;
    auto loaded = io::read_scene(request.file, reading);
    if (!loaded) return loaded;
    scene::Scene& scene = loaded->scene;

    for (const auto& [field, value] : request.settings) field->set(scene.settings, value);
    if (request.environment) {
        if (!scene.environment) scene.environment.emplace();
        scene.environment->image = *request.environment;
        auto warnings = io::load_panorama(*scene.environment, {});
        if (!warnings) return tl::unexpected<Error>(std::move(warnings.error()));
        loaded->warnings.insert(loaded->warnings.end(), warnings->begin(), warnings->end());
    }
    if (const auto applied = apply_overrides(request.overrides, scene); !applied) return tl::unexpected<Error>(applied.error());

    if (auto problems = scene::validate(scene, request.file); !problems.empty()) {
        const bool from_options = !request.settings.empty() && std::all_of(problems.begin(), problems.end(), concerns_settings_together);
        return tl::unexpected<Error>({from_options ? ErrorKind::usage : ErrorKind::input, std::move(problems)});
    }
    if (const auto furnished = furnish(request, scene); !furnished) return tl::unexpected<Error>(furnished.error());
    const bool asked = !request.lens.fields.empty() || request.lens.focus_on_middle;
    if (const auto seen = asked ? look_through_lens(request, scene) : Expected<void>{}; !seen) return tl::unexpected<Error>(seen.error());
    return loaded;
}

}  // namespace crescente::app
