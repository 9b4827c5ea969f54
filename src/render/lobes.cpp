#include "render/lobes.h"

#include "render/physical_view.h"

namespace crescente::render {
namespace {

// Rough metals and glossy plastics reflect in a lobe that only a distributed level can sample. Until then the mirror ray stands for it where the
// lobe is narrow, and fades out with roughness; the environment's blurred reflection takes the rest.
float mirror_share_of(double roughness) {
    constexpr double widest = 0.4;
    const double s = std::max(0.0, 1.0 - roughness / widest);
    return static_cast<float>(s * s);
}

Lobes compile_classic(const scene::ClassicMaterial& m) {
    Lobes lobes;
    lobes.emission = m.emission + m.ambient;
    lobes.diffuse = m.diffuse;
    lobes.ambient_diffuse = m.diffuse;
    lobes.albedo = m.diffuse;
    lobes.highlight = m.specular;
    lobes.exponent = static_cast<float>(m.shininess);
    if (!is_black(m.specular)) {
        lobes.highlight_lobe = m.highlight == scene::Highlight::phong ? HighlightLobe::phong : HighlightLobe::blinn;
    }
    lobes.mirror = m.reflection;
    lobes.refraction = m.transmission;
    lobes.ior = m.ior;
    if (lobes.refracts()) lobes.attenuation = m.attenuation;
    lobes.fresnel = m.fresnel ? Fresnel::dielectric : Fresnel::none;
    lobes.shadow_filter = m.transmission;
    return lobes;
}

Lobes compile_physical(const scene::PhysicalMaterial& m, SplitSums (*sums)(double alpha)) {
    const auto metallic = static_cast<float>(m.metallic), opacity = static_cast<float>(m.opacity);
    const float dielectric = 1 - metallic, transmission = static_cast<float>(m.transmission) * dielectric;
    const double r0 = (m.ior - 1) / (m.ior + 1);
    Lobes lobes;
    lobes.emission = m.emissive * opacity;
    lobes.coverage = opacity;
    const Rgb diffuse = m.base_color * (dielectric * (1 - static_cast<float>(m.transmission)) * opacity);
    lobes.diffuse = diffuse * static_cast<float>(1 / pi);
    lobes.ambient_diffuse = diffuse;
    lobes.albedo = m.base_color;
    lobes.layer_f0 = static_cast<float>(r0 * r0);
    const Rgb f0 = mix(gray(lobes.layer_f0), m.base_color, metallic) * opacity;
    lobes.roughness = static_cast<float>(m.roughness);
    lobes.alpha = std::max(0.002f, lobes.roughness * lobes.roughness);
    lobes.sums = sums(lobes.alpha);
    lobes.highlight = f0;
    lobes.highlight_lobe = HighlightLobe::ggx;
    if (transmission > 0) {
        lobes.fresnel = Fresnel::dielectric;
        lobes.mirror = gray(dielectric * opacity);
        lobes.mirror_share = 1;
        lobes.metal_share = metallic * opacity;
        lobes.metal = m.base_color * lobes.metal_share;
        lobes.refraction = m.base_color * (transmission * opacity);
        lobes.straight = gray(1 - opacity);
        lobes.ior = m.ior;
        lobes.attenuation = m.attenuation;
    } else {
        lobes.fresnel = Fresnel::schlick;
        lobes.mirror_share = mirror_share_of(m.roughness);
        if (lobes.mirror_share > 0) lobes.mirror = f0;
        lobes.ambient_specular = f0;
        lobes.refraction = gray(1 - opacity);
        lobes.one_sided = !m.double_sided;
    }
    // Light through a pane loses about one Fresnel reflection at each crossing.
    lobes.shadow_filter = m.base_color * (transmission * opacity * static_cast<float>(1 - r0 * r0)) + gray(1 - opacity);
    return lobes;
}

// Schlick's approximation of Fresnel's equations (1994), from f0 to f90.
Rgb schlick(Rgb f0, float f90, double cosine) { return f0 + (gray(f90) - f0) * static_cast<float>(fifth_power(1 - cosine)); }

}  // namespace

Lobes compile(const scene::Material& material, SplitSums (*sums)(double alpha)) {
    if (const auto* classic = std::get_if<scene::ClassicMaterial>(&material.model)) return compile_classic(*classic);
    return compile_physical(std::get<scene::PhysicalMaterial>(material.model), sums);
}

Rgb reflect_light(const Lobes& lobes, Vec3 normal, Vec3 to_viewer, Vec3 to_light, double cosine, bool with_highlight) {
    if (lobes.layered()) {
        double radiance[3];
        reflect_physical(physical_view(lobes, dot(normal, to_viewer)), cosine, dot(to_viewer, to_light), layer_reflectance(lobes, cosine), with_highlight, radiance);
        return {static_cast<float>(radiance[0]), static_cast<float>(radiance[1]), static_cast<float>(radiance[2])};
    }
    Rgb result = lobes.diffuse * static_cast<float>(cosine);
    if (!with_highlight || lobes.highlight_lobe == HighlightLobe::none) return result;
    if (lobes.highlight_lobe == HighlightLobe::phong) {
        const double mirrored = 2 * cosine * dot(normal, to_viewer) - dot(to_light, to_viewer);
        if (mirrored > 0) result += lobes.highlight * std::pow(static_cast<float>(mirrored), lobes.exponent);
        return result;
    }
    const double n_h = std::max(0.0, dot(normal, normalize(to_light + to_viewer)));
    return result + lobes.highlight * std::pow(static_cast<float>(n_h), lobes.exponent);
}

double fresnel_dielectric(double cosine, double eta) {
    const double sin2 = (1 - cosine * cosine) / (eta * eta);
    if (sin2 >= 1) return 1;
    const double transmitted = std::sqrt(1 - sin2);
    const double parallel = (eta * cosine - transmitted) / (eta * cosine + transmitted);
    const double perpendicular = (cosine - eta * transmitted) / (cosine + eta * transmitted);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

float layer_mirrors(const Lobes& lobes, double cosine, bool inside) {
    if (lobes.fresnel != Fresnel::dielectric) return schlick(gray(lobes.layer_f0), 1, cosine).r;
    return static_cast<float>(fresnel_dielectric(cosine, inside ? 1 / lobes.ior : lobes.ior));
}

bool send_same_rays(const Lobes& a, const Lobes& b) {
    return a.mirror == b.mirror && a.refraction == b.refraction && a.straight == b.straight && a.ior == b.ior && a.fresnel == b.fresnel &&
           a.metal == b.metal && a.metal_share == b.metal_share && a.coverage == b.coverage && a.mirror_share == b.mirror_share;
}

ChildWeights child_weights(const Lobes& lobes, double cosine, bool inside) {
    ChildWeights weights{lobes.mirror, lobes.refraction};
    const double eta = inside ? 1 / lobes.ior : lobes.ior;
    switch (lobes.fresnel) {
        case Fresnel::none:
            if (lobes.refracts() && (1 - cosine * cosine) >= eta * eta) {  // total internal reflection: all goes back
                weights = {lobes.mirror + lobes.refraction, {}};
            }
            break;
        case Fresnel::dielectric: {
            const auto f = static_cast<float>(fresnel_dielectric(cosine, eta));
            weights = {lobes.mirror * f, lobes.refraction * (1 - f)};
            if (lobes.metal_share > 0) weights.reflected += schlick(lobes.metal, lobes.metal_share, cosine);
            break;
        }
        case Fresnel::schlick:
            if (lobes.mirrors()) weights.reflected = schlick(lobes.mirror, lobes.coverage, cosine) * lobes.mirror_share;
            break;
    }
    return weights;
}

}  // namespace crescente::render
