#include "render/camera_rays.h"

#include <limits>

#include "render/ray_lanes.h"

namespace crescente::render {

CameraRays::CameraRays(const scene::Camera& camera, int width, int height)
    : position_(camera.position),
      forward_(normalize(camera.target - camera.position)),
      orthographic_(camera.projection == scene::Projection::orthographic),
      near_(camera.near),
      width_(width),
      height_(height) {
    const double half = orthographic_ ? camera.height / 2 : std::tan(camera.field_of_view / 2);
    right_ = normalize(cross(forward_, camera.up));
    up_ = cross(right_, forward_) * half;
    right_ *= half * width * camera.pixel_aspect / height;
}

template <class T>
CameraRays::Line<T> CameraRays::line_through(const T& x, const T& y) const {
    const T sx = 2.0 * x / double(width_) - 1.0, sy = 1.0 - 2.0 * y / double(height_);
    const VecOf<T> across{right_.x * sx + up_.x * sy, right_.y * sx + up_.y * sy, right_.z * sx + up_.z * sy};
    const auto all = [](Vec3 v) { return VecOf<T>{T{} + v.x, T{} + v.y, T{} + v.z}; };
    if (orthographic_) return {all(position_) + across, all(forward_), T{} + near_};
    const VecOf<T> direction = normalize(all(forward_) + across);
    return {all(position_), direction, near_ / dot(direction, all(forward_))};
}

geometry::Ray CameraRays::through(double x, double y) const {
    const Line<double> line = line_through(x, y);
    geometry::Ray ray;
    ray.origin = vec3(line.origin), ray.direction = vec3(line.direction), ray.t_min = line.t_min;
    return ray;
}

void CameraRays::through(const Lanes& x, const Lanes& y, geometry::Ray* rays) const {
    const Line<Lanes> line = line_through(x, y);
    make_rays(line.origin, line.direction, line.t_min, Lanes{} + std::numeric_limits<double>::infinity(), rays);
}

geometry::Ray CameraRays::through_lens(double x, double y, double right, double up, double focus) const {
    geometry::Ray ray = through(x, y);
    const Vec3 sharp = ray.origin + ray.direction * (focus / dot(ray.direction, forward_));
    ray.origin += normalize(right_) * right + normalize(up_) * up;
    ray.direction = normalize(sharp - ray.origin);
    ray.t_min = near_ / dot(ray.direction, forward_);
    return ray;
}

CameraRays::Projected CameraRays::at(Vec3 across, double depth) const {
    const double sx = dot(across, right_) / dot(right_, right_), sy = dot(across, up_) / dot(up_, up_);
    return {(sx + 1) * width_ / 2, (1 - sy) * height_ / 2, depth};
}

std::optional<CameraRays::Projected> CameraRays::project(Vec3 point) const {
    const Vec3 way = point - position_;
    const double depth = dot(way, forward_);
    if (!(depth > (orthographic_ ? near_ : std::max(near_, 0.0)))) return {};
    return at(orthographic_ ? way : way / depth, depth);
}

std::optional<CameraRays::Projected> CameraRays::project_direction(Vec3 direction) const {
    const double depth = dot(direction, forward_);
    if (orthographic_ || !(depth > 0)) return {};
    return at(direction / depth, depth);
}

}  // namespace crescente::render
