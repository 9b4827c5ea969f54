#include "render/environment.h"

namespace crescente::render {

Environment::Environment(const scene::Environment& source)
    : source_(source), cos_(std::cos(source.rotation)), sin_(std::sin(source.rotation)),
      brightness_{luminance(source.nadir), luminance(source.horizon), luminance(source.zenith)},
      even_(source.nadir == source.horizon && source.zenith == source.horizon) {
    total_ = brightness_[0] / 2 + brightness_[1] + brightness_[2] / 2;
}

bool Environment::same_radiance(const Environment& other) const {
    const scene::Environment &a = source_, &b = other.source_;
    if (a.panorama && b.panorama) return a.panorama->content() == b.panorama->content() && a.rotation == b.rotation;
    return !a.panorama && !b.panorama && a.zenith == b.zenith && a.horizon == b.horizon && a.nadir == b.nadir;
}

// Of the gradient: linear in the height of the direction between nadir, horizon and zenith.
Rgb Environment::radiance(Vec3 direction) const {
    if (panorama()) return panorama()->radiance(in_picture(direction));
    if (even_) return source_.horizon;
    const auto y = static_cast<float>(direction.y);
    return y >= 0 ? mix(source_.horizon, source_.zenith, y) : mix(source_.horizon, source_.nadir, -y);
}

Rgb Environment::irradiance(Vec3 normal) const {
    if (panorama()) return panorama()->irradiance(in_picture(normal));
    // Clamped cosine about the normal times clamped cosine about the vertical, over the sphere, over pi: (2 / 3 pi)
    // (sin a + (pi - a) cos a) for the angle a between them (the zonal form of Ramamoorthi and Hanrahan 2001, integrated exactly).
    const auto overlap = [](double c) {
        const double a = std::acos(std::clamp(c, -1.0, 1.0));
        return static_cast<float>(2 / (3 * pi) * (std::sqrt(std::max(0.0, 1 - c * c)) + (pi - a) * c));
    };
    const scene::Environment& e = source_;
    return e.horizon + (e.zenith - e.horizon) * overlap(normal.y) + (e.nadir - e.horizon) * overlap(-normal.y);
}

Rgb Environment::blurred(Vec3 direction, double roughness) const {
    if (panorama()) return panorama()->blurred(in_picture(direction), roughness);
    return mix(radiance(direction), irradiance(direction), static_cast<float>(roughness));
}

// Equal bands of height are equal solid angles (Archimedes), so that the height's density follows the brightness, linear in each half.
double Environment::height_density(double height) const {
    const double end = height >= 0 ? brightness_[2] : brightness_[0];
    return (brightness_[1] + (end - brightness_[1]) * std::abs(height)) / total_;
}

Environment::Sample Environment::sample(double u0, double u1) const {
    if (panorama()) {
        const Sample s = panorama()->sample(u0, u1);
        const Vec3 d = s.direction;
        return {{d.x * cos_ + d.z * sin_, d.y, d.z * cos_ - d.x * sin_}, s.pdf};
    }
    const double below = (brightness_[0] + brightness_[1]) / (2 * total_);
    const bool up = u0 >= below;
    const double u = std::clamp(up ? (u0 - below) / (1 - below) : u0 / below, 0.0, 1.0);
    // Where the integral of a linear density, from a at the horizon to b, comes to the share u.
    const double a = brightness_[1], b = up ? brightness_[2] : brightness_[0];
    const double t = std::min(1.0, u * (a + b) / (a + std::sqrt(a * a + u * (b * b - a * a))));
    const double height = up ? t : -t, level = std::sqrt(std::max(0.0, 1 - t * t)), azimuth = 2 * pi * u1;
    return {{level * std::cos(azimuth), height, level * std::sin(azimuth)}, height_density(height) / (2 * pi)};
}

double Environment::pdf(Vec3 direction) const { return panorama() ? panorama()->pdf(in_picture(direction)) : height_density(direction.y) / (2 * pi); }

Rgb environment_radiance(const Environment& environment, Vec3 direction) {
    const Rgb radiance = environment.radiance(direction);
    return environment.source().panorama ? radiance * static_cast<float>(environment.source().intensity) : radiance;
}

Rgb reflect_environment(const Environment& environment, const Lobes& lobes, Vec3 normal, Vec3 to_viewer, bool inside) {
    if (environment.strength() == 0) return {};
    const Rgb irradiance = environment.irradiance(normal) * static_cast<float>(environment.even_share());
    Rgb result = lobes.ambient_diffuse * irradiance;
    if (lobes.layered()) {
        const double cosine = std::clamp(dot(normal, to_viewer), 0.0, 1.0);
        const LayerShare layer = at_cosine(lobes.layer[inside], cosine);
        const float blurred = 1 - lobes.mirror_share;
        // The layer lets in what neither the mirrored ray nor the blurred reflection takes.
        const float mirrored_share = layer_mirrors(lobes, cosine, inside) * lobes.mirror_share;
        result *= gray(1 - mirrored_share - layer.kept * blurred);
        result += lobes.multiple * irradiance * (layer.missing * blurred);
        if (blurred > 0 && lobes.ambient_specular > 0) {
            Rgb reflectance = tabled_reflectance(lobes, cosine);
            if (lobes.film > 0 || lobes.conductor > 0) reflectance += beyond_tables(lobes, cosine) * (1 - layer.missing);
            const Vec3 mirrored = normal * (2 * dot(normal, to_viewer)) - to_viewer;
            result += reflectance * (lobes.ambient_specular * blurred) * environment.blurred(mirrored, lobes.roughness);
        }
    }
    if (lobes.has_sheen() && !inside) {
        const double cosine = std::clamp(dot(normal, to_viewer), 0.0, 1.0);
        const auto sent = static_cast<float>(std::min(1.0f, at_cosine(lobes.sheen_sums, cosine)));
        result = result * (1 - lobes.sheen_most * sent) + lobes.sheen * irradiance * sent;
    }
    if (lobes.coat > 0 && !inside) {
        const Vec3 over = lobes.coat_normal == Vec3{} ? normal : lobes.coat_normal;
        const double cosine = std::clamp(dot(over, to_viewer), 0.0, 1.0);
        const Vec3 mirrored = over * (2 * dot(over, to_viewer)) - to_viewer;
        const auto reflectance = static_cast<float>(coat_reflectance(lobes, cosine));
        const Rgb blurred = environment.blurred(mirrored, std::sqrt(lobes.coat_alpha));
        result = result * (1 - reflectance) + blurred * (reflectance * (1 - lobes.coat_mirror_share));
    }
    return result * static_cast<float>(environment.strength());
}

Rgb backdrop_radiance(const Environment& environment, double height) {
    const scene::Environment& e = environment.source();
    return mix(e.backdrop_bottom, e.backdrop_top, static_cast<float>(std::clamp(height, 0.0, 1.0)));
}

}  // namespace crescente::render
