// How much of the light a smooth interface reflects (Fresnel 1823), unpolarised. cosine: of the angle of incidence, 0 to 1.
#pragma once

#include "math/color.h"
#include "math/vec_lanes.h"

namespace crescente::render {

using namespace math;

template <class T>
T fifth_power(const T& m) { return m * m * m * m * m; }

// Schlick's approximation (1994): from f0 at normal incidence to f90 at grazing angles.
Rgb schlick(Rgb f0, float f90, double cosine);

// Between two dielectrics; eta: index behind over index in front. 1 under total internal reflection; 0 at all angles for the same index.
double fresnel_dielectric(double cosine, double eta);

// The same where not all is reflected; eta2: square of eta (in the form of Cook and Torrance 1982, "A Reflectance Model for Computer Graphics").
template <class T>
T fresnel_refracting(const T& cosine, const T& eta2) {
    const T zero{}, g = square_root(eta2 - 1.0 + cosine * cosine), sum = greater(g + cosine, zero + 1e-12);
    const T perpendicular = (g - cosine) / sum, both = (cosine * sum - 1.0) / (cosine * (g - cosine) + 1.0);
    return 0.5 * perpendicular * perpendicular * (1.0 + both * both);
}

// By how much of its way from its value at normal incidence, (eta - 1)^2 / (eta + 1)^2, to 1 at grazing angles the reflectance of a dielectric has risen; eta >= 1. A little below 0 at
// Brewster's angle for eta > 2 + sqrt(3); of eta = 1, which reflects nothing, 0. In the place of the fifth power of Schlick's approximation it makes other values rise as an index has it that
// goes from one to the other (Burley 2015, "Extending the Disney BRDF to a BSDF with Integrated Subsurface Scattering", specular tint).
template <class T>
struct FresnelRise {
    T eta2, scale, base;
    T at(const T& cosine) const { return fresnel_refracting(cosine, eta2) * scale - base; }
};
inline FresnelRise<double> fresnel_rise(double eta) {
    const double root = (eta - 1) / (eta + 1), r0 = root * root, scale = 1 / (1 - r0);
    return {eta * eta, scale, r0 * scale};
}

// From air to a metal of the complex index eta + i k.
double fresnel_conductor(double cosine, double eta, double k);
Rgb fresnel_conductor(double cosine, Rgb eta, Rgb k);
Rgb mean_fresnel_conductor(Rgb eta, Rgb k);  // over all light that meets the surface, each direction by its cosine

}  // namespace crescente::render
