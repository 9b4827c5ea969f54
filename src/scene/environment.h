// What is seen and shines where a ray leaves the scene.
#pragma once

#include <memory>
#include <string>

#include "base/fields.h"
#include "math/color.h"
#include "scene/panorama.h"

namespace crescente::scene {

// What surrounds the scene: a picture, or a vertical gradient of radiance by the direction's height: nadir (-y), horizon, zenith (+y), one
// colour when the three are equal.
struct Environment {
    math::Rgb zenith{0, 0, 0};
    math::Rgb horizon{0, 0, 0};
    math::Rgb nadir{0, 0, 0};
    // What the camera sees behind the scene instead, from the bottom to the top of the picture, when backdrop is true; reflections
    // and refractions still see what surrounds the scene.
    bool backdrop = false;
    math::Rgb backdrop_bottom{0, 0, 0};
    math::Rgb backdrop_top{0, 0, 0};
    bool transparent = false;  // the camera sees nothing behind the scene: the picture keeps an alpha channel
    double strength = 0;  // how much the gradient lights surfaces, 1: as radiometry says
    int directions = 0;   // levels that do not sample take most of its light from so many directions of the upper half, with shadows; 0: none, all evenly
    // In place of the gradient: a clear sky with its sun (scene/sky.h, daylight_of), or a picture. The picture is read with the scene and shared by its copies: values of an environment are many, its picture is large.
    std::string sky;                            // where the sun stands; empty: none
    std::string image;                          // path; empty: none
    std::shared_ptr<const Panorama> panorama;   // what was read from there, or made of the sky
    double rotation = 0;                        // about +y, radians; counter-clockwise seen from above
    double intensity = 1;                       // factor of the picture's radiance, seen and as light

    // Whether something of it lights surfaces.
    bool lights() const { return panorama ? intensity > 0 && panorama->shines() : strength > 0; }
    static const FieldTable<Environment>& fields();
    bool operator==(const Environment& other) const;  // pictures by what they show
};

}  // namespace crescente::scene
