#include "render/scattering.h"

#include "render/physical_view.h"
#include "render/sheen.h"

namespace crescente::render {
namespace {

double mean(Rgb c) { return (double(c.r) + c.g + c.b) / 3; }

double power(double base, double exponent) { return exponent == 0 ? 1 : std::pow(std::max(0.0, base), exponent); }

}  // namespace

Scattering::Scattering(const Lobes& lobes, const Facing& facing, Vec3 to_viewer, SmoothAs smooth_as)
    : lobes_(lobes), facing_(facing), viewer_(to_viewer), eta_(facing.inside ? 1 / lobes.ior : lobes.ior), side_(facing.inside), smooth_(smooth_facets(lobes)), facets_{lobes.alpha_along, lobes.alpha}, coat_facets_{lobes.coat_alpha, lobes.coat_alpha} {
    const Vec3 along = lobes.tangent - facing.shading * dot(lobes.tangent, facing.shading);
    const double size = length(along);
    const Vec3 tangent = size > 1e-9 ? along / size : perpendicular(facing.shading);
    frame_ = {tangent, cross(facing.shading, tangent), facing.shading};
    v_ = local(to_viewer);
    if (!seen()) return;
    v_.z = std::min(v_.z, 1.0);
    coat_frame_ = frame_, coat_v_ = v_;
    if (lobes.coat_normal != Vec3{}) {
        const Vec3 any = perpendicular(lobes.coat_normal);
        coat_frame_ = {any, cross(lobes.coat_normal, any), lobes.coat_normal};
        coat_v_ = coat_frame_.local(to_viewer);
        coat_v_.z = std::clamp(coat_v_.z, 1e-4, 1.0);
    }
    mirror_base_ = lobes.smooth() && smooth_as != SmoothAs::highlights;
    mirror_coat_ = lobes.coat_is_smooth() && smooth_as != SmoothAs::highlights;
    rays_ = smooth_weights(lobes, v_.z, coat_v_.z, facing.inside);

    double weights[lobe_count] = {};
    weights[diffuse] = lobes.layered() ? mean(lobes.diffuse) * pi * (1 - layer_over_diffuse(v_)) : mean(lobes.diffuse);
    if (lobes.layered() && !mirror_base_) {
        weights[multiple] = mean(lobes.multiple) * missing(v_);
        weights[rough] = mean(tabled_reflectance(lobes, v_.z)) + (lobes.film > 0 ? lobes.film * mean(facet_reflectance(lobes, v_.z)) : 0);
    }
    if (lobes.transmits() && !mirror_base_) {
        const FacetColors f = facet(v_.z);
        weights[rough] = mean(f.reflected) + mean(f.transmitted);
        if (!smooth_.refracts) {
            const double missing = missing_in_glass(v_.z, side_), crosses = lobes.glass.through[side_];
            weights[glass_multiple] = mean(lobes.mirror) * missing * (1 - crosses);
            weights[through] = mean(lobes.refraction) * missing * crosses;
        }
    }
    if (lobes.has_sheen() && !facing.inside) {
        const double kept = sheen_reflectance(lobes, v_.z);
        for (double& weight : weights) weight *= 1 - kept;
        weights[fibres] = kept;
    }
    if (lobes.coat > 0 && !facing.inside) {
        const double kept = coat_reflectance(lobes, coat_v_.z);
        for (double& weight : weights) weight *= 1 - kept;
        if (!mirror_coat_) weights[coated] = kept;
    }
    if (!lobes.layered() && lobes.highlight_lobe != HighlightLobe::none) {
        const double most = lobes.highlight_lobe == HighlightLobe::phong ? 2 : 8;
        weights[highlight] = mean(lobes.highlight) * std::min(1.0, most / (lobes.exponent + 1));
    }
    if (smooth_as == SmoothAs::nothing && disperses(lobes)) weights[refraction] = mean(rays_.refracted);
    if (smooth_as == SmoothAs::rays) weights[mirror] = mean(rays_.reflected), weights[refraction] = mean(rays_.refracted), weights[straight] = mean(lobes.straight);
    double sum = 0;
    for (const double w : weights) sum += w;
    for (int i = 0; sum > 0 && i < lobe_count; ++i) chances_[i] = weights[i] / sum;
}

Scattering::FacetColors Scattering::facet(double cosine) const {
    FacetColors f;
    if (lobes_.transmits()) {
        const Interface glass = glass_interface(lobes_, cosine, eta_);
        f.reflected = lobes_.mirror * glass.reflected + schlick(lobes_.metal, lobes_.metal_share, cosine) + beyond_tables(lobes_, cosine);
        if (!smooth_.refracts) f.transmitted = lobes_.refraction * glass.through;
    } else {
        f.reflected = facet_reflectance(lobes_, cosine);
    }
    const double r = mean(f.reflected), t = mean(f.transmitted);
    f.chance_reflected = t == 0 ? 1 : r / (r + t);
    return f;
}

// What of the light at this cosine does not reach the diffuse lobe, since it is reflected before.
double Scattering::layer_over_diffuse(Vec3 w) const {
    if (lobes_.transmits() && lobes_.glass.density[side_] == 0) return is_black(lobes_.diffuse) ? 0 : max_component(glass_interface(lobes_, std::min(w.z, 1.0), eta_).reflected);
    const double kept = layer_at(lobes_, w.z, side_).kept;
    return lobes_.grained() ? std::clamp(kept + at_cosine(lobes_.layer_lean, w.z) * along_grain(w), 0.0, 1.0) : kept;
}

// What coat and fibres leave of it before. All that reaches the diffuse lobe is coupled as reflect_physical has it, so that what is over it, one by one or together, takes what it reflects and no more.
double Scattering::above_layer(Vec3 w, double coat_cosine) const {
    return facing_.inside ? 1 : (1 - sheen_reflectance(lobes_, w.z)) * (1 - coat_reflectance(lobes_, coat_cosine));
}

double Scattering::missing(Vec3 w) const {
    if (gives_back_below()) return at_cosine(lobes_.lost_below, w.z);
    if (!lobes_.grained()) return layer_at(lobes_, w.z).missing;
    return (at_cosine(lobes_.sums, w.z) + at_cosine(lobes_.lean, w.z) * static_cast<float>(along_grain(w))).missing();
}

// Cosine of twice the angle that a direction makes with the grain.
double Scattering::along_grain(Vec3 w) const {
    const double x2 = w.x * w.x, y2 = w.y * w.y;
    return x2 + y2 > 0 ? (x2 - y2) / (x2 + y2) : 0;
}

double Scattering::missing_in_glass(double cosine, std::size_t side) const {
    if (lobes_.glass.density[side] == 0) return 0;
    return at_cosine(lobes_.glass.sums[side], cosine).missing();
}

// Classic strengths are meant for sharp highlights: a broad one is kept from giving back more than its strength.
double Scattering::highlight_scale() const {
    const double most = lobes_.highlight_lobe == HighlightLobe::phong ? 2 : 8;
    return std::min(1.0, (lobes_.exponent + 1) / most) / pi;
}

Scattered Scattering::toward(Vec3 to_light) const {
    Scattered sum;
    if (!seen()) return sum;
    const bool crosses = dot(facing_.shading, to_light) < 0;
    if (!allows(to_light, crosses)) return sum;
    const Vec3 l = local(to_light);
    if (!crosses) add_diffuse(l, to_light, sum), add_highlight(l, sum);
    add_facets(l, sum);
    if (!gives_back_below()) add_multiple(l, sum);
    if (lobes_.has_sheen()) under_sheen(l, sum);
    if (lobes_.coat > 0) under_coat(l, to_light, sum);
    if (gives_back_below()) add_multiple(l, sum);
    return sum;
}

void Scattering::add_diffuse(Vec3 l, Vec3 to_light, Scattered& sum) const {
    if (chances_[diffuse] == 0 || l.z <= 0) return;
    sum.pdf += chances_[diffuse] * l.z / pi;
    if (!lobes_.layered()) {
        sum.diffuse = lobes_.diffuse * static_cast<float>(l.z / pi);
        return;
    }
    const double reaches = (1 - layer_over_diffuse(v_)) * above_layer(v_, coat_v_.z) * (1 - layer_over_diffuse(l)) * above_layer(l, coat_cosine(lobes_, to_light, l.z));
    sum.diffuse = lobes_.diffuse * static_cast<float>(reaches * lobes_.layer_gives_back[side_] * l.z);
}

void Scattering::add_facets(Vec3 l, Scattered& sum) const {
    if (chances_[rough] == 0 || l.z == 0) return;
    if (l.z > 0) {
        const Vec3 h = normalize(v_ + l);
        const double v_h = std::clamp(dot(v_, h), 0.0, 1.0);
        if (v_h == 0) return;
        const FacetColors f = facet(v_h);
        sum.glossy += f.reflected * static_cast<float>(facets_.density(h) * facets_.seen_by_both(v_, l) / (4 * v_.z));
        sum.pdf += chances_[rough] * f.chance_reflected * facets_.density_seen(v_, h) / (4 * v_h);
    } else if (lobes_.transmits() && !smooth_.refracts && lobes_.refracts()) {
        // Walter et al. 2007, section 5.3; the factor of the square of the index is left out.
        Vec3 h = normalize(v_ + l * eta_);
        if (h.z < 0) h = -h;
        const double v_h = std::min(dot(v_, h), 1.0), l_h = dot(l, h);
        if (v_h <= 0 || l_h >= 0) return;
        const FacetColors f = facet(v_h);
        const double root = v_h + eta_ * l_h, widening = eta_ * eta_ * -l_h / (root * root);
        sum.glossy += f.transmitted * static_cast<float>(facets_.density(h) * facets_.seen_by_both(v_, l) * v_h * widening / v_.z);
        sum.pdf += chances_[rough] * (1 - f.chance_reflected) * facets_.density_seen(v_, h) * widening;
    }
}

void Scattering::add_multiple(Vec3 l, Scattered& sum) const {
    const double cosine = l.z;
    const RoughGlass& glass = lobes_.glass;
    if (cosine > 0 && chances_[multiple] > 0) {
        sum.glossy += lobes_.multiple * static_cast<float>(missing(v_) * missing(l) * (gives_back_below() ? lobes_.lost_density : lobes_.multiple_density) * cosine);
        sum.pdf += chances_[multiple] * density_of_cosine(cells_of_multiple(), cosine);
    }
    if (cosine > 0 && chances_[glass_multiple] > 0) {
        const double stays = missing_in_glass(v_.z, side_) * missing_in_glass(cosine, side_) * glass.density[side_] * (1 - glass.through[side_]);
        sum.glossy += lobes_.mirror * static_cast<float>(stays * cosine);
        sum.pdf += chances_[glass_multiple] * density_of_cosine(glass.cells[side_], cosine);
    }
    if (cosine < 0 && chances_[through] > 0) {
        const std::size_t other = 1 - side_;
        const double crosses = missing_in_glass(v_.z, side_) * missing_in_glass(-cosine, other) * glass.density[other] * glass.through[side_];
        sum.glossy += lobes_.refraction * static_cast<float>(crosses * -cosine);
        sum.pdf += chances_[through] * density_of_cosine(glass.cells[other], -cosine);
    }
}

// The coat takes what it reflects from the facets below, and no more reaches these than that leaves, seen from either end; it adds its own reflection.
void Scattering::under_coat(Vec3 l, Vec3 to_light, Scattered& sum) const {
    const Vec3 coat_l = lobes_.coat_normal == Vec3{} ? l : coat_frame_.local(to_light);
    double kept = facing_.inside ? 0 : coat_reflectance(lobes_, coat_v_.z);
    if (facing_.inside == (l.z < 0)) kept = std::max(kept, coat_reflectance(lobes_, std::min(1.0, std::abs(coat_l.z))));
    const auto below = static_cast<float>(1 - kept);
    sum.glossy *= gray(below);
    if (chances_[coated] == 0 || l.z <= 0 || coat_l.z <= 0) return;
    const Vec3 h = normalize(coat_v_ + coat_l);
    const double v_h = std::clamp(dot(coat_v_, h), 1e-12, 1.0), lobe = coat_facets_.density(h) * coat_facets_.seen_by_both(coat_v_, coat_l) / (4 * coat_v_.z);
    sum.glossy += gray(static_cast<float>(fresnel_dielectric(v_h, coat_ior) * lobes_.coat * lobe));
    sum.pdf += chances_[coated] * coat_facets_.density_seen(coat_v_, h) / (4 * v_h);
}

// Likewise the fibres of cloth (albedo scaling, as KHR_materials_sheen has it). Their directions are drawn evenly.
void Scattering::under_sheen(Vec3 l, Scattered& sum) const {
    double kept = facing_.inside ? 0 : sheen_reflectance(lobes_, v_.z);
    if (facing_.inside == (l.z < 0)) kept = std::max(kept, sheen_reflectance(lobes_, std::min(1.0, std::abs(l.z))));
    const auto below = static_cast<float>(1 - kept);
    sum.glossy *= gray(below);
    if (chances_[fibres] == 0 || l.z <= 0) return;
    const double held = sheen_held(at_cosine(lobes_.sheen_sums, v_.z)) * sheen_held(at_cosine(lobes_.sheen_sums, l.z));
    const double n_h = (v_.z + l.z) / std::sqrt(std::max(1e-12, 2 + 2 * dot(v_, l)));
    sum.glossy += lobes_.sheen * static_cast<float>(held * sheen_reflected(lobes_.sheen_alpha, v_.z, l.z, std::min(1.0, n_h)));
    sum.pdf += chances_[fibres] / (2 * pi);
}

void Scattering::add_highlight(Vec3 l, Scattered& sum) const {
    if (chances_[highlight] == 0 || l.z <= 0) return;
    const double n = lobes_.exponent;
    if (lobes_.highlight_lobe == HighlightLobe::phong) {
        const double cosine = -v_.x * l.x - v_.y * l.y + v_.z * l.z;
        if (cosine <= 0) return;
        const double lobe = power(cosine, n);
        sum.glossy += lobes_.highlight * static_cast<float>(lobe * highlight_scale());
        sum.pdf += chances_[highlight] * (n + 1) / (2 * pi) * lobe;
    } else {
        const Vec3 h = normalize(v_ + l);
        const double lobe = power(h.z, n);
        sum.glossy += lobes_.highlight * static_cast<float>(lobe * highlight_scale());
        sum.pdf += chances_[highlight] * (n + 1) / (2 * pi) * lobe / (4 * std::max(1e-12, dot(v_, h)));
    }
}

// A direction drawn from a lobe that is not smooth, in the surface's frame, or that of its coat; u[0] is what the choice of the lobe left of it.
std::optional<Vec3> Scattering::draw(Lobe lobe, std::array<double, 3> u) const {
    const double phi = 2 * pi * u[1];
    const auto about_z = [phi](double z) {
        const double r = std::sqrt(std::max(0.0, 1 - z * z));
        return Vec3{r * std::cos(phi), r * std::sin(phi), z};
    };
    const auto mirrored_in = [](Vec3 v, Vec3 h) { return h * (2 * dot(v, h)) - v; };
    const auto above = [](Vec3 l) { return l.z > 0 ? std::optional(l) : std::nullopt; };
    if (lobe == diffuse) return about_z(std::sqrt(1 - u[2]));
    if (lobe == fibres) return about_z(1 - u[2]);
    if (lobe == multiple) return about_z(draw_cosine(cells_of_multiple(), u[2]));
    if (lobe == glass_multiple) return about_z(draw_cosine(lobes_.glass.cells[side_], u[2]));
    if (lobe == through) return -about_z(draw_cosine(lobes_.glass.cells[1 - side_], u[2]));
    if (lobe == highlight) {
        const Vec3 drawn = about_z(std::pow(1 - u[2], 1.0 / (lobes_.exponent + 1)));
        if (lobes_.highlight_lobe == HighlightLobe::blinn) return dot(v_, drawn) > 0 ? above(mirrored_in(v_, drawn)) : std::nullopt;
        const Vec3 axis{-v_.x, -v_.y, v_.z}, across = perpendicular(axis);
        return above(across * drawn.x + cross(axis, across) * drawn.y + axis * drawn.z);
    }
    if (lobe == coated) {
        const Vec3 h = coat_facets_.sample_seen(coat_v_, u[1], u[2]);
        return dot(coat_v_, h) > 0 ? above(mirrored_in(coat_v_, h)) : std::nullopt;
    }
    const Vec3 h = facets_.sample_seen(v_, u[1], u[2]);
    const double v_h = std::clamp(dot(v_, h), 0.0, 1.0);
    if (v_h == 0) return std::nullopt;
    // What ends on the other side than it should meets another facet: lost here, and given back by the lobes of multiple scattering.
    if (u[0] < facet(v_h).chance_reflected) return above(mirrored_in(v_, h));
    const double sin2 = (1 - v_h * v_h) / (eta_ * eta_);
    if (sin2 >= 1) return std::nullopt;
    const Vec3 l = h * (v_h / eta_ - std::sqrt(1 - sin2)) - v_ / eta_;
    return l.z < 0 ? std::optional(l) : std::nullopt;
}

std::optional<ScatterSample> Scattering::ray(Lobe lobe) const {
    ScatterSample s{{}, {}, Part::glossy, true, lobe != mirror};
    s.value.pdf = chances_[lobe];
    if (lobe == mirror) s.direction = mirrored_direction({mirror_normal(lobes_, facing_.shading), facing_.geometric, facing_.inside}, viewer_), s.value.glossy = rays_.reflected;
    if (lobe == refraction) s.direction = refracted_direction(facing_, viewer_, 1 / eta_), s.value.glossy = rays_.refracted;
    if (lobe == straight) s.direction = -viewer_, s.value.glossy = lobes_.straight;
    return s;
}

std::optional<ScatterSample> Scattering::sample(std::array<double, 3> u) const {
    if (!seen()) return std::nullopt;
    int chosen = 0, last = -1;
    for (int i = 0; i < lobe_count; ++i) {
        if (chances_[i] > 0) last = i;
    }
    if (last < 0) return std::nullopt;
    for (; chosen < last && u[0] >= chances_[chosen]; ++chosen) u[0] -= chances_[chosen];
    u[0] = std::min(u[0] / chances_[chosen], 1 - 0x1p-53);
    const Lobe lobe{static_cast<std::uint8_t>(chosen)};
    if (lobe >= mirror) return ray(lobe);

    const auto l = draw(lobe, u);
    if (!l) return std::nullopt;
    const Vec3 direction = normalize((lobe == coated ? coat_frame_ : frame_).world(*l));
    ScatterSample s{direction, {}, lobe == diffuse ? Part::diffuse : Part::glossy, false, l->z < 0};
    if (!allows(s.direction, s.crosses)) return std::nullopt;
    s.value = toward(s.direction);
    if (s.value.pdf <= 0 || (is_black(s.value.diffuse) && is_black(s.value.glossy))) return std::nullopt;
    return s;
}

}  // namespace crescente::render
