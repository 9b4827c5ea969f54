// Whether and how a picture is taken through a lens and a shutter: what its rays depend on besides what a pinhole sees when the shutter opens.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "scene/camera.h"

namespace crescente::render {

struct World;

struct Lens {
    scene::Camera camera;
    std::uint64_t objects = 0;  // hash of how those move that do while the shutter is open; 0: none
    bool catches = false;       // some material catches shadows
    bool apart = false;         // what is behind the scene is kept apart: the picture has an alpha channel

    bool operator==(const Lens&) const = default;
    double time(double share) const { return camera.shutter_open + (camera.shutter_close - camera.shutter_open) * share; }
};

// Nothing: the level does not sample, or the lens is a pinhole and nothing moves while the shutter is open. motion: hash of how the world's objects move, 0: not.
std::optional<Lens> lens_of(const World& world, std::uint64_t motion);

// A point of the opening, to the right and up from its middle, metres: evenly over its area, from two numbers in [0, 1).
std::array<double, 2> point_of_opening(const scene::Camera& camera, double u, double v);

}  // namespace crescente::render
