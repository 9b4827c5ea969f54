// Lights: points that may be oriented, directions, and lights with extent: rectangles, disks and spheres.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "base/fields.h"
#include "math/color.h"
#include "math/vec.h"
#include "scene/light_profile.h"

namespace crescente::scene {

enum class LightKind { point, directional, rectangle, disk, sphere };

// How a point light's influence falls with distance d (metres).
enum class Falloff {
    none,            // as in NFF: the same at every distance
    inverse_square,  // physical: 1/d^2
    classic,         // 1 / (constant + linear d + quadratic d^2), at most 1
};

// How an oriented light goes from full (inside the inner cone) to nothing (outside the outer cone).
enum class Gradient {
    smooth,  // KHR_lights_punctual: square of the linear ramp in the cosine of the angle
    linear,  // linear in the angle
    power,   // cosine of the angle to the axis, raised to `exponent`, cut at the outer cone (the 1989 system, after Warn 1983)
};

struct Light {
    std::string name;
    LightKind kind = LightKind::point;
    math::Vec3 position{0, 0, 0};
    math::Vec3 direction{0, -1, 0};  // where an oriented, flat or directional light shines; any length but zero
    math::Rgb color{1, 1, 1};
    // Candela for points, lux for directions, as in KHR_lights_punctual. Candela also for lights with extent, of one side along the axis: a light that
    // grows keeps its strength, and from afar is a point light. Its radiance is even, and is the intensity over the area that the axis sees.
    double intensity = 1;
    double inner_angle = 0;          // half angles of the cone, radians
    double outer_angle = math::pi;   // pi: shines everywhere
    Gradient gradient = Gradient::smooth;
    double exponent = 1;
    Falloff falloff = Falloff::inverse_square;
    double constant = 1, linear = 0, quadratic = 0;
    double range = 0;                // metres, 0: unlimited; fades as in KHR_lights_punctual
    bool shadows = true;
    bool highlights = true;          // false: lights diffusely only (fill lights)
    // Of a point light: measured intensities in place of an even one, about the direction, from where the height of a rectangle would run; `intensity` is then a factor.
    std::string profile{};                            // path of an IES file; empty: none
    std::shared_ptr<const LightProfile> measured{};   // what was read from there
    // Of lights with extent, whose position is their centre. They have no cone, and fall off as physics says.
    math::Vec3 up{0, 1, 0};          // which way the height of a rectangle runs; any length but zero (upward_of)
    double width = 1, height = 1;    // of a rectangle, metres
    double radius = 0.5;             // of a disk or sphere, metres
    bool two_sided = false;          // flat lights shine to both sides
    bool visible = true;             // the camera sees the light itself
    int points = 1;                  // levels that do not sample see so many points of it
    std::string group;               // lights of one name are sampled together; empty: by itself
    // Light linking: names of objects, each with all below it. What is not lit does not mirror the light either; it still throws its shadow.
    std::vector<std::string> only{};    // lights these alone; empty: everything
    std::vector<std::string> except{};  // but not these
    static const FieldTable<Light>& fields();
    bool operator==(const Light&) const = default;
};

inline bool has_extent(const Light& light) {
    return light.kind == LightKind::rectangle || light.kind == LightKind::disk || light.kind == LightKind::sphere;
}
inline bool is_flat(const Light& light) { return light.kind == LightKind::rectangle || light.kind == LightKind::disk; }

// The area that is seen along the axis of a light with extent, in square metres.
double visible_area(const Light& light);

// Unit, perpendicular to the direction: where the height of a rectangle runs. `up` without its share along the direction; where nothing is left, -z or
// +y takes its place.
math::Vec3 upward_of(const Light& light);

}  // namespace crescente::scene
