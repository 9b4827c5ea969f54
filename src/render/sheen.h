// Cloth: fibres that stand up from the surface, after Estevez and Kulla 2017, "Production Friendly Microfacet Sheen BRDF", whose distribution ("Charlie") and fit of the shadowing glTF's
// KHR_materials_sheen takes. Directions by cosines to the normal, from 0 to 1.
#pragma once

#include "render/cosine_table.h"

namespace crescente::render {

inline constexpr float least_sheen_alpha = 0.01f;

// Light sent to a viewer per unit of radiance and solid angle, times the cosine of the light's direction; n_h: cosine of the half vector. alpha: square of the perceptual roughness, >= least_sheen_alpha.
// Upright fibres (alpha < 0.06) would give back more than they get: sheen_held keeps it.
double sheen_reflected(double alpha, double n_v, double n_l, double n_h);

// Reflectance for all the light that comes from, or goes to, one direction.
using SheenSums = CosineTable<float>;
SheenSums sheen_sums(double alpha);
SheenSums tabled_sheen_sums(double alpha);  // from a table over perceptual roughness, for surfaces that are of another everywhere

// What sheen_reflected is to be multiplied by, at both cosines, so that no more than all comes back.
inline double sheen_held(double sum) { return sum > 1 ? 1 / sum : 1; }

}  // namespace crescente::render
