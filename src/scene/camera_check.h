// What is wrong with a camera as a whole.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.h"

namespace crescente::scene {

struct CameraProblem {
    std::string place;  // "/up"; empty: the camera
    std::string reason;
};

// Beyond the ranges of its fields: what makes it look nowhere, at any time of its motion, or contradicts itself. What is not finite is left to the ranges.
std::vector<CameraProblem> camera_problems(const Camera& camera);

// What the scene's lens or shutter cannot show: catchers and a background that is kept apart, which a pinhole at one moment shows.
std::optional<CameraProblem> lens_problem(const Scene& scene);

}  // namespace crescente::scene
