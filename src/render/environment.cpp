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

Rgb reflect_environment(const scene::Environment& e, const Lobes& lobes, Vec3 normal, Vec3 to_viewer, bool inside) {
    if (e.strength == 0) return {};
    const Rgb irradiance = environment_irradiance(e, normal);
    Rgb result = lobes.ambient_diffuse * irradiance;
    if (lobes.layered()) {
        const double cosine = std::clamp(dot(normal, to_viewer), 0.0, 1.0);
        const SplitSum sum = split_sum(lobes.sums, cosine);
        const float blurred = 1 - lobes.mirror_share;
        // The layer lets in what neither the mirrored ray nor the blurred reflection takes.
        const float mirrored_share = layer_mirrors(lobes, cosine, inside) * lobes.mirror_share;
        result *= gray(1 - mirrored_share - (lobes.layer_f0 * sum.scale + sum.bias) * blurred);
        result += lobes.multiple * irradiance * (static_cast<float>(sum.missing()) * blurred);
        if (blurred > 0 && !is_black(lobes.ambient_specular)) {
            const Rgb reflectance = lobes.ambient_specular * sum.scale + gray(lobes.coverage * sum.bias);
            const Vec3 mirrored = normal * (2 * dot(normal, to_viewer)) - to_viewer;
            result += reflectance * blurred * mix(environment_radiance(e, mirrored), environment_irradiance(e, mirrored), lobes.roughness);
        }
    }
    if (lobes.coat > 0 && !inside) {
        const double cosine = std::clamp(dot(normal, to_viewer), 0.0, 1.0);
        const Vec3 mirrored = normal * (2 * dot(normal, to_viewer)) - to_viewer;
        const auto reflectance = static_cast<float>(coat_reflectance(lobes, cosine));
        const Rgb blurred = mix(environment_radiance(e, mirrored), environment_irradiance(e, mirrored), std::sqrt(lobes.coat_alpha));
        result = result * (1 - reflectance) + blurred * (reflectance * (1 - lobes.coat_mirror_share));
    }
    return result * static_cast<float>(e.strength);
}

Rgb backdrop_radiance(const scene::Environment& e, double height) {
    return mix(e.backdrop_bottom, e.backdrop_top, static_cast<float>(std::clamp(height, 0.0, 1.0)));
}

}  // namespace crescente::render
