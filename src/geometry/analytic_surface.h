// The analytic surfaces of faces: plane, cylinder, cone, sphere and torus, in any position, with the parametrisations of geometry/face.h.
#pragma once

#include "geometry/ray_view.h"
#include "geometry/shape.h"
#include "geometry/trimming.h"
#include "math/arctangent.h"
#include "math/bounds.h"
#include "math/lanes.h"

namespace crescente::geometry {

// Where a ray meets a surface: its parameter, and the point in the surface's own frame (along its axes, from its origin), which is
// more exact than ray.at(t) for a ray from far away.
struct Meeting {
    double t = 0;
    Vec3 local;
};

// One line, or eight, along the axes of a surface's frame, moved near to the surface: its points are origin + s direction at t = shift + s.
template <class T>
struct LocalLine {
    Point3<T> origin, direction;
    T shift;
};

template <class T>
struct TwoRoots {
    T first, second;
};

template <class T>
struct PlaneCoordinates {
    T u, v;
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
    // The line of rays in the surface's frame; what meet() finds on planes, cylinders and cones are meet_plane's and cone_roots' s, to the bit.
    template <class T>
    LocalLine<T> into_frame(const Point3<T>& origin, const Point3<T>& direction) const;
    double radius() const { return radius_; }
    double slope() const { return sine_ / cosine_; }  // of a cone: how fast it widens along z

    Vec3 to_local(Vec3 position) const {
        const Vec3 p = position - frame_.origin;
        return {dot(p, frame_.x), dot(p, frame_.y), dot(p, frame_.z)};
    }
    // parameters() of points on a plane, cylinder or cone.
    template <class T>
    PlaneCoordinates<T> unrolled(const Point3<T>& local) const;
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

template <class T>
LocalLine<T> AnalyticSurface::into_frame(const Point3<T>& o, const Point3<T>& d) const {
    LocalLine<T> line;
    line.shift = ((center_.x - o.x) * d.x + (center_.y - o.y) * d.y + (center_.z - o.z) * d.z) / (d.x * d.x + d.y * d.y + d.z * d.z);
    const T x = fused_multiply_add(d.x, line.shift, o.x) - frame_.origin.x, y = fused_multiply_add(d.y, line.shift, o.y) - frame_.origin.y;
    const T z = fused_multiply_add(d.z, line.shift, o.z) - frame_.origin.z;
    const auto along = [](const T& a, const T& b, const T& c, Vec3 axis) { return a * axis.x + b * axis.y + c * axis.z; };
    line.origin = {along(x, y, z, frame_.x), along(x, y, z, frame_.y), along(x, y, z, frame_.z)};
    line.direction = {along(d.x, d.y, d.z, frame_.x), along(d.x, d.y, d.z, frame_.y), along(d.x, d.y, d.z, frame_.z)};
    return line;
}

template <class T>
PlaneCoordinates<T> AnalyticSurface::unrolled(const Point3<T>& p) const {
    if (kind_ == Kind::plane) return {p.x, p.y};
    if (kind_ == Kind::cylinder) return {arctangent2(p.y, p.x), p.z};
    const auto beyond = radius_ * cosine_ + sine_ * p.z < 0.0;  // the apex: on the negative nappe
    const T rho = square_root(p.x * p.x + p.y * p.y);
    return {arctangent2<T>(beyond ? -p.y : p.y, beyond ? -p.x : p.x), p.z * cosine_ + ((beyond ? -rho : rho) - radius_) * sine_};
}

// Where a line meets the plane z = 0; not finite if it does not.
template <class T>
T meet_plane(const LocalLine<T>& line) {
    return -line.origin.z / line.direction.z;
}

// The roots of where the line meets x^2 + y^2 = (radius + slope z)^2, ascending: as inside_cone (geometry/revolved.cpp), for both nappes and about z.
// No root is a NaN.
template <class T>
TwoRoots<T> cone_roots(const LocalLine<T>& line, double radius, double slope) {
    const auto size = [](const T& x) { return x < 0.0 ? -x : x; };
    const auto product_difference = [](const T& a, const T& b, const T& c, const T& d) {  // Kahan's, as math/exact.h
        const T cd = c * d;
        return fused_multiply_add(a, b, -cd) + fused_multiply_add(-c, d, cd);
    };
    const auto &o = line.origin, &d = line.direction;
    const T r = radius + slope * o.z, dr = slope * d.z;
    const T across = square_root(d.x * d.x + d.y * d.y), distance = square_root(o.x * o.x + o.y * o.y);
    const T a = (across - size(dr)) * (across + size(dr));
    const T b = o.x * d.x + o.y * d.y - r * dr;
    const T c = (distance - size(r)) * (distance + size(r));
    const T px = product_difference(d.x, r, o.x, dr), py = product_difference(d.y, r, o.y, dr);
    const T p = square_root(px * px + py * py), q = size(product_difference(o.x, d.y, o.y, d.x));
    const T discriminant = (p - q) * (p + q), none = T{} + std::numeric_limits<double>::quiet_NaN();
    const T root = square_root(discriminant > 0.0 ? discriminant : T{});
    const T sum = b < 0.0 ? root - b : -(b + root);
    const T one = sum == 0.0 ? T{} : c / sum, other = sum / a;
    const T low = one < other ? one : other, high = one < other ? other : one;
    // Along the wall: one root. Past a convex wall: none.
    const T single = -c / (2.0 * b);
    const auto flat = a == 0.0;
    const auto missed = (a > 0.0) & !(discriminant > 0.0);
    return {flat ? (b == 0.0 ? none : single) : missed ? none : low, (flat | missed) ? none : high};
}

}  // namespace crescente::geometry
