// The studio of a bare model: camera, lights, ground and backdrop fitted to its size (docs/studio.md).
#pragma once

#include <string_view>

#include "scene/scene.h"

namespace crescente::scene {

// Whether camera, lights and ground can be fitted to a scene of these bounds: there is something, and squares of its lengths are numbers.
bool can_be_framed(const math::Bounds& everything);

// How a model is lit: by lights with extent, which levels that sample none see as points.
enum class Studio { standard, softbox, three_point, overhead, tent, turntable };
inline constexpr std::string_view studio_names[] = {"default", "softbox", "three-point", "overhead", "tent", "turntable"};

// What a model stands on.
enum class Ground {
    studio,   // a wide grey disk
    catcher,  // the same, of which only shadows and reflections are seen
    none,
};

// The box of everything visible and bounded but the ground that add_ground() put there.
math::Bounds bounds_without_ground(const Scene& scene);

// Whether the object is such a ground.
bool is_studio_ground(const Node& node);

// The studio whose lights a scene has, by their names; the ground that it stands on.
std::optional<Studio> studio_of(const Scene& scene);
Ground ground_of(const Scene& scene);

// Where a model is and how large: what a studio is fitted to.
struct Placement {
    explicit Placement(const Scene& scene);

    math::Bounds box;     // of what is visible and bounded, but a studio's ground
    math::Vec3 center;
    double radius;        // half the diagonal of the box, metres
    double azimuth = 0;   // of the camera, degrees; 0 where there is none
};

// Whether the scene brings light of its own.
bool shines(const Scene& scene);

// The following take a valid scene of whose bounds can_be_framed() is true.

// Frames what is visible.
void add_camera(Scene& scene);

// Lights, and an environment if the scene has none.
void add_studio_lights(Scene& scene, const Placement& at, Studio studio);

// A hair below the model; nothing if the camera would not see its upper side. There must be a camera.
void add_ground(Scene& scene, const Placement& at, Ground ground);

// All that is missing: a camera when the scene has none; lights, ground and environment when it has no light of its own.
void add_studio(Scene& scene);

}  // namespace crescente::scene
