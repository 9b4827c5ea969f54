// Lights without extent: points that may be oriented, and directions.
#pragma once

#include <string>

#include "base/fields.h"
#include "math/color.h"
#include "math/vec.h"

namespace crescente::scene {

enum class LightKind { point, directional };

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
    math::Vec3 direction{0, -1, 0};  // where an oriented or directional light shines; any length but zero
    math::Rgb color{1, 1, 1};
    double intensity = 1;            // candela for points, lux for directions, as in KHR_lights_punctual
    double inner_angle = 0;          // half angles of the cone, radians
    double outer_angle = math::pi;   // pi: shines everywhere
    Gradient gradient = Gradient::smooth;
    double exponent = 1;
    Falloff falloff = Falloff::inverse_square;
    double constant = 1, linear = 0, quadratic = 0;
    double range = 0;                // metres, 0: unlimited; fades as in KHR_lights_punctual
    bool shadows = true;
    bool highlights = true;          // false: lights diffusely only (fill lights)
    static const FieldTable<Light>& fields();
    bool operator==(const Light&) const = default;
};

}  // namespace crescente::scene
