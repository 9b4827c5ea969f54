// Rays from the viewer through points of the picture.
#pragma once

#include "geometry/ray.h"
#include "scene/camera.h"

namespace crescente::render {

using namespace math;

class CameraRays {
public:
    CameraRays(const scene::Camera& camera, int width, int height);

    // Through the point (x, y), in pixels from the top left corner; the direction has unit length, t_min is the near plane.
    geometry::Ray through(double x, double y) const;

    // A place of the viewer from which a camera ray comes to the point.
    Vec3 viewer_of(Vec3 point) const { return orthographic_ ? point - forward_ : position_; }

    bool operator==(const CameraRays&) const = default;
    Vec3 position() const { return position_; }
    Vec3 forward() const { return forward_; }
    int height() const { return height_; }

private:
    Vec3 position_, forward_, right_, up_;  // right and up span the half picture at distance 1 (or at the plane, orthographic)
    bool orthographic_;
    double near_;
    int width_, height_;
};

}  // namespace crescente::render
