#include "render/camera_rays.h"

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

geometry::Ray CameraRays::through(double x, double y) const {
    const double sx = 2 * x / width_ - 1, sy = 1 - 2 * y / height_;
    geometry::Ray ray;
    const Vec3 across = right_ * sx + up_ * sy;
    if (orthographic_) {
        ray.origin = position_ + across;
        ray.direction = forward_;
        ray.t_min = near_;
    } else {
        ray.origin = position_;
        ray.direction = normalize(forward_ + across);
        ray.t_min = near_ / dot(ray.direction, forward_);
    }
    return ray;
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
