#include "render/environment.h"

namespace crescente::render {

Rgb environment_radiance(const scene::Environment& e, Vec3 direction) {
    const auto y = static_cast<float>(direction.y);
    return y >= 0 ? mix(e.horizon, e.zenith, y) : mix(e.horizon, e.nadir, -y);
}

Rgb environment_irradiance(const scene::Environment& e, Vec3 normal) {
    // Clamped cosine about the normal times clamped cosine about the vertical, over the sphere, over pi: (2 / 3 pi)
    // (sin a + (pi - a) cos a) for the angle a between them (the zonal form of Ramamoorthi and Hanrahan 2001, integrated exactly).
    const auto overlap = [](double c) {
        const double a = std::acos(std::clamp(c, -1.0, 1.0));
        return static_cast<float>(2 / (3 * pi) * (std::sqrt(std::max(0.0, 1 - c * c)) + (pi - a) * c));
    };
    return e.horizon + (e.zenith - e.horizon) * overlap(normal.y) + (e.nadir - e.horizon) * overlap(-normal.y);
}

Rgb reflect_environment(const scene::Environment& e, const Lobes& lobes, Vec3 normal, Vec3 to_viewer) {
    if (e.strength == 0) return {};
    const Rgb irradiance = environment_irradiance(e, normal);
    Rgb result = lobes.ambient_diffuse * irradiance;
    if (const float blurred = 1 - lobes.mirror_share; blurred > 0 && !is_black(lobes.ambient_specular)) {
        // Reflectance of the whole lobe (Karis 2014, "Physically Based Shading on Mobile": a fit of the split-sum integral).
        const double n_v = std::clamp(dot(normal, to_viewer), 0.0, 1.0);
        const double r = lobes.roughness;
        const double rx = 1 - r, ry = 0.0425 - 0.0275 * r, rz = 1.04 - 0.572 * r, rw = 0.022 * r - 0.04;
        const double a = std::min(rx * rx, std::exp2(-9.28 * n_v)) * rx + ry;
        const Rgb reflectance = lobes.ambient_specular * static_cast<float>(rz - 1.04 * a) + gray(static_cast<float>(1.04 * a + rw));
        const Vec3 mirrored = normal * (2 * dot(normal, to_viewer)) - to_viewer;
        result += reflectance * blurred * mix(environment_radiance(e, mirrored), environment_irradiance(e, mirrored), lobes.roughness);
    }
    return result * static_cast<float>(e.strength);
}

Rgb backdrop_radiance(const scene::Environment& e, double height) {
    return mix(e.backdrop_bottom, e.backdrop_top, static_cast<float>(std::clamp(height, 0.0, 1.0)));
}

}  // namespace crescente::render
