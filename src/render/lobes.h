// Materials compiled to what the tracer knows: lobes, each with an RGB weight.
#pragma once

#include <cstdint>

#include "math/color.h"
#include "math/vec.h"
#include "render/split_sum.h"
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
    float coverage = 1;      // what Schlick's terms rise to at grazing angles
    float layer_f0 = 0;      // of the dielectric layer over the diffuse lobe of physical materials
    SplitSums sums;          // physical: reflectance of the whole ggx lobe
    Rgb mirror;              // weight of the reflected ray; with schlick: f0
    Rgb metal;               // dielectric: f0 of a metal beside it, rising to metal_share (Schlick)
    float metal_share = 0;
    float mirror_share = 0;  // schlick: how much of the reflection the mirror ray carries; the rest is the environment's blur
    Rgb refraction;          // weight of the refracted ray
    Rgb straight;            // weight of a ray that passes on beside the refracted one: what the coverage leaves
    double ior = 1;
    Rgb attenuation;         // 1/m inside
    Fresnel fresnel = Fresnel::none;
    Rgb ambient_diffuse;     // weight of the environment's irradiance / pi
    Rgb ambient_specular;    // f0 of the environment's blurred reflection; black: none
    float roughness = 0;     // of that blur
    Rgb shadow_filter;       // what passes a crossing in a shadow ray
    bool one_sided = false;  // rays do not meet the back: glTF culls it. Never what refracts: rays must leave a body again
    Rgb albedo;              // for the picture's albedo layer

    bool operator==(const Lobes&) const = default;
    bool opaque() const { return is_black(shadow_filter); }
    bool mirrors() const { return !is_black(mirror); }
    bool refracts() const { return !is_black(refraction); }
    bool goes_on() const { return mirrors() || refracts() || !is_black(straight); }  // some ray may leave
    bool layered() const { return highlight_lobe == HighlightLobe::ggx; }            // diffuse light is what a reflecting layer lets in
};

// Without the material's textures. `sums`: where the split sums come from; by table they are looked up, for lobes that are compiled for each hit.
Lobes compile(const scene::Material& material, SplitSums (*sums)(double alpha) = split_sums);

// Share of light that the smooth layer of a physical material's dielectric mirrors: what its mirrored ray weighs, its coverage and metal aside.
float layer_mirrors(const Lobes& lobes, double cosine, bool inside);

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

// Whether both send the same rays with the same weights from every hit.
bool send_same_rays(const Lobes& a, const Lobes& b);

}  // namespace crescente::render
