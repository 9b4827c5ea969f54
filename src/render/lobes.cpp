#include "render/lobes.h"

#include <map>

#include "render/bsdf.h"
#include "render/classic_view.h"
#include "render/microfacets.h"
#include "render/physical_view.h"
#include "render/thin_film.h"

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
    lobes.shining = m.emission;
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

constexpr float highest_f0 = 0.9999f;  // of a layer: what passes is then never less than nothing, by rounding
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

Rgb least_of(Rgb color, float bound) { return {std::min(color.r, bound), std::min(color.g, bound), std::min(color.b, bound)}; }

// What facets reflect, at the cosines of the tables.
template <class Law>
CosineTable<float> tabled_law(const Law& law) {
    CosineTable<float> values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(law(tabled_cosine(i)));
    return values;
}

CosineTable<float> dielectric_rise(double ior) {
    return tabled_law([rise = fresnel_rise(ior)](double cosine) { return rise.at(cosine); });
}

// rise: of the layer, as dielectric_rise gives it.
FacetsAndLayer facets_and_layer(const FacetSums& facets, const CosineTable<float>& rise) { return {facets.sums, reflectance(facets.shares, rise)}; }

CosineTable<float> coat_reflectances(const FacetShares& shares) {
    return reflectance(shares, tabled_law([](double cosine) { return fresnel_dielectric(cosine, coat_ior); }));
}

// What a surface under a thin film reflects: the mean over all light that meets it, each direction by its cosine, and at each cosine the most of the channels.
struct UnderFilm {
    Rgb mean;
    CosineTable<float> most{};
};
UnderFilm under_film(const Lobes& lobes) {
    std::array<CosineTable<float>, 3> channels;
    UnderFilm film;
    for (std::size_t i = 0; i < film.most.size(); ++i) {
        const Rgb reflected = thin_film_reflectance(tabled_cosine(i), lobes.film_ior, lobes.film_thickness, lobes.film_f0);
        for (int c = 0; c < 3; ++c) channels[static_cast<std::size_t>(c)][i] = reflected[c];
        film.most[i] = max_component(reflected);
    }
    film.mean = {static_cast<float>(mean_over_light(channels[0])), static_cast<float>(mean_over_light(channels[1])), static_cast<float>(mean_over_light(channels[2]))};
    return film;
}

// From one side, of the layer of what lets light through.
float kept_by_glass(const Lobes& lobes, std::size_t i, std::size_t side) {
    const RoughGlass& glass = lobes.glass;
    if (glass.density[side] == 0 || std::abs(lobes.ior - 1) < least_bend) return max_component(glass_interface(lobes, tabled_cosine(i), side == 0 ? lobes.ior : 1 / lobes.ior).reflected);
    // Where it rises as steeply as towards total reflection, no less than at any cosine up to the next of the table: nothing is gained by interpolation.
    float most = 0;
    for (std::size_t k = i - (i > 0); k < std::min(i + 1 + side, glass.sums[side].size()); ++k) {
        const SplitSum& sum = glass.sums[side][k];
        if (side == 1 || k == i) most = std::max(most, sum.scale + static_cast<float>(sum.missing()) * (1 - glass.through[side]));
    }
    return most;
}

void set_gives_back(Lobes& lobes) {
    const auto give_back = [&](std::size_t side, double reaches) { lobes.layer_gives_back[side] = reaches > 0 ? static_cast<float>(1 / reaches) : 0; };
    const auto let_in = [&](std::size_t side) {
        CosineTable<float> shares;
        for (std::size_t i = 0; i < shares.size(); ++i) shares[i] = 1 - lobes.layer[side][i].kept;
        return shares;
    };
    CosineTable<float> outside = let_in(0);
    const double passes = mean_over_light(outside);
    // Of an interface that is not asked of a table, what is not in the steps of one: as much passes from inside as from outside, but for total reflection.
    const bool by_interface = lobes.transmits() && lobes.glass.density[1] == 0;
    give_back(1, !lobes.transmits() ? passes : by_interface ? passes / (lobes.ior * lobes.ior) : mean_over_light(let_in(1)));
    if (!(lobes.coat > 0) && !lobes.has_sheen()) return give_back(0, passes);
    for (std::size_t i = 0; i < outside.size(); ++i) {
        const double cosine = tabled_cosine(i), above = (1 - sheen_reflectance(lobes, cosine)) * (1 - coat_reflectance(lobes, cosine));
        outside[i] *= static_cast<float>(above);
    }
    give_back(0, mean_over_light(outside));
}

// Of light from a direction, what coat, fibres and white facets below them do not send back at once, as bsdf.h has them: the more of what is over the facets at either end does not reach these, or does not
// leave again, though less would do at the one end. So do light and viewer see the same (reciprocity), and so is nothing gained.
CosineTable<float> lost_below_layers(const Lobes& lobes) {
    constexpr int steps = 24;
    const Microfacets facets{lobes.alpha, lobes.alpha};
    CosineTable<float> lost;
    for (std::size_t i = 0; i < lost.size(); ++i) {
        const double cosine = std::max(tabled_cosine(i), 1e-4), coat = coat_reflectance(lobes, cosine), sheen = sheen_reflectance(lobes, cosine);
        const Vec3 v{std::sqrt(1 - cosine * cosine), 0, cosine};
        double below = 0;
        for (int k = 0; k < steps * steps; ++k) {
            const Vec3 h = facets.sample_seen(v, (k % steps + 0.5) / steps, (k / steps + 0.5) / steps), l = h * (2 * dot(v, h)) - v;
            if (l.z <= 0) continue;
            const double reaches = (1 - std::max(coat, coat_reflectance(lobes, l.z))) * (1 - std::max(sheen, sheen_reflectance(lobes, l.z)));
            below += facets.seen_by_both(v, l) / facets.seen_by(v) * reaches / (steps * steps);
        }
        lost[i] = static_cast<float>(std::clamp(1 - coat - (1 - coat) * sheen - below, 0.0, 1.0));
    }
    return lost;
}

// What white facets alone lose, or with what is over them, and how it comes back: from all over, in proportion to what is lost in either direction (Kulla and Conty 2017).
void set_multiple(Lobes& lobes, Rgb fresnel, const Lobes* whole) {
    const bool covered = (lobes.coat > 0 || lobes.has_sheen()) && lobes.opacity == 1 && !lobes.smooth() && !lobes.grained() && is_black(lobes.refraction);
    const bool same = whole && whole->gives_back_below && whole->alpha == lobes.alpha && whole->coat == lobes.coat && whole->coat_alpha == lobes.coat_alpha && whole->sheen_most == lobes.sheen_most &&
                      whole->sheen_alpha == lobes.sheen_alpha;
    const double kept = mean_of_sums(lobes.sums);
    if (1 - kept <= least_missing) return;
    lobes.multiple = multiple_reflection(fresnel, kept) * lobes.metal_share;
    lobes.multiple_density = static_cast<float>(1 / (pi * (1 - kept)));
    lobes.multiple_cells = missing_cells(lobes.sums);
    if (!covered || (whole && !same)) return;
    lobes.lost_below = same ? whole->lost_below : lost_below_layers(lobes);
    const double lost = mean_over_light(lobes.lost_below);
    if (lost <= least_missing) return;
    lobes.gives_back_below = true;
    lobes.lost_density = static_cast<float>(1 / (pi * lost));
    SplitSums sent;
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = {1 - lobes.lost_below[i], 0};
    lobes.lost_cells = missing_cells(sent);
}

// film: reflectance of the surface if all of it is under its thin film.
void set_layer(Lobes& lobes, const CosineTable<float>& film) {
    const bool lets_in = !is_black(lobes.diffuse);
    const auto kept = [&](float whole, float rise) { return lobes.layer_f0 * (whole - rise) + lobes.layer_f90 * rise; };
    for (std::size_t side = 0; side < (lobes.transmits() ? 2 : 1); ++side) {
        for (std::size_t i = 0; i < film.size(); ++i) {
            LayerShare& share = lobes.layer[side][i];
            share.missing = static_cast<float>(lobes.sums[i].missing());
            if (!lets_in) continue;
            if (lobes.transmits()) share.kept = kept_by_glass(lobes, i, side);
            else share.kept = between(kept(lobes.sums[i].whole(), lobes.rise[i]), film[i], lobes.film);
            share.kept = std::clamp(share.kept, 0.0f, 1.0f);
        }
    }
    if (!lobes.transmits()) lobes.layer[1] = lobes.layer[0];
    set_gives_back(lobes);
    if (!lets_in || !lobes.grained() || lobes.transmits()) return;
    for (std::size_t i = 0; i < film.size(); ++i) lobes.layer_lean[i] = kept(lobes.lean[i].whole(), lobes.rise_lean[i]) * (1 - lobes.film);
}

// sums_of: of facets, by their roughness and stretch. whole: of the material without textures, null if this is it.
template <class SumsOf>
Lobes compile_physical(const scene::PhysicalMaterial& m, SumsOf&& sums_of, const Lobes* whole) {
    const auto metallic = static_cast<float>(m.metallic), opacity = static_cast<float>(m.opacity);
    if (m.ior == 0 && m.specular == 1 && is_black(m.k)) {  // a metal of the color of its reflection
        scene::PhysicalMaterial metal = m;
        metal.base_color = mix(least_of(m.specular_color, 1), m.base_color, static_cast<float>(m.metallic));
        metal.metallic = 1, metal.ior = 1.5, metal.transmission = 0, metal.specular_color = {1, 1, 1};
        return compile_physical(metal, sums_of, whole);
    }
    const bool endless = m.ior == 0;  // infinite (KHR_materials_ior): whatever does not come back is lost in the body
    const double ior = layer_ior(m), r0 = endless ? 1 : (ior - 1) / (ior + 1);  // its square is the reflectance
    const float dielectric = 1 - metallic, transmission = endless ? 0 : static_cast<float>(m.transmission) * dielectric;
    Lobes lobes;
    lobes.emission = lobes.shining = m.emissive * opacity;
    lobes.catcher = m.catcher, lobes.opacity = opacity;
    const Rgb diffuse = m.base_color * (dielectric * (1 - static_cast<float>(m.transmission)) * opacity);
    lobes.diffuse = diffuse * static_cast<float>(1 / pi);
    lobes.ambient_diffuse = diffuse;
    const bool conductor = metallic > 0 && !is_black(m.k);
    const Rgb metal_f0 = conductor ? fresnel_conductor(1, m.eta, m.k) : m.base_color;
    lobes.albedo = conductor ? mix(m.base_color, metal_f0, metallic) : m.base_color;
    const Rgb layer_f0 = least_of(m.specular_color * static_cast<float>(r0 * r0), 1) * static_cast<float>(m.specular);
    lobes.layer_f0 = std::min(max_component(layer_f0), highest_f0);
    lobes.layer_f90 = static_cast<float>(m.specular), lobes.layer_ior = metallic < 1 ? ior : 1;
    const Rgb f0 = mix(layer_f0, metal_f0, metallic) * opacity;
    lobes.coverage = (lobes.layer_f90 + (1 - lobes.layer_f90) * metallic) * opacity;
    lobes.metal_share = metallic * opacity, lobes.metal = metal_f0 * lobes.metal_share;
    lobes.roughness = static_cast<float>(m.roughness);
    lobes.alpha = lobes.alpha_along = std::max(smoothest_alpha, lobes.roughness * lobes.roughness);
    if (m.anisotropy > 0) {
        lobes.alpha_along = lobes.alpha + (1 - lobes.alpha) * static_cast<float>(m.anisotropy * m.anisotropy);
        lobes.roughness = std::sqrt(std::sqrt(lobes.alpha * lobes.alpha_along));
    }
    if (whole && lobes.alpha == whole->alpha && lobes.alpha_along == whole->alpha_along) {
        lobes.sums = whole->sums, lobes.rise = whole->rise, lobes.lean = whole->lean, lobes.rise_lean = whole->rise_lean;
    } else if (lobes.grained()) {
        const GrainSums facets = sums_of.with_grain(lobes.alpha_along, lobes.alpha);
        const CosineTable<float> rise = dielectric_rise(ior);
        lobes.sums = facets.mean.sums, lobes.rise = reflectance(facets.mean.shares, rise);
        lobes.lean = facets.lean.sums, lobes.rise_lean = reflectance(facets.lean.shares, rise);
    } else {
        const FacetsAndLayer facets = sums_of.with_layer(lobes.alpha, ior);
        lobes.sums = facets.sums, lobes.rise = facets.rise;
    }
    if (m.iridescence > 0) {
        lobes.film = static_cast<float>(m.iridescence), lobes.film_ior = static_cast<float>(m.iridescence_ior), lobes.film_thickness = static_cast<float>(m.iridescence_thickness);
        lobes.film_f0 = mix(layer_f0, metal_f0, metallic);
    }
    const UnderFilm film = lobes.film > 0 ? under_film(lobes) : UnderFilm{};
    if (!is_black(m.sheen_color)) {
        lobes.sheen = m.sheen_color * opacity;
        lobes.sheen_most = max_component(lobes.sheen);
        lobes.sheen_alpha = std::max(least_sheen_alpha, static_cast<float>(m.sheen_roughness * m.sheen_roughness));
        const bool same = whole && whole->has_sheen() && lobes.sheen_alpha == whole->sheen_alpha;
        lobes.sheen_sums = same ? whole->sheen_sums : sums_of.of_sheen(lobes.sheen_alpha);
    }
    if (conductor) lobes.eta = m.eta, lobes.k = m.k, lobes.conductor_f0 = metal_f0, lobes.conductor = metallic * opacity;
    if (m.clearcoat > 0) {
        lobes.coat = static_cast<float>(m.clearcoat) * opacity;
        lobes.coat_alpha = std::max(smoothest_alpha, static_cast<float>(m.clearcoat_roughness * m.clearcoat_roughness));
        lobes.coat_mirror_share = mirror_share_of(m.clearcoat_roughness);
        const bool same = whole && whole->coat > 0 && lobes.coat_alpha == whole->coat_alpha;
        lobes.coat_sums = same ? whole->coat_sums : coat_reflectances(sums_of(lobes.coat_alpha).shares);
    }
    lobes.highlight = f0;
    lobes.highlight_lobe = HighlightLobe::ggx;
    if (transmission > 0) {
        lobes.fresnel = Fresnel::dielectric;
        lobes.mirror = gray(dielectric * opacity);
        lobes.mirror_share = 1;
        lobes.refraction = m.base_color * (transmission * opacity);
        lobes.straight = gray(1 - opacity);
        lobes.ior = m.ior;
        lobes.dispersion = static_cast<float>(m.dispersion);
        lobes.attenuation = m.attenuation;
        lobes.glass_f0 = layer_f0, lobes.glass_f90 = static_cast<float>(m.specular);
        lobes.tinted_glass = m.specular != 1 || m.specular_color != Rgb{1, 1, 1} || lobes.film > 0;
        if (lobes.smooth() || lobes.tinted_glass || lobes.grained()) lobes.glass = {};  // what these lose is not given back
        else if (!whole) lobes.glass = rough_glass(lobes.alpha, m.ior);
        else if (whole->alpha == lobes.alpha && whole->ior == lobes.ior) lobes.glass = whole->glass;
    } else {
        lobes.fresnel = Fresnel::facets;
        lobes.mirror_share = mirror_share_of(lobes.roughness);
        if (lobes.mirror_share > 0) lobes.mirror = f0;
        lobes.ambient_specular = 1;
        lobes.refraction = gray(1 - opacity);
        lobes.one_sided = !m.double_sided;
    }
    if (metallic > 0) {
        const Rgb bare = conductor ? mean_fresnel_conductor(m.eta, m.k) : mean_schlick(m.base_color);
        set_multiple(lobes, mix(bare, film.mean, lobes.film), whole);
    }
    const bool film_matters = lobes.film > 0 && !is_black(lobes.diffuse);
    set_layer(lobes, film_matters ? reflectance(lobes.grained() ? sums_of.with_grain(lobes.alpha_along, lobes.alpha).mean.shares : sums_of(lobes.alpha).shares, film.most) : CosineTable<float>{});
    // Light through a pane loses about one Fresnel reflection at each crossing.
    lobes.shadow_filter = m.base_color * (transmission * opacity * static_cast<float>(1 - r0 * r0)) + gray(1 - opacity);
    return lobes;
}

}  // namespace

RoughnessTable::RoughnessTable(double ior) : ior_(ior) {
    const CosineTable<float> rise = dielectric_rise(ior);
    for (const FacetSums& facets : facet_sums_by_roughness()) rows_.push_back(facets_and_layer(facets, rise));
}

FacetsAndLayer RoughnessTable::at(double alpha) const { return row_at(rows_, std::sqrt(std::clamp(alpha, 0.0, 1.0))); }

double layer_ior(const scene::PhysicalMaterial& material) {
    // Of an infinite index the rise to grazing angles is nothing that an index says: as that of glass, which is near to Schlick's approximation.
    constexpr double schlick_ior = 1.5;
    return material.ior == 0 ? schlick_ior : material.ior;
}

std::vector<Lobes> compile(std::span<const scene::Material> materials) {
    struct {
        std::map<float, FacetSums> known;  // by alpha: many materials have the same
        const FacetSums& operator()(float alpha) {
            const auto [sums, unknown] = known.try_emplace(alpha);
            if (unknown) sums->second = alpha <= smoothest_alpha ? smooth_facet_sums() : facet_sums(alpha);
            return sums->second;
        }
        FacetsAndLayer with_layer(float alpha, double ior) { return facets_and_layer((*this)(alpha), dielectric_rise(ior)); }
        static GrainSums with_grain(float along, float across) { return grain_sums(along, across); }
        static SheenSums of_sheen(float alpha) { return sheen_sums(alpha); }
    } sums_of;
    std::vector<Lobes> all;
    for (const scene::Material& material : materials) {
        const auto* classic = std::get_if<scene::ClassicMaterial>(&material.model);
        all.push_back(classic ? compile_classic(*classic) : compile_physical(std::get<scene::PhysicalMaterial>(material.model), sums_of, nullptr));
    }
    return all;
}

Lobes compile(const scene::Material& material, const Lobes& whole, const RoughnessTable* table) {
    if (const auto* classic = std::get_if<scene::ClassicMaterial>(&material.model)) return compile_classic(*classic);
    struct {
        const RoughnessTable* table;
        FacetSums operator()(float alpha) const { return alpha <= smoothest_alpha ? smooth_facet_sums() : tabled_facet_sums(alpha); }
        FacetsAndLayer with_layer(float alpha, double ior) const {
            return table && table->ior() == ior && alpha > smoothest_alpha ? table->at(alpha) : facets_and_layer((*this)(alpha), dielectric_rise(ior));
        }
        static GrainSums with_grain(float along, float across) { return tabled_grain_sums(along, across); }
        static SheenSums of_sheen(float alpha) { return tabled_sheen_sums(alpha); }
    } sums_of{table};
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
    const double n_v = dot(normal, to_viewer), v_l = dot(to_viewer, to_light);
    double radiance[3];
    reflect_classic(classic_view(lobes), cosine, lobes.highlight_lobe == HighlightLobe::blinn ? blinn_cosine(cosine, n_v, v_l) : phong_cosine(cosine, n_v, v_l), with_highlight, radiance);
    return {static_cast<float>(radiance[0]), static_cast<float>(radiance[1]), static_cast<float>(radiance[2])};
}

double coat_reflectance(const Lobes& lobes, double cosine) {
    return lobes.coat > 0 ? lobes.coat * double{at_cosine(lobes.coat_sums, cosine)} : 0;
}

double sheen_reflectance(const Lobes& lobes, double cosine) {
    return lobes.has_sheen() ? lobes.sheen_most * std::min(1.0, double{at_cosine(lobes.sheen_sums, cosine)}) : 0;
}

namespace {

Rgb not_less_than_black(Rgb c) { return {std::max(c.r, 0.0f), std::max(c.g, 0.0f), std::max(c.b, 0.0f)}; }

// Without a film, and with metals as their color says. Of an index over 2 + sqrt(3) and less f0 than it says, the sum may be less than nothing.
Rgb bare_facet(const Lobes& lobes, double cosine) {
    const Rgb f0 = lobes.highlight - lobes.metal;
    const Rgb layer = f0 + (gray(lobes.coverage - lobes.metal_share) - f0) * static_cast<float>(fresnel_rise(lobes.layer_ior).at(cosine));
    return not_less_than_black(schlick(lobes.metal, lobes.metal_share, cosine) + layer);
}

}  // namespace

Rgb beyond_tables(const Lobes& lobes, double cosine) {
    Rgb more;
    if (lobes.conductor > 0) more = (fresnel_conductor(cosine, lobes.eta, lobes.k) - schlick(lobes.conductor_f0, 1, cosine)) * lobes.conductor;
    if (lobes.film > 0 && !lobes.transmits()) {
        const Rgb under_film = thin_film_reflectance(cosine, lobes.film_ior, lobes.film_thickness, lobes.film_f0) * lobes.opacity;
        more += (under_film - (bare_facet(lobes, cosine) + more)) * lobes.film;
    }
    return more;
}

Rgb facet_reflectance(const Lobes& lobes, double cosine) {
    const Rgb bare = bare_facet(lobes, cosine);
    return lobes.conductor > 0 || lobes.film > 0 ? not_less_than_black(bare + beyond_tables(lobes, cosine)) : bare;
}

Rgb tabled_reflectance(const Lobes& lobes, double cosine) {
    const SplitSum sum = at_cosine(lobes.sums, cosine);
    const float rise = at_cosine(lobes.rise, cosine);
    const Rgb f0 = lobes.highlight - lobes.metal;
    return not_less_than_black(lobes.metal * sum.scale + f0 * (sum.whole() - rise) + gray(lobes.metal_share * sum.bias + (lobes.coverage - lobes.metal_share) * rise));
}

Interface glass_interface(const Lobes& lobes, double cosine, double eta) {
    const double fresnel = fresnel_dielectric(cosine, eta);
    if (!lobes.tinted_glass || fresnel >= 1) return {gray(static_cast<float>(fresnel)), static_cast<float>(1 - fresnel)};
    // The same seen from either side, so that as much light passes in one direction as in the other.
    const double r = (lobes.ior - 1) / (lobes.ior + 1), r0 = r * r;
    Rgb reflected = lobes.glass_f0 + (gray(lobes.glass_f90) - lobes.glass_f0) * static_cast<float>((fresnel - r0) / (1 - r0));
    if (lobes.film > 0) {
        const double outside = eta >= 1 ? cosine : std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
        reflected = mix(reflected, thin_film_reflectance(outside, lobes.film_ior, lobes.film_thickness, lobes.glass_f0), lobes.film);
    }
    return {reflected, std::max(0.0f, 1 - max_component(reflected))};
}

float layer_mirrors(const Lobes& lobes, double cosine, bool inside) {
    if (lobes.fresnel == Fresnel::dielectric) return max_component(glass_interface(lobes, cosine, inside ? 1 / lobes.ior : lobes.ior).reflected);
    const float bare = between(lobes.layer_f0, lobes.layer_f90, std::max(0.0f, static_cast<float>(fresnel_rise(lobes.layer_ior).at(cosine))));
    return lobes.film > 0 ? between(bare, max_component(thin_film_reflectance(cosine, lobes.film_ior, lobes.film_thickness, lobes.film_f0)), lobes.film) : bare;
}

bool send_same_rays(const Lobes& a, const Lobes& b) {
    return a.mirror == b.mirror && a.refraction == b.refraction && a.straight == b.straight && a.ior == b.ior && a.fresnel == b.fresnel &&
           a.metal == b.metal && a.metal_share == b.metal_share && a.coverage == b.coverage && a.layer_ior == b.layer_ior && a.mirror_share == b.mirror_share &&
           a.eta == b.eta && a.k == b.k && a.conductor == b.conductor && a.coat == b.coat && a.coat_alpha == b.coat_alpha && a.sheen_most == b.sheen_most &&
           a.sheen_alpha == b.sheen_alpha && a.film == b.film && a.film_ior == b.film_ior && a.film_thickness == b.film_thickness && a.film_f0 == b.film_f0 &&
           a.glass_f0 == b.glass_f0 && a.glass_f90 == b.glass_f90 && a.dispersion == b.dispersion;
}

ChildWeights child_weights(const Lobes& lobes, double cosine, double coat_cosine, bool inside) {
    ChildWeights weights{lobes.mirror, lobes.refraction};
    const double eta = inside ? 1 / lobes.ior : lobes.ior;
    switch (lobes.fresnel) {
        case Fresnel::none:
            if (lobes.refracts() && (1 - cosine * cosine) >= eta * eta) {  // total internal reflection: all goes back
                weights = {lobes.mirror + lobes.refraction, {}};
            }
            break;
        case Fresnel::dielectric: {
            const Interface facet = glass_interface(lobes, cosine, eta);
            weights = {lobes.mirror * facet.reflected, lobes.refraction * facet.through};
            if (lobes.metal_share > 0) weights.reflected += schlick(lobes.metal, lobes.metal_share, cosine) + beyond_tables(lobes, cosine);
            break;
        }
        case Fresnel::facets:
            if (!is_black(lobes.mirror)) weights.reflected = facet_reflectance(lobes, cosine) * lobes.mirror_share;
            break;
    }
    if (lobes.has_sheen() && !inside) {
        const auto below = static_cast<float>(1 - sheen_reflectance(lobes, cosine));
        weights = {weights.reflected * below, weights.refracted * below};
    }
    if (lobes.coat > 0 && !inside) {
        const auto below = static_cast<float>(1 - coat_reflectance(lobes, coat_cosine));
        weights = {weights.reflected * below + gray(static_cast<float>(fresnel_dielectric(coat_cosine, coat_ior)) * lobes.coat * lobes.coat_mirror_share), weights.refracted * below};
    }
    return weights;
}

}  // namespace crescente::render
