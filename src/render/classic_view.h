// What a classic material sends to one viewer of the light of a lamp, for one surface point (T = double) or eight (T = Lanes), to the same bits.
#pragma once

#include "math/power.h"
#include "math/vec_lanes.h"
#include "render/lobes.h"

namespace crescente::render {

template <class T>
struct ClassicView {
    T exponent;
    T diffuse[3], highlight[3];  // radiance per unit of irradiance, and of what the highlight keeps of the light's strength
};

inline ClassicView<double> classic_view(const Lobes& lobes) {
    ClassicView<double> view{lobes.exponent, {}, {}};
    for (int k = 0; k < 3; ++k) view.diffuse[k] = lobes.diffuse[k], view.highlight[k] = lobes.highlight_lobe == HighlightLobe::none ? 0 : lobes.highlight[k];
    return view;
}

inline void set_lane(ClassicView<Lanes>& to, int lane, const ClassicView<double>& view) {
    to.exponent[lane] = view.exponent;
    for (int k = 0; k < 3; ++k) to.diffuse[k][lane] = view.diffuse[k], to.highlight[k][lane] = view.highlight[k];
}

// Cosine between the viewer and the mirrored light (Phong 1975), by those between normal and light, normal and viewer, viewer and light.
template <class T>
T phong_cosine(const T& n_l, const T& n_v, const T& v_l) {
    return greater(2.0 * n_l * n_v - v_l, T{});
}

// Cosine between the normal and the direction halfway between viewer and light (Blinn 1977); 0 where these are opposite.
template <class T>
T blinn_cosine(const T& n_l, const T& n_v, const T& v_l) {
    const T between = square_root(greater(2.0 + 2.0 * v_l, T{}));  // length of their sum
    const T sum = greater(n_l + n_v, T{});
    return between > 0.0 ? sum / between : T{};
}

// Radiance per unit of the light's strength. cosine: between normal and light, over 0; highlight_cosine: one of the two above.
template <class T>
void reflect_classic(const ClassicView<T>& view, const T& cosine, const T& highlight_cosine, bool with_highlight, T (&radiance)[3]) {
    const T peak = with_highlight ? highlight_cosine > 0.0 ? power(highlight_cosine, view.exponent) : T{} : T{};
    for (int k = 0; k < 3; ++k) radiance[k] = view.diffuse[k] * cosine + view.highlight[k] * peak;
}

}  // namespace crescente::render
