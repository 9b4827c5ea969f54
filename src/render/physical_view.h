// What a physical material sends to one viewer of the light that comes from elsewhere: prepared once for any number of lights, for one surface point
// (T = double) or eight (T = Lanes), to the same bits. Materials: glTF 2.0, appendix B.
#pragma once

#include <algorithm>

#include "math/vec_lanes.h"
#include "render/lobes.h"

namespace crescente::render {

// LayerShare of light at one cosine to the normal.
template <class T>
struct LayerAt {
    T kept, missing;
};

// side: of the body that the light comes from, outer or inner.
inline LayerAt<double> layer_at(const Lobes& lobes, double cosine, std::size_t side = 0) {
    const LayerShare share = at_cosine(lobes.layer[side], cosine);
    return {share.kept, share.missing};
}

// The same for eight points from outside, each of its own lobes, to the bit. 0 in lanes whose bit is not set.
inline LayerAt<Lanes> layer_at(const Lobes* const (&lobes)[lane_count], unsigned lanes, const Lanes& cosine) {
    const Lanes zero{}, one = zero + 1.0;
    const Lanes place = last_cosine * square_root(lesser(greater(cosine, zero), one));
    Lanes first{};
    FloatLanes kept[2]{}, missing[2]{};
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        const auto i = std::min(static_cast<int>(place[lane]), static_cast<int>(last_cosine) - 1);
        const LayerShare* share = lobes[lane]->layer[0].data() + i;
        first[lane] = i;
        for (int k = 0; k < 2; ++k) kept[k][lane] = share[k].kept, missing[k][lane] = share[k].missing;
    }
    const FloatLanes t = to_floats(place - first);
    return {blend(lanes, to_doubles(kept[0] + (kept[1] - kept[0]) * t), zero), blend(lanes, to_doubles(missing[0] + (missing[1] - missing[0]) * t), zero)};
}

template <class T>
struct PhysicalView {
    T facing;          // cosine between normal and viewer
    T n_v;             // the same, kept off 0
    T alpha2, smith;   // of ggx; its root for the viewer's side
    FresnelRise<T> rise;  // of the dielectric's facets
    T missing;            // of LayerShare towards the viewer; 0 where it does not matter
    T diffuse[3];         // radiance per unit of irradiance that reaches the diffuse lobe
    T highlight[3], metal_rises[3], layer_rises[3];  // what a facet reflects: straight on, and by how much of each it is more at grazing angles
    T multiple[3];  // radiance per unit of what is missing towards both viewer and light
};

// Whether layer_at of the light's direction matters.
inline bool asks_for_layer(const Lobes& lobes) { return !is_black(lobes.diffuse) || !is_black(lobes.multiple); }

// The values of one point; facing: cosine between the shading normal and the viewer.
inline PhysicalView<double> physical_view(const Lobes& lobes, double facing) {
    const double n_v = std::clamp(facing, 1e-4, 1.0), alpha2 = double(lobes.alpha) * lobes.alpha;
    PhysicalView<double> view{facing, n_v, alpha2, std::sqrt(n_v * n_v * (1 - alpha2) + alpha2), fresnel_rise(lobes.layer_ior), {}, {}, {}, {}, {}, {}};
    for (int k = 0; k < 3; ++k) {
        view.highlight[k] = lobes.highlight[k], view.metal_rises[k] = double(lobes.metal_share) - lobes.metal[k];
        view.layer_rises[k] = double(lobes.coverage) - lobes.metal_share - (double(lobes.highlight[k]) - lobes.metal[k]);
    }
    if (!asks_for_layer(lobes)) return view;
    const LayerAt<double> layer = layer_at(lobes, n_v);
    view.missing = layer.missing;
    for (int k = 0; k < 3; ++k) view.diffuse[k] = lobes.diffuse[k] * (1 - layer.kept) * lobes.layer_gives_back[0], view.multiple[k] = lobes.multiple[k] * lobes.multiple_density;
    return view;
}

inline void set_lane(PhysicalView<Lanes>& view, int i, const PhysicalView<double>& one) {
    view.facing[i] = one.facing, view.n_v[i] = one.n_v, view.alpha2[i] = one.alpha2, view.smith[i] = one.smith, view.missing[i] = one.missing;
    view.rise.eta2[i] = one.rise.eta2, view.rise.scale[i] = one.rise.scale, view.rise.base[i] = one.rise.base;
    for (int k = 0; k < 3; ++k) {
        view.diffuse[k][i] = one.diffuse[k], view.multiple[k][i] = one.multiple[k];
        view.highlight[k][i] = one.highlight[k], view.metal_rises[k][i] = one.metal_rises[k], view.layer_rises[k][i] = one.layer_rises[k];
    }
}

// Radiance per unit of strength of light whose direction makes `cosine` > 0 with the normal and `between` with the viewer's; light: layer_at that
// cosine.
//
// Of light that meets the dielectric's layer at an angle, the diffuse lobe gets what the layer does not reflect, 1 - E(l); of what it sends to an angle, 1 - E(v) leaves; what does not comes back to it, until all
// has left: over the mean of 1 - E (Ashikhmin, Premoze and Shirley 2000, "A Microfacet-based BRDF Generator"; Kelemen and Szirmay-Kalos 2001, "A Microfacet Based Coupled Specular-Matte BRDF Model"). So as
// much is given back as the layer leaves, and f is the same both ways. (glTF's example, 1 - F at the half vector, gives back up to 1.3 times the light at grazing angles.) The highlight: Trowbridge-Reitz
// distribution with the height-correlated Smith term (Walter et al. 2007; Heitz 2014), facets as facet_reflectance has them without a film or a complex index. What the lobe of a metal loses between facets
// comes back from all over (Kulla and Conty 2017).
template <class T>
void reflect_physical(const PhysicalView<T>& view, const T& cosine, const T& between, const LayerAt<T>& light, bool with_highlight, T (&radiance)[3]) {
    const T one = T{} + 1.0, zero{};
    const T reaches = cosine * (1.0 - light.kept);
    for (int k = 0; k < 3; ++k) radiance[k] = view.diffuse[k] * reaches;
    if (!with_highlight) return;
    // Cosines of the half vector, without computing it: the sum of two unit vectors is twice as long as its projection on either.
    const T v_h = square_root(lesser(greater(0.5 + 0.5 * between, zero + 1e-12), one));
    const T rise = view.rise.at(v_h), grazing = fifth_power(1.0 - v_h);
    const T n_h = lesser(greater((view.facing + cosine) / (2.0 * v_h), zero), one);
    const T d = n_h * n_h * (view.alpha2 - 1.0) + 1.0;
    const T smith = cosine * view.smith + view.n_v * square_root(cosine * cosine * (1.0 - view.alpha2) + view.alpha2);
    const T lobe = view.alpha2 * cosine / (2.0 * pi * d * d * greater(smith, zero + 1e-9));
    const T missing = view.missing * light.missing * cosine;
    for (int k = 0; k < 3; ++k) radiance[k] = radiance[k] + greater(zero, view.highlight[k] + view.metal_rises[k] * grazing + view.layer_rises[k] * rise) * lobe + view.multiple[k] * missing;
}

}  // namespace crescente::render
