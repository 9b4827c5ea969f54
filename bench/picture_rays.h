// The rays of a picture that has yet to be lit: from the camera, and from what these hit.
#pragma once

#include <vector>

#include "accel/accelerator.h"
#include "render/world.h"

namespace crescente::bench {

struct Rays {
    std::vector<accel::Ray> rays;
    accel::Coherence coherence;
};

struct PictureRays {
    static constexpr std::size_t batch = 4096;  // handed over at once: a tile of 64 x 64 pixels

    // One ray a pixel, pixel after pixel in blocks of 4 x 4. Where the camera ray hits: its mirror image, a ray scattered with the cosine to the normal
    // (from fixed random numbers), and, given a light, the way to it.
    PictureRays(const render::World& world, int width, int height, const math::Vec3* light);

    Rays camera{{}, accel::Coherence::coherent}, reflected{{}, accel::Coherence::incoherent}, bounce{{}, accel::Coherence::incoherent},
        shadow{{}, accel::Coherence::coherent};
};

// How many of the rays hit something.
std::size_t trace(const accel::Accelerator& accelerator, const Rays& rays, bool shadows);

}  // namespace crescente::bench
