// Light linking: which instances a light acts on.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "scene/scene.h"

namespace crescente::render {

// Whether a light acts on each instance; null: on all.
using Receivers = std::shared_ptr<const std::vector<std::uint8_t>>;

// In place of an instance: the camera, which lights show themselves to whatever they are linked to.
inline constexpr std::uint32_t no_instance = std::numeric_limits<std::uint32_t>::max();

inline bool acts_on(const Receivers& receivers, std::uint32_t instance) { return !receivers || instance == no_instance || (*receivers)[instance] != 0; }

// By the order of scene::walk_appearances. Lights that act on the same share what is found.
std::vector<Receivers> receivers_of_lights(const scene::Scene& scene);

// Whether two lists say the same.
inline bool same_receivers(const Receivers& a, const Receivers& b) { return a == b || (a && b && *a == *b); }

}  // namespace crescente::render
