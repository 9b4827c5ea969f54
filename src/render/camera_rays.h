// Rays from the viewer through points of the picture.
#pragma once

#include <optional>

#include "geometry/ray.h"
#include "math/vec_lanes.h"
#include "scene/camera.h"

namespace crescente::render {

using namespace math;

class CameraRays {
public:
    CameraRays(const scene::Camera& camera, int width, int height);

    // Through the point (x, y), in pixels from the top left corner; the direction has unit length, t_min is the near plane.
    geometry::Ray through(double x, double y) const;

    // Eight of them at once, the same to the bit.
    void through(const Lanes& x, const Lanes& y, geometry::Ray* rays) const;

    // The same from a point of a lens around it, so many metres to the right and up, which is focused at a distance along the view direction. What is there is where
    // the pinhole sees it.
    geometry::Ray through_lens(double x, double y, double right, double up, double focus) const;

    // Where a point, or a direction, is in the picture, in pixels from the top left corner, and how far along the view direction; nothing if it is not in front
    // of the viewer's near plane. Seen in parallel, no direction has a place.
    struct Projected {
        double x, y, depth;
    };
    std::optional<Projected> project(Vec3 point) const;
    std::optional<Projected> project_direction(Vec3 direction) const;

    // A place of the viewer from which a camera ray comes to the point.
    Vec3 viewer_of(Vec3 point) const { return orthographic_ ? point - forward_ : position_; }

    // Where the camera ray to the point starts.
    Vec3 origin_towards(Vec3 point) const { return orthographic_ ? point - forward_ * dot(point - position_, forward_) : position_; }

    // Height of a pixel at this distance, m; seen in parallel, at every distance.
    double pixel_width(double distance) const { return 2 * length(up_) / height_ * (orthographic_ ? 1.0 : distance); }

    bool operator==(const CameraRays&) const = default;
    Vec3 position() const { return position_; }
    Vec3 forward() const { return forward_; }
    int height() const { return height_; }

private:
    template <class T>
    struct Line {
        VecOf<T> origin, direction;
        T t_min;
    };
    template <class T>
    Line<T> line_through(const T& x, const T& y) const;
    Projected at(Vec3 across, double depth) const;

    Vec3 position_, forward_, right_, up_;  // right and up span the half picture at distance 1 (or at the plane, orthographic)
    bool orthographic_;
    double near_;
    int width_, height_;
};

}  // namespace crescente::render
