// Materials compiled to what the tracer knows: lobes, each with an RGB weight.
#pragma once

#include <cstdint>

#include "math/color.h"
#include "math/vec.h"
#include "scene/material.h"

namespace crescente::render {

using namespace math;

enum class HighlightLobe : std::uint8_t { none, phong, blinn, ggx };
enum class Fresnel : std::uint8_t {
    none,        // weights hold at every angle
    dielectric,  // mirror and refraction weights are multiplied by F and 1 - F of the exact equations, unpolarised
    schlick,     // mirror weight is f0 rising to 1 at grazing angles (Schlick 1994)
};

struct Lobes {
    Rgb emission;            // radiance, whatever the light
    Rgb diffuse;             // radiance per unit of irradiance: albedo, over pi for physical materials
    Rgb highlight;           // weight of the highlight; for ggx: f0
    HighlightLobe highlight_lobe = HighlightLobe::none;
    float exponent = 0;      // phong, blinn
    float alpha = 1;         // ggx roughness
    Rgb mirror;              // weight of the reflected ray; with schlick: f0
    float mirror_share = 0;  // schlick: how much of the reflection the mirror ray carries; the rest is the environment's blur
    Rgb refraction;          // weight of the refracted ray
    double ior = 1;
    Rgb attenuation;         // 1/m inside
    Fresnel fresnel = Fresnel::none;
    Rgb ambient_diffuse;     // weight of the environment's irradiance / pi
    Rgb ambient_specular;    // f0 of the environment's blurred reflection; black: none
    float roughness = 0;     // of that blur
    Rgb shadow_filter;       // what passes a crossing in a shadow ray
    Rgb albedo;              // for the picture's albedo layer

    bool opaque() const { return is_black(shadow_filter); }
    bool mirrors() const { return !is_black(mirror); }
    bool refracts() const { return !is_black(refraction); }
};

Lobes compile(const scene::Material& material);

// Light arriving from direction `to_light` (unit) with the given strength, leaving towards `to_viewer` (unit): radiance per unit of
// strength. Both are on the side of the shading normal; cosine = dot(normal, to_light) > 0.
Rgb reflect_light(const Lobes& lobes, Vec3 normal, Vec3 to_viewer, Vec3 to_light, double cosine, bool with_highlight);

// Share of light reflected by a smooth dielectric, unpolarised (Fresnel 1823). cosine: of the angle of incidence, >= 0. eta: index
// behind over index in front. 1 under total internal reflection.
double fresnel_dielectric(double cosine, double eta);

// Weights of the two rays that a node may spawn, for a ray that meets the surface at `cosine` (>= 0), from inside or outside.
struct ChildWeights {
    Rgb reflected, refracted;
};
ChildWeights child_weights(const Lobes& lobes, double cosine, bool inside);

}  // namespace crescente::render
