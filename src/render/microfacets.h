// A rough surface as facets that mirror and refract: the distribution of Trowbridge and Reitz ("ggx"), also stretched, with the height-correlated Smith term
// (Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces"; Heitz 2014, "Understanding the Masking-Shadowing Function in
// Microfacet-Based BRDFs"). Directions are unit vectors in the surface's frame: z is the normal, x the tangent.
#pragma once

#include "math/vec.h"

namespace crescente::render {

using namespace math;

struct Microfacets {
    double alpha_x, alpha_y;  // > 0

    // Density of facets with normal h (h.z >= 0), per unit of surface and solid angle.
    double density(Vec3 h) const {
        const double x = h.x / alpha_x, y = h.y / alpha_y, d = x * x + y * y + h.z * h.z;
        return 1 / (pi * alpha_x * alpha_y * d * d);
    }
    // Smith's ratio of hidden to visible facets, seen from w on either side.
    double hidden(Vec3 w) const {
        const double x = w.x * alpha_x, y = w.y * alpha_y, z2 = w.z * w.z;
        return 0.5 * (std::sqrt(1 + (x * x + y * y) / std::max(z2, 1e-300)) - 1);
    }
    // Share of facets that both see, whatever their normals; v and l may be on two sides.
    double seen_by_both(Vec3 v, Vec3 l) const { return 1 / (1 + hidden(v) + hidden(l)); }
    double seen_by(Vec3 w) const { return 1 / (1 + hidden(w)); }

    // Density (1/sr) of the normals of the facets that are seen from v (v.z > 0): what sample_seen draws from.
    double density_seen(Vec3 v, Vec3 h) const { return seen_by(v) * density(h) * std::max(0.0, dot(v, h)) / v.z; }

    // Normal of a facet that is seen from v, from two numbers in [0, 1) (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
    Vec3 sample_seen(Vec3 v, double u1, double u2) const {
        const Vec3 stretched = normalize(Vec3{v.x * alpha_x, v.y * alpha_y, v.z});
        const double phi = 2 * pi * u1, z = (1 - u2) * (1 + stretched.z) - stretched.z, r = std::sqrt(std::max(0.0, 1 - z * z));
        const Vec3 h = Vec3{r * std::cos(phi), r * std::sin(phi), z} + stretched;
        return normalize(Vec3{h.x * alpha_x, h.y * alpha_y, std::max(h.z, 1e-12)});
    }
};

}  // namespace crescente::render
