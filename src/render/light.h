// Lights compiled for shading.
#pragma once

#include "math/color.h"
#include "math/vec.h"
#include "scene/light.h"

namespace crescente::render {

using namespace math;

// What a light sends to a point, before anything stands in its way.
struct Incident {
    Vec3 to_light;        // unit
    double distance = 0;  // infinite for directional lights
    Rgb strength;         // irradiance on a surface that faces the light; black: the point is outside its cone or range
};

class Light {
public:
    explicit Light(const scene::Light& light);

    Incident at(Vec3 point) const;
    bool casts_shadows() const { return light_.shadows; }
    bool makes_highlights() const { return light_.highlights; }

private:
    double cone(double cosine) const;
    double falloff(double distance) const;

    scene::Light light_;
    Vec3 axis_;
    Rgb color_;
    bool oriented_;
    double cos_outer_, cos_scale_;
};

}  // namespace crescente::render
