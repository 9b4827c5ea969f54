// How much of the light a smooth interface reflects (Fresnel 1823), unpolarised. cosine: of the angle of incidence, 0 to 1.
#pragma once

#include "math/color.h"

namespace crescente::render {

using namespace math;

template <class T>
T fifth_power(const T& m) { return m * m * m * m * m; }

// Schlick's approximation (1994): from f0 at normal incidence to f90 at grazing angles.
Rgb schlick(Rgb f0, float f90, double cosine);

// Between two dielectrics; eta: index behind over index in front. 1 under total internal reflection.
double fresnel_dielectric(double cosine, double eta);

// From air to a metal of the complex index eta + i k.
double fresnel_conductor(double cosine, double eta, double k);
Rgb fresnel_conductor(double cosine, Rgb eta, Rgb k);
Rgb mean_fresnel_conductor(Rgb eta, Rgb k);  // over all light that meets the surface, each direction by its cosine

}  // namespace crescente::render
