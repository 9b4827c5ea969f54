#include "render/light.h"

#include <limits>

namespace crescente::render {

Light::Light(const scene::Light& light, bool stands_in)
    : light_(light),
      sampled_(stands_in || scene::has_extent(light)),
      axis_(normalize(light.direction)),
      upward_(light.measured ? scene::upward_of(light) : Vec3{}),
      color_(light.color * static_cast<float>(light.intensity)),
      oriented_(light.kind == scene::LightKind::point && light.outer_angle < pi),
      cos_outer_(std::cos(light.outer_angle)),
      cos_scale_(1 / std::max(0.001, std::cos(light.inner_angle) - std::cos(light.outer_angle))) {}

Incident Light::at(Vec3 point) const {
    const Reach<double> one = reach(vec_of(point));
    return {vec3(one.to_light), one.distance, color_ * static_cast<float>(one.factor)};
}

template <class T>
Reach<T> Light::reach(const VecOf<T>& point) const {
    if (light_.kind == scene::LightKind::directional) {
        const VecOf<T> back{T{} - axis_.x, T{} - axis_.y, T{} - axis_.z};
        return {back, T{} + std::numeric_limits<double>::infinity(), T{} + 1.0};
    }
    const VecOf<T> path{light_.position.x - point.x, light_.position.y - point.y, light_.position.z - point.z};
    const T distance = length(path);
    const auto apart = distance > 0.0;
    const T unit = apart ? distance : T{} + 1.0;
    Reach<T> at{{path.x / unit, path.y / unit, path.z / unit}, distance, falloff(unit)};
    if (scene::is_flat(light_)) at.factor *= flat(T(-(at.to_light.x * axis_.x + at.to_light.y * axis_.y + at.to_light.z * axis_.z)));
    if (light_.measured) at.factor *= profile<T>(at.to_light);
    if (oriented_) at.factor *= cone(T(-(at.to_light.x * axis_.x + at.to_light.y * axis_.y + at.to_light.z * axis_.z)));
    at.factor = apart ? at.factor : T{};
    return at;
}

template Reach<double> Light::reach(const VecOf<double>&) const;
template Reach<Lanes> Light::reach(const VecOf<Lanes>&) const;

// Intensity of an evenly bright area at the angle of this cosine from its axis, over that along the axis (Lambert's cosine law).
template <class T>
T Light::flat(const T& cosine) const {
    return light_.two_sided ? greater(cosine, T(-cosine)) : greater(cosine, T{});
}

// Candela towards a point from which the light is seen in this direction.
template <class T>
T Light::profile(const VecOf<T>& to_light) const {
    const Vec3 aside = cross(upward_, axis_);  // horizontal angles go counter-clockwise as seen from behind the lamp
    const auto one = [&](Vec3 away) {
        const double along = std::clamp(dot(away, axis_), -1.0, 1.0);
        return light_.measured->intensity(std::acos(along), std::atan2(dot(away, aside), dot(away, upward_)));
    };
    if constexpr (std::is_same_v<T, double>) {
        return one(-vec3(to_light));
    } else {
        T result{};
        for (int i = 0; i < lane_count; ++i) result[i] = one(-lane(to_light, i));
        return result;
    }
}

// Share of full strength at the angle of this cosine from the axis.
template <class T>
T Light::cone(const T& cosine) const {
    const auto within = cosine > cos_outer_;
    switch (light_.gradient) {
        case scene::Gradient::smooth: {
            const T ramp = lesser(greater(T((cosine - cos_outer_) * cos_scale_), T{}), T{} + 1.0);
            return within ? ramp * ramp : T{};
        }
        case scene::Gradient::linear: {
            const double width = std::max(1e-9, light_.outer_angle - light_.inner_angle);
            const T angle = lane_by_lane(cosine, [](double c) { return std::acos(std::min(1.0, c)); });
            return within ? lesser(greater(T((light_.outer_angle - angle) / width), T{}), T{} + 1.0) : T{};
        }
        case scene::Gradient::power: {
            return within ? lane_by_lane(cosine, [this](double c) { return std::pow(std::max(0.0, c), light_.exponent); }) : T{};
        }
    }
    return T{};
}

template <class T>
T Light::falloff(const T& distance) const {
    T factor = T{} + 1.0;
    switch (light_.falloff) {
        case scene::Falloff::none: break;
        case scene::Falloff::inverse_square: factor = 1.0 / (distance * distance); break;
        case scene::Falloff::classic: {
            const T denominator = light_.constant + light_.linear * distance + light_.quadratic * distance * distance;
            factor = 1.0 / greater(denominator, T{} + 1.0);
            break;
        }
    }
    if (light_.range > 0) {
        const T r = distance / light_.range, r2 = r * r;
        factor *= greater(T(1.0 - r2 * r2), T{});
    }
    return factor;
}

}  // namespace crescente::render
