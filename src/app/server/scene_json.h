// A scene without its geometry, as the page shows it.
#pragma once

#include <span>

#include "app/server/replies.h"
#include "app/server/told_objects.h"
#include "scene/edit.h"
#include "scene/scene.h"

namespace crescente::app {

// Parts of the message `scene`.
struct SceneParts {
    bool objects = false, materials = false, lights = false, camera = false, environment = false, settings = false;

    static SceneParts all() { return {true, true, true, true, true, true}; }
    bool any() const { return objects || materials || lights || camera || environment || settings; }
    SceneParts& operator|=(const SceneParts& other);
};

// What the edits may change.
SceneParts parts_of(std::span<const scene::Edit> edits);

// The members of the parts, and those that every such message has. Lengths in the scene's unit, values as in scene files, without those at their defaults. Of objects only what is not
// told yet.
ReplyJson scene_json(const scene::Scene& scene, const SceneParts& parts, ToldObjects& told);

}  // namespace crescente::app
