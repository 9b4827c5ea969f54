#include "render/bsdf.h"

#include "render/physical_view.h"
#include "render/scattering.h"
#include "render/sheen.h"

namespace crescente::render {

Smooth smooth_facets(const Lobes& lobes) {
    if (!lobes.layered()) return {true, true};
    const bool smooth = lobes.smooth();
    return {smooth || (lobes.coat > 0 && lobes.coat_is_smooth()), smooth || !lobes.transmits() || std::abs(lobes.ior - 1) < least_bend};
}

Smooth smooth_lobes(const Lobes& lobes) {
    Smooth smooth = smooth_facets(lobes);
    smooth.refracts = smooth.refracts && !disperses(lobes);
    return smooth;
}

bool disperses(const Lobes& lobes) { return lobes.dispersion > 0 && lobes.transmits() && std::abs(lobes.ior - 1) >= least_bend; }

Lobes in_band(const Lobes& lobes, int band) {
    Lobes one = lobes;
    one.ior = std::max(1.0, lobes.ior + (band - 1) * 0.5 * (lobes.ior - 1) * lobes.dispersion / 20);  // from red to blue, the index less 1 over Abbe's number
    return one;
}

ChildWeights smooth_weights(const Lobes& lobes, double cosine, double coat_cosine, bool inside) {
    if (!lobes.layered()) return child_weights(lobes, cosine, inside);
    ChildWeights weights;
    if (lobes.transmits()) {
        const Interface facet = glass_interface(lobes, cosine, inside ? 1 / lobes.ior : lobes.ior);
        if (lobes.smooth()) weights.reflected = lobes.mirror * facet.reflected + schlick(lobes.metal, lobes.metal_share, cosine) + beyond_tables(lobes, cosine);
        if (smooth_facets(lobes).refracts) weights.refracted = lobes.refraction * facet.through;
    } else {
        if (lobes.smooth()) weights.reflected = facet_reflectance(lobes, cosine);
        weights.refracted = lobes.refraction;
    }
    if (lobes.has_sheen() && !inside) {
        const auto below = static_cast<float>(1 - sheen_reflectance(lobes, cosine));
        weights = {weights.reflected * below, weights.refracted * below};
    }
    if (lobes.coat > 0 && !inside) {
        const auto below = static_cast<float>(1 - coat_reflectance(lobes, coat_cosine));
        weights = {weights.reflected * below, weights.refracted * below};
        if (lobes.coat_is_smooth()) weights.reflected += gray(static_cast<float>(fresnel_dielectric(coat_cosine, coat_ior)) * lobes.coat);
    }
    return weights;
}

Vec3 mirrored_direction(const Facing& facing, Vec3 to_viewer) {
    const Vec3 direction = normalize(facing.shading * (2 * dot(facing.shading, to_viewer)) - to_viewer);
    const double above = dot(direction, facing.geometric);
    return above < 1e-4 ? normalize(direction + facing.geometric * (1e-4 - above)) : direction;
}

Vec3 refracted_direction(const Facing& facing, Vec3 to_viewer, double eta) {
    const double cosine = dot(facing.shading, to_viewer), sin2 = eta * eta * std::max(0.0, 1 - cosine * cosine);
    return normalize(facing.shading * (eta * cosine - std::sqrt(std::max(0.0, 1 - sin2))) - to_viewer * eta);
}

Rgb reflect_composed(const Lobes& lobes, Vec3 normal, Vec3 to_viewer, Vec3 to_light, bool with_highlight) {
    const Facing facing{normal, normal, false};
    const Scattered s = Scattering(lobes, facing, to_viewer, SmoothAs::highlights).toward(to_light);
    return with_highlight ? s.diffuse + s.glossy : s.diffuse;
}

}  // namespace crescente::render
