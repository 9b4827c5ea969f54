// How a surface scatters light between any two directions, and directions drawn by it: what levels that sample ask of a material (render/scattering.h). The levels before them
// use the same lobes for lights without extent (reflect_light) and perfectly smooth rays (child_weights).
//
// All values are of radiance over the square of the index of refraction, as the weights of refracted rays are: light that crosses a surface twice needs no
// factor, and a material that absorbs nothing gives back exactly what it gets from everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "render/lobes.h"

namespace crescente::render {

// Which accumulator a direction was drawn for.
enum class Part : std::uint8_t { diffuse, glossy };

// The surface as it is met. Normals are unit vectors on the viewer's side.
struct Facing {
    Vec3 shading, geometric;
    bool inside = false;  // met from the inner side of its body
};

struct Scattered {
    Rgb diffuse, glossy;  // radiance to the viewer per unit of radiance and solid angle: f times |cosine|, of each part, coloured
    double pdf = 0;       // density (1/sr) of drawing the direction
};

struct ScatterSample {
    Vec3 direction;   // unit, away from the surface
    Scattered value;  // not delta: as Scattering::toward() says. Delta: the weight of the ray itself, and the chance of being drawn
    Part part;        // of the lobe that drew it
    bool delta;       // of a perfectly smooth lobe: one direction, no density
    bool crosses;     // it goes on behind the surface
};

// What of a material is perfectly smooth: goes one way only, that of the node's reflected, refracted and straight ray.
struct Smooth {
    bool reflects = false, refracts = false;
};
Smooth smooth_lobes(const Lobes& lobes);
Smooth smooth_facets(const Lobes& lobes);  // the same of what disperses, as if it did not

// Whether the material bends light of each colour by another angle (Lobes::dispersion): its refraction is drawn as rough ones are, one band of the spectrum at a time.
bool disperses(const Lobes& lobes);

// The same material for one of three bands: red, green, blue (0 to 2), at the wavelengths C, d and F of the definition of Abbe's number.
Lobes in_band(const Lobes& lobes, int band);

// Weights of the rays of perfectly smooth lobes alone, for a ray that meets the surface at `cosine` (0 to 1): what is a node's child where rough lobes are sampled.
// The straight ray beside them weighs lobes.straight.
ChildWeights smooth_weights(const Lobes& lobes, double cosine, double coat_cosine, bool inside);
inline ChildWeights smooth_weights(const Lobes& lobes, double cosine, bool inside) { return smooth_weights(lobes, cosine, cosine, inside); }

// Directions of the rays that smooth lobes send (unit); cosine: dot(shading, to_viewer), >= 0.
Vec3 mirrored_direction(const Facing& facing, Vec3 to_viewer);             // lifted to just above the surface
Vec3 refracted_direction(const Facing& facing, Vec3 to_viewer, double eta);  // eta: index in front over index behind; no total reflection

// What a composed physical material (a metal by its constants, a coat) sends to the viewer of a light without extent: as scatter, but smooth lobes as highlights, and
// without the geometric normal.
Rgb reflect_composed(const Lobes& lobes, Vec3 normal, Vec3 to_viewer, Vec3 to_light, bool with_highlight);

}  // namespace crescente::render
