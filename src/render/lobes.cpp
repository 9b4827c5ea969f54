#include "render/lobes.h"

#include <map>

#include "render/bsdf.h"
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

// Share of the light missing from a rough metal's sums that comes back after two or more reflections between its facets (Kulla and Conty 2017, "Revisiting Physically
// Based Shading at Imageworks"). fresnel: mean over all directions; kept: mean_of_sums.
Rgb multiple_reflection(Rgb fresnel, double kept) {
    const auto channel = [kept](double f) { return static_cast<float>(f * f * kept / (1 - f * (1 - kept))); };
    return {channel(fresnel.r), channel(fresnel.g), channel(fresnel.b)};
}

Rgb mean_schlick(Rgb f0) { return f0 * (20.0f / 21) + gray(1.0f / 21); }

constexpr double least_missing = 1e-6;  // of a lobe's light, to be asked where it is; beyond rounding

RoughGlass rough_glass(double alpha, double ior) {
    RoughGlass glass;
    std::array<double, 2> lost, crossing;  // means over all light; crossing: of what is not lost at once, times the square of the index, which must be that of the other side
    for (std::size_t side = 0; side < 2; ++side) {
        glass.sums[side] = glass_sums(alpha, side == 0 ? ior : 1 / ior);
        const double kept = mean_of_sums(glass.sums[side]), index = side == 0 ? 1 : ior;
        lost[side] = index * index * (1 - kept);
        crossing[side] = lost[side] * mean_of_sums(glass.sums[side], 0, 1) / kept;
        glass.density[side] = static_cast<float>(1 / (pi * (1 - kept)));
        glass.cells[side] = missing_cells(glass.sums[side]);
    }
    for (std::size_t side = 0; side < 2; ++side) {
        if (1 - mean_of_sums(glass.sums[side]) < least_missing) {
            glass.density = {};
            return glass;
        }
    }
    // As much must cross in one direction as in the other (reciprocity).
    for (std::size_t side = 0; side < 2; ++side) glass.through[side] = static_cast<float>(std::min(crossing[0], crossing[1]) / lost[side]);
    return glass;
}

// sums_of(alpha): split sums. whole: of the material without textures, null if this is it.
template <class SumsOf>
Lobes compile_physical(const scene::PhysicalMaterial& m, SumsOf&& sums_of, const Lobes* whole) {
    const auto metallic = static_cast<float>(m.metallic), opacity = static_cast<float>(m.opacity);
    const float dielectric = 1 - metallic, transmission = static_cast<float>(m.transmission) * dielectric;
    const double r0 = (m.ior - 1) / (m.ior + 1);
    Lobes lobes;
    lobes.emission = m.emissive * opacity;
    lobes.catcher = m.catcher;
    lobes.coverage = opacity;
    const Rgb diffuse = m.base_color * (dielectric * (1 - static_cast<float>(m.transmission)) * opacity);
    lobes.diffuse = diffuse * static_cast<float>(1 / pi);
    lobes.ambient_diffuse = diffuse;
    const bool conductor = metallic > 0 && !is_black(m.k);
    const Rgb metal_f0 = conductor ? fresnel_conductor(1, m.eta, m.k) : m.base_color;
    lobes.albedo = conductor ? mix(m.base_color, metal_f0, metallic) : m.base_color;
    lobes.layer_f0 = static_cast<float>(r0 * r0);
    const Rgb f0 = mix(gray(lobes.layer_f0), metal_f0, metallic) * opacity;
    lobes.roughness = static_cast<float>(m.roughness);
    lobes.alpha = std::max(smoothest_alpha, lobes.roughness * lobes.roughness);
    lobes.sums = sums_of(lobes.alpha);
    if (conductor) lobes.eta = m.eta, lobes.k = m.k, lobes.conductor_f0 = metal_f0, lobes.conductor = metallic * opacity;
    if (m.clearcoat > 0) {
        lobes.coat = static_cast<float>(m.clearcoat) * opacity;
        lobes.coat_alpha = std::max(smoothest_alpha, static_cast<float>(m.clearcoat_roughness * m.clearcoat_roughness));
        lobes.coat_mirror_share = mirror_share_of(m.clearcoat_roughness);
        lobes.coat_sums = sums_of(lobes.coat_alpha);
    }
    lobes.highlight = f0;
    lobes.highlight_lobe = HighlightLobe::ggx;
    const double kept = mean_of_sums(lobes.sums);
    if (metallic > 0 && 1 - kept > least_missing) {
        lobes.multiple = multiple_reflection(conductor ? mean_fresnel_conductor(m.eta, m.k) : mean_schlick(m.base_color), kept) * (metallic * opacity);
        lobes.multiple_density = static_cast<float>(1 / (pi * (1 - kept)));
        lobes.multiple_cells = missing_cells(lobes.sums);
    }
    if (transmission > 0) {
        lobes.fresnel = Fresnel::dielectric;
        lobes.mirror = gray(dielectric * opacity);
        lobes.mirror_share = 1;
        lobes.metal_share = metallic * opacity;
        lobes.metal = metal_f0 * lobes.metal_share;
        lobes.refraction = m.base_color * (transmission * opacity);
        lobes.straight = gray(1 - opacity);
        lobes.ior = m.ior;
        lobes.attenuation = m.attenuation;
        if (lobes.smooth()) lobes.glass = {};
        else if (!whole) lobes.glass = rough_glass(lobes.alpha, m.ior);
        else if (whole->alpha == lobes.alpha && whole->ior == lobes.ior) lobes.glass = whole->glass;
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

}  // namespace

std::vector<Lobes> compile(std::span<const scene::Material> materials) {
    std::map<float, SplitSums> known_sums;  // by alpha: many materials have the same
    const auto sums_of = [&known_sums](float alpha) -> const SplitSums& {
        const auto [sums, unknown] = known_sums.try_emplace(alpha);
        if (unknown) sums->second = alpha <= smoothest_alpha ? smooth_split_sums() : split_sums(alpha);
        return sums->second;
    };
    std::vector<Lobes> all;
    for (const scene::Material& material : materials) {
        const auto* classic = std::get_if<scene::ClassicMaterial>(&material.model);
        all.push_back(classic ? compile_classic(*classic) : compile_physical(std::get<scene::PhysicalMaterial>(material.model), sums_of, nullptr));
    }
    return all;
}

Lobes compile(const scene::Material& material, const Lobes& whole) {
    if (const auto* classic = std::get_if<scene::ClassicMaterial>(&material.model)) return compile_classic(*classic);
    const auto sums_of = [&whole](float alpha) {
        if (alpha == whole.alpha) return whole.sums;
        return alpha <= smoothest_alpha ? smooth_split_sums() : tabled_split_sums(alpha);
    };
    return compile_physical(std::get<scene::PhysicalMaterial>(material.model), sums_of, &whole);
}

Lobes compile(const scene::Material& material) { return compile(std::span(&material, 1)).front(); }

Rgb reflect_light(const Lobes& lobes, Vec3 normal, Vec3 to_viewer, Vec3 to_light, double cosine, bool with_highlight) {
    if (lobes.composed()) return reflect_composed(lobes, normal, to_viewer, to_light, with_highlight);
    if (lobes.layered()) {
        double radiance[3];
        reflect_physical(physical_view(lobes, dot(normal, to_viewer)), cosine, dot(to_viewer, to_light), layer_at(lobes, cosine), with_highlight, radiance);
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

double coat_reflectance(const Lobes& lobes, double cosine) {
    if (lobes.coat == 0) return 0;
    const SplitSum sum = split_sum(lobes.coat_sums, cosine);
    return lobes.coat * (double(coat_f0) * sum.scale + sum.bias);
}

Rgb conductor_beyond_schlick(const Lobes& lobes, double cosine) {
    if (lobes.conductor == 0) return {};
    return (fresnel_conductor(cosine, lobes.eta, lobes.k) - schlick(lobes.conductor_f0, 1, cosine)) * lobes.conductor;
}

float layer_mirrors(const Lobes& lobes, double cosine, bool inside) {
    if (lobes.fresnel != Fresnel::dielectric) return schlick(gray(lobes.layer_f0), 1, cosine).r;
    return static_cast<float>(fresnel_dielectric(cosine, inside ? 1 / lobes.ior : lobes.ior));
}

bool send_same_rays(const Lobes& a, const Lobes& b) {
    return a.mirror == b.mirror && a.refraction == b.refraction && a.straight == b.straight && a.ior == b.ior && a.fresnel == b.fresnel &&
           a.metal == b.metal && a.metal_share == b.metal_share && a.coverage == b.coverage && a.mirror_share == b.mirror_share &&
           a.eta == b.eta && a.k == b.k && a.conductor == b.conductor && a.coat == b.coat && a.coat_alpha == b.coat_alpha;
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
            if (lobes.metal_share > 0) weights.reflected += schlick(lobes.metal, lobes.metal_share, cosine) + conductor_beyond_schlick(lobes, cosine);
            break;
        }
        case Fresnel::schlick:
            if (!is_black(lobes.mirror)) weights.reflected = (schlick(lobes.mirror, lobes.coverage, cosine) + conductor_beyond_schlick(lobes, cosine)) * lobes.mirror_share;
            break;
    }
    if (lobes.coat > 0 && !inside) {
        const auto below = static_cast<float>(1 - coat_reflectance(lobes, cosine));
        weights = {weights.reflected * below + schlick(gray(coat_f0), 1, cosine) * (lobes.coat * lobes.coat_mirror_share), weights.refracted * below};
    }
    return weights;
}

}  // namespace crescente::render
