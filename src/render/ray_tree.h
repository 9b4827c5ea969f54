// The ray trees of a pixel as plain values, for whoever asks why it looks as it does.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "math/color.h"
#include "math/vec.h"

namespace crescente::render {

// How a light reaches a hit.
struct SeenLight {
    std::uint32_t light = 0;  // of the world: those of the scene come first
    std::string name;
    std::string share;        // "clear", "in shadow", "filtered", "not tried", "behind the surface or out of reach"
    math::Rgb through{1, 1, 1};  // where it is filtered: what gets through
    math::Rgb strength;
};

// A ray, what it met, and what it spawned.
struct RayTree {
    static constexpr std::uint32_t none = 0xffffffff;

    std::string kind;              // "camera", "reflected", "refracted", "straight"
    std::optional<math::Vec3> from;  // of camera rays that met something
    math::Rgb influence, radiance;
    bool left_scene = false;
    math::Vec3 position, normal;   // of the hit, in the world; position is the direction where the ray left the scene
    bool inside = false;           // it met the surface from inside
    std::uint32_t object = none;   // index of the scene's node
    std::string object_name, shape;
    std::uint32_t face = 0;        // of the shape
    std::uint32_t material = none; // none: the default one
    std::string material_name;
    math::Rgb local;               // light that the hit sends back by itself
    std::vector<SeenLight> lights;
    std::vector<RayTree> children;
    struct Ungrown {
        std::string kind;
        double influence = 0;
    };
    std::vector<Ungrown> ungrown;  // rays that would be spawned, but have too little influence so far
};

// The trees of a pixel's corners, and of those that split it.
struct PixelTrees {
    struct Corner {
        double x = 0, y = 0;  // pixels of the picture
        std::optional<RayTree> tree;  // none: not traced yet
    };
    int x = 0, y = 0;
    std::vector<Corner> corners;  // the first four are the pixel's own, row by row; none: the pixel is outside of the picture
    std::optional<std::size_t> splits;  // how often it was split
};

// For people.
std::string text_of(const PixelTrees& trees);

}  // namespace crescente::render
