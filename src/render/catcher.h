// Surfaces that only catch: where the camera sees a material with `catcher`, it sees what is behind the scene through it, darker by the share of light that other objects keep from the surface,
// and the objects that the surface mirrors are added. To everything else the surface is what its material says.
//
// The share is by luminance, of the irradiance by all lights and the surroundings with shadows over that without; at level indirect light from other surfaces makes shadows brighter.
// Through a lens it is that of all the catchers that are seen in a pixel (render/lens_sampler.h).
#pragma once

#include "render/growth.h"

namespace crescente::render {

// Whether the camera sees the node's surface, maybe straight through others, as a catcher.
bool catches(const World& world, const Tile& tile, std::uint32_t node);

// Light of one kind or more at a catcher, as luminance of irradiance.
struct CaughtLight {
    float open = 0;  // with what is in its way
    float all = 0;   // without
    // Share of what is behind that is seen; all of it where there is no light to be kept off.
    float clear() const { return all > 0 ? std::min(1.0f, open / all) : 1.0f; }
};

// Of the surroundings, evenly and without shadows, as levels that do not sample count them.
CaughtLight caught_evenly(const World& world, Vec3 normal);

// Of lights without extent, as far as their ways are known.
CaughtLight caught_by_lamps(const World& world, const Tile& tile, std::uint32_t node);

// What samples told of it. Their estimates keep, of the diffuse part, the light with shadows as green and that without as blue.
CaughtLight caught_by_samples(const World& world, const Tile& tile, std::uint32_t node);
inline Rgb as_caught(float open, float all) { return {0, open, all}; }

// Of objects that the surface mirrors: radiance of the samples' glossy part.
Rgb mirrored_by_samples(const World& world, const Tile& tile, std::uint32_t node);

// Behind the scene, on the camera's ray to a point; black where the picture keeps it apart.
Rgb seen_behind(const World& world, Vec3 point);

}  // namespace crescente::render
