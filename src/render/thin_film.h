// Reflectance of a surface under a film so thin that light reflected at both its sides interferes (Belcour and Barla 2017, "A Practical Extension to Microfacet Theory for
// the Modeling of Varying Iridescence"; glTF KHR_materials_iridescence).
#pragma once

#include "math/color.h"

namespace crescente::render {

using namespace math;

// For light from air at a cosine (0 to 1). film_ior >= 1; thickness: nm; base_f0: what the surface reflects without the film, at normal incidence. From 0 to 1; as the thickness
// goes to 0, so does the index of the film to that of air.
Rgb thin_film_reflectance(double cosine, double film_ior, double thickness, Rgb base_f0);

}  // namespace crescente::render
