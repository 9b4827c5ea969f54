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

    // The lens and the shutter, which levels that sample look through; the others see the picture of a pinhole when the shutter opens.
    double aperture = 0;        // diameter of the lens's opening, metres; 0: a pinhole, all is sharp
    double focus_distance = 0;  // of the plane that is sharp, metres along the view direction; 0: the target's
    int blades = 0;             // corners of the opening; 0: it is round
    double blade_rotation = 0;  // radians, counter-clockwise as the viewer sees it
    double shutter_open = 0, shutter_close = 1;  // within the motion's interval, of which 0 is the beginning and 1 the end
    math::Vec3 travel, target_travel;            // of position and target from the beginning of the motion to its end, metres
    double roll = 0;                             // turn of the camera about its view meanwhile, radians, counter-clockwise as the viewer sees it

    bool moves() const { return travel != math::Vec3{} || target_travel != math::Vec3{} || roll != 0; }
    static const FieldTable<Camera>& fields();
    bool operator==(const Camera&) const = default;
};

}  // namespace crescente::scene
