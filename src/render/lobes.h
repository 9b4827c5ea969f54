// Materials compiled to what the tracer knows: lobes, each with an RGB weight.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "math/color.h"
#include "math/vec.h"
#include "render/fresnel.h"
#include "render/sheen.h"
#include "render/split_sum.h"
#include "scene/material.h"

namespace crescente::render {

using namespace math;

enum class HighlightLobe : std::uint8_t { none, phong, blinn, ggx };
enum class Fresnel : std::uint8_t {
    none,        // weights hold at every angle
    dielectric,  // mirror and refraction weights are multiplied by F and 1 - F of the exact equations, unpolarised
    facets,      // mirror weight is what facets reflect (facet_reflectance); without it: black
};

inline constexpr double least_bend = 1e-3;             // of the index of what lets light through: below, it goes straight through even a rough surface
inline constexpr float smoothest_alpha = 0.002f;  // of ggx; what is smoother has highlights of this size, and else is a perfect mirror

// What a rough surface that light goes through loses between its facets, and how that comes back after all: from all over, on both sides (Kulla and Conty 2017,
// slides 16 to 22). By side that light comes from: outer, inner. Perfectly smooth surfaces lose nothing, and have none of this.
struct RoughGlass {
    std::array<SplitSums, 2> sums;  // glass_sums
    std::array<float, 2> through{}; // share of what was lost that ends up on the other side
    std::array<float, 2> density{}; // so much of it to each direction (1/sr) on this side, times what is missing there
    std::array<MissingCells, 2> cells{};

    bool operator==(const RoughGlass&) const = default;
};

// What the facets of a physical material do to all light of one direction.
struct LayerShare {
    float kept = 0;     // does not reach the diffuse lobe: reflected by the layer over it; 0 without a diffuse lobe
    float missing = 0;  // is lost between facets, if these reflect all

    LayerShare operator+(LayerShare o) const { return {kept + o.kept, missing + o.missing}; }
    LayerShare operator-(LayerShare o) const { return {kept - o.kept, missing - o.missing}; }
    LayerShare operator*(float f) const { return {kept * f, missing * f}; }
    bool operator==(const LayerShare&) const = default;
};

struct Lobes {
    Rgb emission;            // radiance, whatever the light
    Rgb shining;             // of that what lights others: all but the ambient term of classic materials
    Rgb diffuse;             // radiance per unit of irradiance: albedo, over pi for physical materials
    Rgb highlight;           // weight of the highlight; for ggx: f0
    HighlightLobe highlight_lobe = HighlightLobe::none;
    float exponent = 0;      // phong, blinn
    float alpha = 1;         // ggx roughness
    float alpha_along = 1;   // the same along the grain; not less than alpha, and the same without a grain
    float coverage = 1;      // ggx: what the highlight's weight rises to at grazing angles
    Rgb metal;               // what of f0 is a metal's, rising to metal_share after Schlick (1994)
    float metal_share = 0;
    double layer_ior = 1;    // of the dielectric beside the metal, which says how the rest of f0 rises (FresnelRise)
    float layer_f0 = 0;      // of that dielectric, the layer over the diffuse lobe: the most of its channels
    float layer_f90 = 1;
    std::array<CosineTable<LayerShare>, 2> layer{};  // of light from the outer side, and from the inner
    std::array<float, 2> layer_gives_back{};         // of either side: 1 over the mean of all light that reaches the diffuse lobe, through coat and sheen too
    CosineTable<float> layer_lean{};                 // with a grain: of what is kept, to be added along it, and taken away across (GrainSums)
    SplitSums sums{};        // physical: reflectance of the whole ggx lobe
    CosineTable<float> rise{};       // of the same facets, if these reflect what a dielectric of layer_ior rises by
    SplitSums lean{};                // with a grain, of both
    CosineTable<float> rise_lean{};
    Rgb multiple;            // share of what is missing from those that comes back after more reflections between facets
    float multiple_density = 0;  // so much of it to each direction (1/sr), times what is missing there
    MissingCells multiple_cells{};
    bool gives_back_below = false;     // a rough metal under coat or fibres: what these and its facets do not send back at once comes back as `multiple` does
    CosineTable<float> lost_below{};   // then: share of the light of a direction, if the facets reflect all
    float lost_density = 0;            // of which, and from which cells, as above
    MissingCells lost_cells{};
    RoughGlass glass;
    Rgb eta, k, conductor_f0;   // of a metal given by its complex index
    float conductor = 0;        // share of that metal in all; 0: there is none
    float coat = 0;             // share of a clear coat over all else; seen from outside
    float coat_alpha = smoothest_alpha;
    float coat_mirror_share = 1;
    CosineTable<float> coat_sums{};  // its reflectance for all light of a direction, whole
    Rgb sheen;                  // of cloth's fibres, over all but the coat
    float sheen_most = 0;       // of its channels
    float sheen_alpha = 1;
    SheenSums sheen_sums{};
    float film = 0;             // share of the surface under a thin film
    float film_ior = 1, film_thickness = 0;  // nm
    float opacity = 1;          // of the surface itself: its coverage
    Rgb film_f0;                // below it, seen straight on
    Rgb glass_f0;               // where transmits(): reflectance of its surface, and what it rises to. tinted_glass: these are not what the index says
    float glass_f90 = 1;
    bool tinted_glass = false;
    float dispersion = 0;       // 20 over Abbe's number
    Vec3 tangent;               // at one place of a surface with a grain: where it runs; any length; zero: any direction
    Vec3 coat_normal;           // at one place: of the coat, towards the viewer, unit; zero: that of what is below
    Rgb mirror;              // weight of the reflected ray; with facets: f0
    float mirror_share = 0;  // facets: how much of the reflection the mirror ray carries; the rest is the environment's blur
    Rgb refraction;          // weight of the refracted ray
    Rgb straight;            // weight of a ray that passes on beside the refracted one: what the coverage leaves
    double ior = 1;
    Rgb attenuation;         // 1/m inside
    Fresnel fresnel = Fresnel::none;
    Rgb ambient_diffuse;     // weight of the environment's irradiance / pi
    float ambient_specular = 0;  // share of the environment's blurred reflection that the facets reflect
    float roughness = 0;     // of that blur
    Rgb shadow_filter;       // what passes a crossing in a shadow ray
    bool one_sided = false;  // rays do not meet the back: glTF culls it. Never what refracts: rays must leave a body again
    bool catcher = false;    // render/catcher.h
    Rgb albedo;              // for the picture's albedo layer

    bool operator==(const Lobes&) const = default;
    bool opaque() const { return is_black(shadow_filter); }
    bool mirrors() const { return !is_black(mirror) || coat * coat_mirror_share > 0; }
    bool refracts() const { return !is_black(refraction); }
    bool goes_on() const { return mirrors() || refracts() || !is_black(straight); }  // some ray may leave
    bool transmits() const { return layered() && fresnel == Fresnel::dielectric; }  // physical, of glass to some extent: its reflection follows Fresnel's equations
    bool smooth() const { return alpha_along <= smoothest_alpha; }                 // physical: its facets are one mirror
    bool grained() const { return alpha_along != alpha; }
    bool has_sheen() const { return sheen_most > 0; }
    bool coat_is_smooth() const { return coat_alpha <= smoothest_alpha; }
    bool composed() const { return conductor > 0 || coat > 0 || has_sheen() || film > 0 || grained(); }  // physical, of more than reflect_physical knows
    bool layered() const { return highlight_lobe == HighlightLobe::ggx; }            // diffuse light is what a reflecting layer lets in
};

Lobes compile(const scene::Material& material);  // without its textures
std::vector<Lobes> compile(std::span<const scene::Material> materials);  // sooner than one by one

// What facets and the layer below them reflect, as Lobes has it.
struct FacetsAndLayer {
    SplitSums sums;
    CosineTable<float> rise;
};
inline FacetsAndLayer between(const FacetsAndLayer& a, const FacetsAndLayer& b, float t) { return {between(a.sums, b.sums, t), between(a.rise, b.rise, t)}; }

// That of each roughness, for a layer of one index: of a surface that is of another roughness everywhere. It is interpolated as tabled_facet_sums is, whose shares are many more numbers.
class RoughnessTable {
public:
    explicit RoughnessTable(double ior);
    double ior() const { return ior_; }
    FacetsAndLayer at(double alpha) const;

private:
    double ior_;
    std::vector<FacetsAndLayer> rows_;  // from a roughness of 0 to 1
};

double layer_ior(const scene::PhysicalMaterial& material);  // by which its layer's reflection rises to grazing angles

// Of a material as its textures make it at one place. `whole`: the material without them, whose integrals over all directions hold where its roughness and its
// index do; otherwise they are looked up, in `table` if it is of its index, and what rough glass loses between its facets is not given back.
Lobes compile(const scene::Material& material, const Lobes& whole, const RoughnessTable* table);

// Share of light that the smooth layer of a physical material's dielectric mirrors: what its mirrored ray weighs, its coverage and metal aside.
float layer_mirrors(const Lobes& lobes, double cosine, bool inside);

// Light arriving from direction `to_light` (unit) with the given strength, leaving towards `to_viewer` (unit): radiance per unit of
// strength. Both are on the side of the shading normal; cosine = dot(normal, to_light) > 0.
Rgb reflect_light(const Lobes& lobes, Vec3 normal, Vec3 to_viewer, Vec3 to_light, double cosine, bool with_highlight);

inline constexpr double coat_ior = 1.5;

// What a clear coat takes of the light that would reach what is below, at a cosine (0 to 1) outside of it.
double coat_reflectance(const Lobes& lobes, double cosine);

// The same of the fibres of cloth, which take as much of all colours.
double sheen_reflectance(const Lobes& lobes, double cosine);

// What a facet of a physical material that lets no light through reflects, at a cosine to its normal: Fresnel's equations for dielectrics and for metals of a complex index, Schlick's approximation for
// those that have a color alone (glTF 2.0, appendix B).
Rgb facet_reflectance(const Lobes& lobes, double cosine);

// Of that, what is not in the tables of the whole surface's reflectance: by how much metals of a complex index, and what is under a thin film and lets no light through, are off the others.
Rgb beyond_tables(const Lobes& lobes, double cosine);

// What the whole surface reflects of all light of a direction at a cosine, but for that.
Rgb tabled_reflectance(const Lobes& lobes, double cosine);

// What a facet of the interface of a dielectric that light goes through reflects, and the share that it lets through; of either side, eta: index behind over index in front.
struct Interface {
    Rgb reflected;
    float through;
};
Interface glass_interface(const Lobes& lobes, double cosine, double eta);

// Weights of the two rays that a node may spawn, for a ray that meets the surface at `cosine` (>= 0), and its coat at another, from inside or outside.
struct ChildWeights {
    Rgb reflected, refracted;
};
ChildWeights child_weights(const Lobes& lobes, double cosine, double coat_cosine, bool inside);
inline ChildWeights child_weights(const Lobes& lobes, double cosine, bool inside) { return child_weights(lobes, cosine, cosine, inside); }

// Normal of the mirror ray that a surface of this normal sends: the coat's, if the mirror is the coat's; one ray stands for both.
inline Vec3 mirror_normal(const Lobes& lobes, Vec3 normal) {
    return lobes.coat_normal != Vec3{} && (lobes.coat_is_smooth() || !lobes.smooth()) ? lobes.coat_normal : normal;
}

// Cosine at which a viewer sees the coat, whose normal may be another than that of what is below, which he sees at `cosine`.
inline double coat_cosine(const Lobes& lobes, Vec3 to_viewer, double cosine) {
    return lobes.coat_normal == Vec3{} ? cosine : std::clamp(dot(lobes.coat_normal, to_viewer), 0.0, 1.0);
}

// Whether both send the same rays with the same weights from every hit.
bool send_same_rays(const Lobes& a, const Lobes& b);

}  // namespace crescente::render
