// What moves while the shutter is open: where nodes and the camera are at a time of their motion, from 0 (as the scene says) to 1.
#pragma once

#include <cstdint>

#include "math/transform.h"
#include "scene/camera.h"

namespace crescente::scene {

struct Node;

// From the node's space to its parent's.
math::Affine place_at(const Node& node, double time);

// Hash of how a node, and what is below it, moves; `above`: that of its parent, 0 if that stands still. Never 0.
std::uint64_t motion_below(std::uint64_t above, const Node& node);

// The same camera where it is at that time, standing still. Its distance of focus is that of its first place's target, if it names none.
Camera camera_at(const Camera& camera, double time);

// Distance of what is sharp, metres along the view direction.
double focus_of(const Camera& camera);

}  // namespace crescente::scene
