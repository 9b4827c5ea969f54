// The viewer.
#pragma once

#include "base/fields.h"
#include "math/vec.h"

namespace crescente::scene {

enum class Projection { perspective, orthographic };

struct Camera {
    Projection projection = Projection::perspective;
    math::Vec3 position{0, 0, 5};
    math::Vec3 target{0, 0, 0};
    math::Vec3 up{0, 1, 0};
    double field_of_view = 40.0 * math::pi / 180.0;  // perspective: vertical angle, radians
    double height = 2;                                // orthographic: vertical extent, metres
    double pixel_aspect = 1;                          // width of a pixel over its height
    double near = 0;                                  // nothing nearer is seen, metres along the view direction
    static const FieldTable<Camera>& fields();
    bool operator==(const Camera&) const = default;
};

}  // namespace crescente::scene
