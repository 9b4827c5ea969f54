#include "render/light.h"

#include <limits>

namespace crescente::render {

Light::Light(const scene::Light& light)
    : light_(light),
      axis_(normalize(light.direction)),
      color_(light.color * static_cast<float>(light.intensity)),
      oriented_(light.kind == scene::LightKind::point && light.outer_angle < pi),
      cos_outer_(std::cos(light.outer_angle)),
      cos_scale_(1 / std::max(0.001, std::cos(light.inner_angle) - std::cos(light.outer_angle))) {}

Incident Light::at(Vec3 point) const {
    if (light_.kind == scene::LightKind::directional) return {-axis_, std::numeric_limits<double>::infinity(), color_};
    const Vec3 path = light_.position - point;
    const double distance = length(path);
    if (!(distance > 0)) return {{0, 1, 0}, 0, {}};
    Incident incident{path / distance, distance, {}};
    double factor = falloff(distance);
    if (oriented_ && factor > 0) factor *= cone(-dot(incident.to_light, axis_));
    incident.strength = color_ * static_cast<float>(factor);
    return incident;
}

// Share of full strength at the angle of this cosine from the axis.
double Light::cone(double cosine) const {
    if (cosine <= cos_outer_) return 0;
    switch (light_.gradient) {
        case scene::Gradient::smooth: {
            const double ramp = std::clamp((cosine - cos_outer_) * cos_scale_, 0.0, 1.0);
            return ramp * ramp;
        }
        case scene::Gradient::linear: {
            const double width = std::max(1e-9, light_.outer_angle - light_.inner_angle);
            return std::clamp((light_.outer_angle - std::acos(std::min(1.0, cosine))) / width, 0.0, 1.0);
        }
        case scene::Gradient::power: return std::pow(std::max(0.0, cosine), light_.exponent);
    }
    return 0;
}

double Light::falloff(double distance) const {
    double factor = 1;
    switch (light_.falloff) {
        case scene::Falloff::none: break;
        case scene::Falloff::inverse_square: factor = 1 / (distance * distance); break;
        case scene::Falloff::classic: {
            const double denominator = light_.constant + light_.linear * distance + light_.quadratic * distance * distance;
            factor = denominator > 1 ? 1 / denominator : 1;
            break;
        }
    }
    if (light_.range > 0) {
        const double r = distance / light_.range, r2 = r * r;
        factor *= std::clamp(1 - r2 * r2, 0.0, 1.0);
    }
    return factor;
}

}  // namespace crescente::render
