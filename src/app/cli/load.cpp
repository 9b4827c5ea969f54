#include "app/cli/load.h"

#include <algorithm>
#include <future>
#include <optional>

#include "io/overrides.h"
#include "io/panorama_file.h"
#include "scene/studio.h"
#include "scene/validate.h"

namespace crescente::app {
namespace {

// Returns warnings.
Expected<Problems> apply_overrides(const std::vector<std::string>& overrides, scene::Scene& scene) {
    Error wrong{ErrorKind::usage, {}};
    Problems warnings;
    for (const std::string& text : overrides) {
        const auto applied = io::apply_override(scene, text);
        Problems& told = applied ? warnings : wrong.problems;
        const Problems& more = applied ? *applied : applied.error().problems;
        told.insert(told.end(), more.begin(), more.end());
    }
    if (!wrong.problems.empty()) return tl::unexpected<Error>(std::move(wrong));
    return warnings;
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

// Camera, lights, ground and backdrop, as asked for or for what has none.
Expected<void> furnish(const SceneRequest& request, scene::Scene& scene) {
    if (const auto placed = place_camera(request.view, scene); !placed) return placed;
    const bool lights = request.asked_studio || (request.studio && !scene::shines(scene));
    if (!scene.camera || lights || request.ground) {
        if (const auto fits = check_extent(request, scene); !fits) return fits;
        if (!scene.camera) scene::add_camera(scene);
        const scene::Placement at(scene);  // of the model alone: the ground is much larger
        if (lights) scene::add_studio_lights(scene, at, request.asked_studio.value_or(scene::Studio::standard));
        if (lights || request.ground) scene::add_ground(scene, at, request.ground.value_or(scene::Ground::studio));
    }
    set_projection(request.view, *scene.camera);
    if (request.background) {
        if (!scene.environment) scene.environment.emplace();
        scene.environment->transparent = !request.background->color;
        if (request.background->color) {
            scene.environment->backdrop = true;
            scene.environment->backdrop_bottom = scene.environment->backdrop_top = *request.background->color;
        }
    }
    return {};
}

// The camera may be one that was made here: what is asked of its lens is looked at as a whole.
Expected<void> look_through_lens(const SceneRequest& request, scene::Scene& scene) {
    set_lens(request.lens, scene);
    if (auto problems = scene::validate(scene, request.file); !problems.empty()) return tl::unexpected<Error>({ErrorKind::usage, std::move(problems)});
    return request.lens.focus_on_middle ? focus_on_middle(scene) : Expected<void>{};
}

struct Surroundings {
    scene::Environment environment;  // image or sky, and panorama
    Expected<Problems> warnings;
};

// Begun at once, as it takes as long as many a model.
std::future<Surroundings> surroundings_of(const SceneRequest& request) {
    if (!request.environment && !request.sky) return {};
    return std::async([image = request.environment.value_or(""), sky = request.sky.value_or("")] {
        Surroundings around;
        around.environment.image = image, around.environment.sky = sky;
        around.warnings = io::load_panorama(around.environment, {});
        return around;
    });
}

}  // namespace

Expected<io::Loaded> load(const SceneRequest& request, const io::ReadOptions& options) {
    io::ReadOptions reading = options;
    reading.texture_pattern = request.texture_pattern;
    std::future<Surroundings> surroundings = surroundings_of(request);
    auto loaded = io::read_scene(request.file, reading);
    std::optional<Surroundings> around;
    if (surroundings.valid()) around = surroundings.get();
    if (!loaded) {
        Problems& problems = loaded.error().problems;
        if (around && !around->warnings) problems.insert(problems.end(), around->warnings.error().problems.begin(), around->warnings.error().problems.end());
        return loaded;
    }
    scene::Scene& scene = loaded->scene;

    for (const auto& [field, value] : request.settings) field->set(scene.settings, value);
    if (around) {
        if (!around->warnings) return tl::unexpected<Error>(std::move(around->warnings.error()));
        loaded->warnings.insert(loaded->warnings.end(), around->warnings->begin(), around->warnings->end());
        if (!scene.environment) scene.environment.emplace();
        if (request.sky) scene.environment->rotation = 0, scene.environment->intensity = 1;
        scene.environment->image = std::move(around->environment.image);
        scene.environment->sky = std::move(around->environment.sky);
        scene.environment->panorama = std::move(around->environment.panorama);
    }
    const auto applied = apply_overrides(request.overrides, scene);
    if (!applied) return tl::unexpected<Error>(applied.error());
    loaded->warnings.insert(loaded->warnings.end(), applied->begin(), applied->end());

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
