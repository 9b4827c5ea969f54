#include "render/luminous_shape.h"

#include "render/spherical_rectangle.h"

namespace crescente::render {
namespace {

// Below this solid angle rectangles are sampled by area: their solid angle, a difference of angles, loses its digits, and there is nothing to gain.
constexpr double least_solid_angle = 1e-4;  // steradian

// 1 - cos of half the angle under which a sphere is seen from outside, without cancellation.
double versine_of(double radius, double distance) {
    const double sine = radius / distance, square = sine * sine;
    return square / (1 + std::sqrt(std::max(0.0, 1 - square)));
}

// A direction by the cosine of its angle to a unit axis, given as 1 - cosine.
Vec3 around(Vec3 axis, double versine, double azimuth) {
    const double sine = std::sqrt(std::max(0.0, versine * (2 - versine)));
    const Vec3 u = perpendicular(axis), v = cross(axis, u);
    return normalize(axis * (1 - versine) + u * (sine * std::cos(azimuth)) + v * (sine * std::sin(azimuth)));
}

}  // namespace

LuminousShape::LuminousShape(Form form, Vec3 origin, Vec3 a, Vec3 b, double inner, bool two_sided)
    : form_(form), two_sided_(two_sided), origin_(origin), a_(a), b_(b), inner_(inner) {
    if (form == Form::sphere) {
        area_ = 4 * pi * a.x * a.x;
        return;
    }
    const Vec3 across = cross(a, b);
    const double parallelogram = length(across);
    area_ = form == Form::triangle ? parallelogram / 2 : form == Form::ellipse ? pi * parallelogram * (1 - inner * inner) : parallelogram;
    if (parallelogram > 0) normal_ = across / parallelogram;
}

LuminousShape LuminousShape::rectangle(Vec3 corner, Vec3 a, Vec3 b, bool two_sided) { return {Form::rectangle, corner, a, b, 0, two_sided}; }
LuminousShape LuminousShape::parallelogram(Vec3 corner, Vec3 a, Vec3 b, bool two_sided) { return {Form::parallelogram, corner, a, b, 0, two_sided}; }
LuminousShape LuminousShape::triangle(Vec3 corner, Vec3 a, Vec3 b, bool two_sided) { return {Form::triangle, corner, a, b, 0, two_sided}; }
LuminousShape LuminousShape::ellipse(Vec3 center, Vec3 a, Vec3 b, double inner, bool two_sided) { return {Form::ellipse, center, a, b, inner, two_sided}; }
LuminousShape LuminousShape::sphere(Vec3 center, double radius, bool two_sided) { return {Form::sphere, center, {radius, 0, 0}, {}, 0, two_sided}; }

// Whether a point lies on a shining side of a flat shape.
bool LuminousShape::faces(Vec3 from) const {
    const double height = dot(from - origin_, normal_);
    return height > 0 || (two_sided_ && height < 0);
}

// Points of equal u take equal areas.
Vec3 LuminousShape::point_of(double u0, double u1) const {
    switch (form_) {
        case Form::triangle: {  // the low-distortion map of Heitz 2019
            const double s = u1 > u0 ? u0 / 2 : u0 - u1 / 2, t = u1 > u0 ? u1 - u0 / 2 : u1 / 2;
            return origin_ + a_ * s + b_ * t;
        }
        case Form::ellipse: {
            const double r = std::sqrt(inner_ * inner_ + (1 - inner_ * inner_) * u0), angle = 2 * pi * u1;
            return origin_ + a_ * (r * std::cos(angle)) + b_ * (r * std::sin(angle));
        }
        default: return origin_ + a_ * u0 + b_ * u1;
    }
}

std::optional<ShapeSample> LuminousShape::sample(Vec3 from, double u0, double u1) const {
    if (form_ == Form::sphere) return sample_sphere(from, u0, u1);
    if (!(area_ > 0) || !faces(from)) return std::nullopt;
    if (form_ == Form::rectangle) {
        const SphericalRectangle seen(origin_, a_, b_, from);
        if (seen.solid_angle() > least_solid_angle) {
            const Vec3 path = seen.sample(u0, u1) - from;
            const double distance = length(path);
            if (!(distance > 0)) return std::nullopt;
            return ShapeSample{path / distance, distance, 1 / seen.solid_angle()};
        }
    }
    const Vec3 path = point_of(u0, u1) - from;
    const double distance = length(path), cosine = std::abs(dot(path, normal_)) / distance;
    if (!(cosine > 0)) return std::nullopt;
    return ShapeSample{path / distance, distance, distance * distance / (cosine * area_)};
}

// By the cone of directions that meet it (Shirley, Wang and Zimmerman 1996, "Monte Carlo Techniques for Direct Lighting Calculations").
std::optional<ShapeSample> LuminousShape::sample_sphere(Vec3 from, double u0, double u1) const {
    const Vec3 path = origin_ - from;
    const double radius = a_.x, distance = length(path);
    if (distance <= radius) {
        if (!two_sided_ || distance == radius) return std::nullopt;
        const Vec3 direction = around({0, 0, 1}, 2 * u0, 2 * pi * u1);
        const double along = dot(path, direction);
        return ShapeSample{direction, along + std::sqrt(std::max(0.0, along * along + (radius - distance) * (radius + distance))), 1 / (4 * pi)};
    }
    const double widest = versine_of(radius, distance), versine = widest * u0;
    const double sine = distance * std::sqrt(std::max(0.0, versine * (2 - versine)));  // how far the ray passes the centre
    const double to_surface = distance * (1 - versine) - std::sqrt(std::max(0.0, (radius - sine) * (radius + sine)));
    return ShapeSample{around(path / distance, versine, 2 * pi * u1), to_surface, 1 / (2 * pi * widest)};
}

double LuminousShape::pdf(Vec3 from, Vec3 point) const {
    if (form_ == Form::sphere) {
        const double radius = a_.x, distance = length(origin_ - from);
        // From outside the far side, which a surface with coverage shows, is never sampled.
        if (distance > radius) return dot(point - origin_, from - point) > 0 ? 1 / (2 * pi * versine_of(radius, distance)) : 0;
        return two_sided_ && distance < radius ? 1 / (4 * pi) : 0;
    }
    if (!(area_ > 0) || !faces(from)) return 0;
    if (form_ == Form::rectangle) {
        const double solid_angle = SphericalRectangle(origin_, a_, b_, from).solid_angle();
        if (solid_angle > least_solid_angle) return 1 / solid_angle;
    }
    const Vec3 path = point - from;
    const double distance = length(path), cosine = std::abs(dot(path, normal_)) / distance;
    return cosine > 0 ? distance * distance / (cosine * area_) : 0;
}

std::optional<double> LuminousShape::meet(const geometry::Ray& ray) const {
    const auto within = [&](double t) { return t > ray.t_min && t <= ray.t_max; };
    if (form_ == Form::sphere) {
        // From the point of the ray nearest to the centre, as geometry/sphere.h does.
        const double middle = dot(origin_ - ray.origin, ray.direction), radius = a_.x;
        const double apart = length(ray.at(middle) - origin_);
        if (!(apart < radius)) return std::nullopt;
        const double half = std::sqrt((radius - apart) * (radius + apart));
        if (within(middle - half)) return middle - half;
        return two_sided_ && within(middle + half) ? std::optional(middle + half) : std::nullopt;
    }
    const double slope = dot(ray.direction, normal_);
    if (!(two_sided_ ? slope != 0 : slope < 0)) return std::nullopt;
    const double t = dot(origin_ - ray.origin, normal_) / slope;
    if (!within(t)) return std::nullopt;
    const Vec3 p = ray.at(t) - origin_;
    const double scale = 1 / dot(cross(a_, b_), normal_);
    const double s = dot(cross(p, b_), normal_) * scale, r = dot(cross(a_, p), normal_) * scale;
    switch (form_) {
        case Form::triangle: return s >= 0 && r >= 0 && s + r <= 1 ? std::optional(t) : std::nullopt;
        case Form::ellipse: return s * s + r * r <= 1 && s * s + r * r >= inner_ * inner_ ? std::optional(t) : std::nullopt;
        default: return s >= 0 && s <= 1 && r >= 0 && r <= 1 ? std::optional(t) : std::nullopt;
    }
}

Bounds LuminousShape::bounds() const {
    Bounds box;
    switch (form_) {
        case Form::sphere: {
            const Vec3 extent{a_.x, a_.x, a_.x};
            return {origin_ - extent, origin_ + extent};
        }
        case Form::ellipse: {
            const auto reach = [](double x, double y) { return std::sqrt(x * x + y * y); };
            const Vec3 extent{reach(a_.x, b_.x), reach(a_.y, b_.y), reach(a_.z, b_.z)};
            return {origin_ - extent, origin_ + extent};
        }
        case Form::triangle: break;
        default: box.include(origin_ + a_ + b_);
    }
    box.include(origin_), box.include(origin_ + a_), box.include(origin_ + b_);
    return box;
}

}  // namespace crescente::render
