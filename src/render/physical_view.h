// What a physical material sends to one viewer of the light that comes from elsewhere: prepared once for any number of lights, for one surface point
// (T = double) or eight (T = Lanes), to the same bits. Materials: glTF 2.0, appendix B.
#pragma once

#include <algorithm>

#include "math/vec_lanes.h"
#include "render/lobes.h"

namespace crescente::render {

// Share of light that the layer over the diffuse lobe reflects in all, at a cosine from 0 to 1.
inline double layer_reflectance(const Lobes& lobes, double cosine) {
    const SplitSum sum = split_sum(lobes.sums, cosine);
    return double(sum.scale) * lobes.layer_f0 + sum.bias;
}

// The same for eight points, each of its own lobes, to the bit. Lanes whose bit is not set have any value.
inline Lanes layer_reflectance(const Lobes* const (&lobes)[lane_count], unsigned lanes, const Lanes& layer_f0, const Lanes& cosine) {
    const SplitSums* sums[lane_count] = {};
    for (unsigned rest = lanes; rest; rest &= rest - 1) sums[__builtin_ctz(rest)] = &lobes[__builtin_ctz(rest)]->sums;
    const SplitSumLanes sum = split_sum(sums, lanes, cosine);
    return to_doubles(sum.scale) * layer_f0 + to_doubles(sum.bias);
}

template <class T>
struct PhysicalView {
    T facing;          // cosine between normal and viewer
    T n_v;             // the same, kept off 0
    T alpha2, smith;   // of ggx; its root for the viewer's side
    T layer_f0, layer_kept;  // of the diffuse lobe; what the layer reflects in all towards the viewer
    T coverage;
    T diffuse[3], highlight[3];
};

// The values of one point; facing: cosine between the shading normal and the viewer.
inline PhysicalView<double> physical_view(const Lobes& lobes, double facing) {
    const double n_v = std::clamp(facing, 1e-4, 1.0), alpha2 = double(lobes.alpha) * lobes.alpha;
    const bool has_diffuse = !is_black(lobes.diffuse);
    return {facing, n_v, alpha2, std::sqrt(n_v * n_v * (1 - alpha2) + alpha2), lobes.layer_f0, has_diffuse ? layer_reflectance(lobes, n_v) : 0, lobes.coverage,
            {lobes.diffuse.r, lobes.diffuse.g, lobes.diffuse.b}, {lobes.highlight.r, lobes.highlight.g, lobes.highlight.b}};
}

inline void set_lane(PhysicalView<Lanes>& view, int i, const PhysicalView<double>& one) {
    view.facing[i] = one.facing, view.n_v[i] = one.n_v, view.alpha2[i] = one.alpha2, view.smith[i] = one.smith, view.layer_f0[i] = one.layer_f0;
    view.layer_kept[i] = one.layer_kept, view.coverage[i] = one.coverage;
    for (int k = 0; k < 3; ++k) view.diffuse[k][i] = one.diffuse[k], view.highlight[k][i] = one.highlight[k];
}

template <class T>
T fifth_power(const T& m) { return m * m * m * m * m; }

// Radiance per unit of strength of light whose direction makes `cosine` > 0 with the normal and `between` with the viewer's; layer_kept: layer_reflectance
// at that cosine.
//
// The dielectric's layer lets 1 - F through to the diffuse lobe, F taken at the half vector. That alone would give back up to 1.3 times the light at
// grazing angles, where the lobe reflects more than that F; so no more passes than the layer's whole reflectance leaves, seen from either end (as
// KHR_materials_sheen scales by albedo). The highlight: Trowbridge-Reitz distribution with the height-correlated Smith term (Walter et al. 2007; Heitz
// 2014), Fresnel's equations after Schlick (1994).
template <class T>
void reflect_physical(const PhysicalView<T>& view, const T& cosine, const T& between, const T& layer_kept, bool with_highlight, T (&radiance)[3]) {
    const T one = T{} + 1.0, zero{};
    // Cosines of the half vector, without computing it: the sum of two unit vectors is twice as long as its projection on either.
    const T v_h = square_root(lesser(greater(0.5 + 0.5 * between, zero + 1e-12), one));
    const T grazing = fifth_power(1.0 - v_h);
    const T fresnel = view.layer_f0 + (1.0 - view.layer_f0) * grazing;
    const T passes = cosine * (1.0 - greater(fresnel, greater(view.layer_kept, layer_kept)));
    for (int k = 0; k < 3; ++k) radiance[k] = view.diffuse[k] * passes;
    if (!with_highlight) return;
    const T n_h = lesser(greater((view.facing + cosine) / (2.0 * v_h), zero), one);
    const T d = n_h * n_h * (view.alpha2 - 1.0) + 1.0;
    const T smith = cosine * view.smith + view.n_v * square_root(cosine * cosine * (1.0 - view.alpha2) + view.alpha2);
    const T lobe = view.alpha2 * cosine / (2.0 * pi * d * d * greater(smith, zero + 1e-9));
    for (int k = 0; k < 3; ++k) radiance[k] = radiance[k] + (view.highlight[k] + (view.coverage - view.highlight[k]) * grazing) * lobe;
}

}  // namespace crescente::render
