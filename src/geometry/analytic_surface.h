// The analytic surfaces of faces: plane, cylinder, cone, sphere and torus, in any position, with the parametrisations of geometry/face.h.
#pragma once

#include "geometry/shape.h"
#include "geometry/trimming.h"
#include "math/bounds.h"

namespace crescente::geometry {

// Where a ray meets a surface: its parameter, and the point in the surface's own frame (along its axes, from its origin), which is
// more exact than ray.at(t) for a ray from far away.
struct Meeting {
    double t = 0;
    Vec3 local;
};

class AnalyticSurface {
public:
    enum class Kind : std::uint8_t { plane, cylinder, cone, sphere, torus };
    static constexpr int most_meetings = 8;  // spindle tori: four with each sheet

    AnalyticSurface() = default;

    // Not of a PatchSurface. Errors (input): numbers that are not finite, a frame that is not orthonormal, radii that are not positive (a cone's may be 0), a
    // cone's half angle beyond a right one.
    static Expected<AnalyticSurface> make(const FaceSurface& surface);
    FaceSurface plain() const;

    Kind kind() const { return kind_; }
    Point2 period() const;
    // The point that rays are moved near to before products are formed: near the part of the surface that matters.
    void set_center(Vec3 center) { center_ = center; }

    // All meetings with t_min < t <= t_max, ascending in t. Both nappes of a cone, both sheets of a spindle torus. A ray within the surface does not meet it.
    int meet(const Ray& ray, Meeting* found) const;

    Vec3 to_local(Vec3 position) const {
        const Vec3 p = position - frame_.origin;
        return {dot(p, frame_.x), dot(p, frame_.y), dot(p, frame_.z)};
    }
    // The parameters of a point on the surface: angles from -pi to pi.
    Point2 parameters(Vec3 local) const;
    Metric metric(Point2 p) const;
    Vec3 position(Point2 p) const;
    // S_u and S_v, and their cross product's direction: its limit at poles and apices.
    Vec3 along_u(Point2 p) const;
    Vec3 along_v(Point2 p) const;
    Vec3 normal(Point2 p) const;
    // The point of the surface next to a point near it, with its normal, parameters (angles from -pi to pi) and error.
    SurfacePoint nearest(Vec3 position) const;
    // How far a point lies off the surface, on the side of the normal.
    double side(Vec3 position) const;

    Point2 least_steps(const ParameterBox& box) const;
    // Of the part of the surface over a box of parameters. For planes: of the rectangle.
    Bounds bounds(const ParameterBox& box) const;
    // Bound on the rounding of positions on the part of the surface within the bounds.
    double error(const Bounds& box) const;

private:
    Vec3 to_world(Vec3 local) const { return frame_.origin + frame_.x * local.x + frame_.y * local.y + frame_.z * local.z; }
    Vec3 radial(double u) const { return {std::cos(u), std::sin(u), 0}; }

    Frame frame_;
    Vec3 center_;
    double radius_ = 0;  // of a torus: major
    double minor_ = 0;
    double half_angle_ = 0, sine_ = 0, cosine_ = 1;  // of a cone; a cylinder is one without
    Kind kind_ = Kind::plane;
    double hand_ = 1;  // -1: the frame is left-handed
};

}  // namespace crescente::geometry
