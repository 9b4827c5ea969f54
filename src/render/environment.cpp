#include "render/environment.h"

namespace crescente::render {

Environment::Environment(const scene::Environment& source)
    : source_(source), brightness_{luminance(source.nadir), luminance(source.horizon), luminance(source.zenith)} {
    total_ = brightness_[0] / 2 + brightness_[1] + brightness_[2] / 2;
}

bool Environment::same_radiance(const Environment& other) const {
    const scene::Environment &a = source_, &b = other.source_;
    return a.zenith == b.zenith && a.horizon == b.horizon && a.nadir == b.nadir;
}

// Equal bands of height are equal solid angles (Archimedes), so that the height's density follows the brightness, linear in each half.
double Environment::height_density(double height) const {
    const double end = height >= 0 ? brightness_[2] : brightness_[0];
    return (brightness_[1] + (end - brightness_[1]) * std::abs(height)) / total_;
}

Environment::Sample Environment::sample(double u0, double u1) const {
    const double below = (brightness_[0] + brightness_[1]) / (2 * total_);
    const bool up = u0 >= below;
    const double u = std::clamp(up ? (u0 - below) / (1 - below) : u0 / below, 0.0, 1.0);
    // Where the integral of a linear density, from a at the horizon to b, comes to the share u.
    const double a = brightness_[1], b = up ? brightness_[2] : brightness_[0];
    const double t = std::min(1.0, u * (a + b) / (a + std::sqrt(a * a + u * (b * b - a * a))));
    const double height = up ? t : -t, level = std::sqrt(std::max(0.0, 1 - t * t)), azimuth = 2 * pi * u1;
    return {{level * std::cos(azimuth), height, level * std::sin(azimuth)}, height_density(height) / (2 * pi)};
}

double Environment::pdf(Vec3 direction) const { return height_density(direction.y) / (2 * pi); }

Rgb environment_radiance(const Environment& environment, Vec3 direction) {
    const scene::Environment& e = environment.source();
    const auto y = static_cast<float>(direction.y);
    return y >= 0 ? mix(e.horizon, e.zenith, y) : mix(e.horizon, e.nadir, -y);
}

Rgb environment_irradiance(const Environment& environment, Vec3 normal) {
    const scene::Environment& e = environment.source();
    // Clamped cosine about the normal times clamped cosine about the vertical, over the sphere, over pi: (2 / 3 pi)
    // (sin a + (pi - a) cos a) for the angle a between them (the zonal form of Ramamoorthi and Hanrahan 2001, integrated exactly).
    const auto overlap = [](double c) {
        const double a = std::acos(std::clamp(c, -1.0, 1.0));
        return static_cast<float>(2 / (3 * pi) * (std::sqrt(std::max(0.0, 1 - c * c)) + (pi - a) * c));
    };
    return e.horizon + (e.zenith - e.horizon) * overlap(normal.y) + (e.nadir - e.horizon) * overlap(-normal.y);
}

Rgb reflect_environment(const Environment& environment, const Lobes& lobes, Vec3 normal, Vec3 to_viewer, bool inside) {
    if (environment.strength() == 0) return {};
    const Rgb irradiance = environment_irradiance(environment, normal);
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
            result += reflectance * blurred * mix(environment_radiance(environment, mirrored), environment_irradiance(environment, mirrored), lobes.roughness);
        }
    }
    return result * static_cast<float>(environment.strength());
}

Rgb backdrop_radiance(const Environment& environment, double height) {
    const scene::Environment& e = environment.source();
    return mix(e.backdrop_bottom, e.backdrop_top, static_cast<float>(std::clamp(height, 0.0, 1.0)));
}

}  // namespace crescente::render
