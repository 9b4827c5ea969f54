// From a place on a surface to where a texture is looked up, and over which footprint.
//
// The footprint is that of a cone about the ray, as wide as a pixel at the camera and growing with the length of the whole path (ray cones: Akenine-Möller et
// al. 2021, "Improved Shader and Texture Level of Detail Using Ray Cones"), whose spread surfaces on the way do not change. It is an ellipse on the surface's
// plane, of which the axes are carried to the texture.
#pragma once

#include <array>
#include <cstdint>

#include "accel/narrow_phase.h"
#include "scene/texture.h"

namespace crescente::render {

using namespace math;

// A place on a surface as a ray sees it, in world space.
struct TexturePoint {
    const accel::Instance* instance = nullptr;
    const Bounds* box = nullptr;  // of its shape, in the shape's space
    std::uint32_t primitive = 0;
    Vec3 position;
    Vec3 geometric;    // normal on the viewer's side, unit length
    Vec3 to_viewer;    // unit length
    double width = 0;  // of the ray's cone, m
    bool inside = false;  // seen from the inner side
    bool blurred = false;  // seen by light that was scattered on its way: one texel of the footprint's size is enough
};

// The ellipse that the cone covers on the surface: its axes, at right angles, each the whole width long.
struct Footprint {
    Vec3 major, minor;
};
Footprint footprint(const TexturePoint& point);

// Where a texture is looked up.
struct TexturePlace {
    Vec3 at;          // u, v and 0.5; in a block the place in multiples of the texture's size
    Vec3 axes[2];     // what the footprint's axes come to
    double weight = 1;
    Vec3 right, up;   // on the surface, in world space, unit length: where u grows, and where v falls most; zero where there are no such directions
};

struct TexturePlaces {
    int count = 1;
    std::array<TexturePlace, 3> place;  // several where sides of a box go over into each other; weights of sum 1
};

TexturePlaces places_of(const scene::Texture& texture, const TexturePoint& point);

// The normal for light where nothing bends it, of unit length, on the viewer's side and such that he can see it.
Vec3 shading_normal(const TexturePoint& point);

// Whether both are looked up in the same places of every surface.
bool same_places(const scene::Texture& a, const scene::Texture& b);

}  // namespace crescente::render
