// What is seen and shines where a ray leaves the scene.
#pragma once

#include "base/fields.h"
#include "math/color.h"

namespace crescente::scene {

// A vertical gradient for what surrounds the scene: radiance by the direction's height: nadir (-y), horizon, zenith (+y). One
// colour when the three are equal.
struct Environment {
    math::Rgb zenith{0, 0, 0};
    math::Rgb horizon{0, 0, 0};
    math::Rgb nadir{0, 0, 0};
    // What the camera sees behind the scene instead, from the bottom to the top of the picture, when backdrop is true; reflections
    // and refractions still see the gradient above.
    bool backdrop = false;
    math::Rgb backdrop_bottom{0, 0, 0};
    math::Rgb backdrop_top{0, 0, 0};
    double strength = 0;  // how much the gradient lights surfaces (ambient light without shadows), 1: as radiometry says
    static const FieldTable<Environment>& fields();
    bool operator==(const Environment&) const = default;
};

}  // namespace crescente::scene
