#include "scene/camera_check.h"

#include <algorithm>
#include <cmath>

#include "scene/field_check.h"

namespace crescente::scene {
namespace {

using math::Vec3;

// Distance from zero, on the way.
double least(Vec3 from, Vec3 by) {
    const double squared = dot(by, by);
    return length(from + by * (squared > 0 ? std::clamp(-dot(from, by) / squared, 0.0, 1.0) : 0.0));
}

// On the whole way the view must have a direction, and the picture an upper side. A roll keeps the angle between up and the view.
void check_motion(const Camera& camera, std::vector<CameraProblem>& problems) {
    if (!is_finite(camera.travel) || !is_finite(camera.target_travel)) return;
    const Vec3 view = camera.target - camera.position, change = camera.target_travel - camera.travel, end = view + change;
    if (!std::isfinite(length(end))) {
        problems.push_back({"/travel", "leads too far away to compute with"});
        return;
    }
    constexpr double closest = 1e-9;
    const double longest = std::max(length(view), length(end)), up = length(camera.up);
    if (!(least(view, change) > closest * longest)) {
        problems.push_back({"/travel", "leads the camera to its target, or that to the camera: it looks nowhere then"});
    } else if (!(least(cross(view, camera.up), cross(change, camera.up)) > closest * longest * up)) {
        problems.push_back({"/travel", "makes the view parallel to up: nothing is up then"});
    }
}

}  // namespace

std::vector<CameraProblem> camera_problems(const Camera& camera) {
    std::vector<CameraProblem> problems;
    if (camera.projection == Projection::orthographic && camera.height == 0) problems.push_back({"/height", "is 0, must be more than 0"});
    if (camera.blades == 1 || camera.blades == 2) problems.push_back({"/blades", "is " + std::to_string(camera.blades) + ", must be 3 or more, or 0 for a round opening"});
    if (camera.shutter_close < camera.shutter_open) {
        problems.push_back({"/shutter_close", "is " + number_text(camera.shutter_close) + ", before it opens at " + number_text(camera.shutter_open)});
    }
    const Vec3 view = camera.target - camera.position;
    if (!is_finite(view) || !is_finite(camera.up)) return problems;
    const double distance = length(view), up = length(camera.up);
    if (distance == 0) problems.push_back({"/target", "is the camera's position: it looks nowhere"});
    if (up == 0) problems.push_back({"/up", "has no length, so nothing is up"});
    if (!std::isfinite(distance) || !std::isfinite(up)) {
        problems.push_back({"", "the camera's lengths are too large to compute with"});
    } else if (distance > 0 && up > 0) {
        constexpr double least_sine = 1e-9;
        if (!(length(cross(view / distance, camera.up / up)) > least_sine)) problems.push_back({"/up", "is parallel to the view, so nothing is up"});
        else check_motion(camera, problems);
    }
    return problems;
}

}  // namespace crescente::scene
