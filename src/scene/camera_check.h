// What is wrong with a camera as a whole.
#pragma once

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

}  // namespace crescente::scene
