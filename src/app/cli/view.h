// The camera as the command line asks for it.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "base/error.h"
#include "scene/scene.h"

namespace crescente::app {

// Where `--camera` wants the viewer.
struct NamedView {
    math::Vec3 from;  // the side from which the scene is seen, any length but zero; the scene is framed from there
    math::Vec3 up;
};
struct ExplicitView {
    math::Vec3 position, target;  // in the scene's axes, in the unit of the file
};

struct StudioView {};  // as if the file had no camera: the studio frames the scene

struct View {
    std::optional<std::variant<NamedView, StudioView, ExplicitView>> place;
    std::optional<double> field_of_view;  // radians
    bool orthographic = false;
};

// The views that `--camera` knows by name: "front, back, ..., studio".
std::string view_names();

// "front" or "px,py,pz,tx,ty,tz" (with an optional seventh number, the field of view in degrees). Errors: usage.
Expected<View> parse_view(const std::optional<std::string>& camera, const std::optional<std::string>& field_of_view, bool orthographic);

// Puts the camera of the scene where the view wants it, or takes it away for the studio. Errors (usage): a named view of a scene without bounds.
Expected<void> place_camera(const View& view, scene::Scene& scene);

// Field of view and projection; the scene must have a camera. An orthographic camera shows what the perspective one shows at its target.
void set_projection(const View& view, scene::Camera& camera);

}  // namespace crescente::app
