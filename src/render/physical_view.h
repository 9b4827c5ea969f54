// What a physical material sends to one viewer of the light that comes from elsewhere: prepared once for any number of lights, for one surface point
// (T = double) or eight (T = Lanes), to the same bits. Materials: glTF 2.0, appendix B.
#pragma once

#include <algorithm>

#include "math/vec_lanes.h"
#include "render/lobes.h"

namespace crescente::render {

// What the whole ggx lobe does to light at one cosine to the normal.
template <class T>
struct LayerAt {
    T kept;     // reflected by the layer over the diffuse lobe
    T missing;  // lost between facets, if these reflected all
};

inline LayerAt<double> layer_at(const Lobes& lobes, double cosine) {
    const SplitSum sum = split_sum(lobes.sums, cosine);
    return {double(sum.scale) * lobes.layer_f0 + double(sum.bias) * lobes.layer_f90, sum.missing()};
}

// The same for eight points, each of its own lobes, to the bit. 0 in lanes whose bit is not set.
inline LayerAt<Lanes> layer_at(const Lobes* const (&lobes)[lane_count], unsigned lanes, const Lanes& layer_f0, const Lanes& layer_f90, const Lanes& cosine) {
    if (!lanes) return {Lanes{}, Lanes{}};
    const SplitSums* sums[lane_count] = {};
    for (unsigned rest = lanes; rest; rest &= rest - 1) sums[__builtin_ctz(rest)] = &lobes[__builtin_ctz(rest)]->sums;
    const SplitSumLanes sum = split_sum(sums, lanes, cosine);
    const Lanes scale = to_doubles(sum.scale), bias = to_doubles(sum.bias);
    return {blend(lanes, scale * layer_f0 + bias * layer_f90, Lanes{}), blend(lanes, greater(Lanes{}, 1.0 - scale - bias), Lanes{})};
}

template <class T>
struct PhysicalView {
    T facing;          // cosine between normal and viewer
    T n_v;             // the same, kept off 0
    T alpha2, smith;   // of ggx; its root for the viewer's side
    T layer_f0, layer_f90;  // of the diffuse lobe
    LayerAt<T> layer;  // towards the viewer; 0 where it does not matter
    T coverage;
    T diffuse[3], highlight[3];
    T multiple[3];  // radiance per unit of what is missing towards both viewer and light
};

// Whether layer_at of the light's direction matters.
inline bool asks_for_layer(const Lobes& lobes) { return !is_black(lobes.diffuse) || !is_black(lobes.multiple); }

// The values of one point; facing: cosine between the shading normal and the viewer.
inline PhysicalView<double> physical_view(const Lobes& lobes, double facing) {
    const double n_v = std::clamp(facing, 1e-4, 1.0), alpha2 = double(lobes.alpha) * lobes.alpha;
    PhysicalView<double> view{facing, n_v, alpha2, std::sqrt(n_v * n_v * (1 - alpha2) + alpha2), lobes.layer_f0, lobes.layer_f90, {}, lobes.coverage,
                              {lobes.diffuse.r, lobes.diffuse.g, lobes.diffuse.b}, {lobes.highlight.r, lobes.highlight.g, lobes.highlight.b}, {}};
    if (!asks_for_layer(lobes)) return view;
    view.layer = layer_at(lobes, n_v);
    for (int k = 0; k < 3; ++k) view.multiple[k] = lobes.multiple[k] * lobes.multiple_density;
    return view;
}

inline void set_lane(PhysicalView<Lanes>& view, int i, const PhysicalView<double>& one) {
    view.facing[i] = one.facing, view.n_v[i] = one.n_v, view.alpha2[i] = one.alpha2, view.smith[i] = one.smith, view.layer_f0[i] = one.layer_f0, view.layer_f90[i] = one.layer_f90;
    view.layer.kept[i] = one.layer.kept, view.layer.missing[i] = one.layer.missing, view.coverage[i] = one.coverage;
    for (int k = 0; k < 3; ++k) view.diffuse[k][i] = one.diffuse[k], view.highlight[k][i] = one.highlight[k], view.multiple[k][i] = one.multiple[k];
}

// Radiance per unit of strength of light whose direction makes `cosine` > 0 with the normal and `between` with the viewer's; light: layer_at that
// cosine.
//
// The dielectric's layer lets 1 - F through to the diffuse lobe, F taken at the half vector. That alone would give back up to 1.3 times the light at
// grazing angles, where the lobe reflects more than that F; so no more passes than the layer's whole reflectance leaves, seen from either end (as
// KHR_materials_sheen scales by albedo). The highlight: Trowbridge-Reitz distribution with the height-correlated Smith term (Walter et al. 2007; Heitz
// 2014), Fresnel's equations after Schlick (1994). What the lobe of a metal loses between facets comes back from all over
// (Kulla and Conty 2017).
template <class T>
void reflect_physical(const PhysicalView<T>& view, const T& cosine, const T& between, const LayerAt<T>& light, bool with_highlight, T (&radiance)[3]) {
    const T one = T{} + 1.0, zero{};
    // Cosines of the half vector, without computing it: the sum of two unit vectors is twice as long as its projection on either.
    const T v_h = square_root(lesser(greater(0.5 + 0.5 * between, zero + 1e-12), one));
    const T grazing = fifth_power(1.0 - v_h);
    const T fresnel = view.layer_f0 + (view.layer_f90 - view.layer_f0) * grazing;
    const T passes = cosine * (1.0 - greater(fresnel, greater(view.layer.kept, light.kept)));
    for (int k = 0; k < 3; ++k) radiance[k] = view.diffuse[k] * passes;
    if (!with_highlight) return;
    const T n_h = lesser(greater((view.facing + cosine) / (2.0 * v_h), zero), one);
    const T d = n_h * n_h * (view.alpha2 - 1.0) + 1.0;
    const T smith = cosine * view.smith + view.n_v * square_root(cosine * cosine * (1.0 - view.alpha2) + view.alpha2);
    const T lobe = view.alpha2 * cosine / (2.0 * pi * d * d * greater(smith, zero + 1e-9));
    const T missing = view.layer.missing * light.missing * cosine;
    for (int k = 0; k < 3; ++k) radiance[k] = radiance[k] + (view.highlight[k] + (view.coverage - view.highlight[k]) * grazing) * lobe + view.multiple[k] * missing;
}

}  // namespace crescente::render
