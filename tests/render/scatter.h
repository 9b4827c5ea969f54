// One direction of a material's scattering at a time.
#pragma once

#include "render/scattering.h"

namespace crescente::render {

// with_delta: the density is that of drawing with smooth lobes as well.
inline Scattered scatter(const Lobes& lobes, const Facing& facing, Vec3 to_viewer, Vec3 to_light, bool with_delta = false) {
    return Scattering(lobes, facing, to_viewer, with_delta ? SmoothAs::rays : SmoothAs::nothing).toward(to_light);
}

inline std::optional<ScatterSample> sample_scatter(const Lobes& lobes, const Facing& facing, Vec3 to_viewer, std::array<double, 3> u, bool with_delta) {
    return Scattering(lobes, facing, to_viewer, with_delta ? SmoothAs::rays : SmoothAs::nothing).sample(u);
}

}  // namespace crescente::render
