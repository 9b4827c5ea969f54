// Materials as users describe them. render/lobes.h compiles both kinds to lobes; the tracer knows lobes only.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "base/fields.h"
#include "math/color.h"
#include "math/vec.h"
#include "scene/texture.h"

namespace crescente::scene {

using math::Rgb;

enum class Highlight { phong, blinn };

// The material of Whitted-style ray tracers (Whitted 1980; Phong 1975; Blinn 1977). Factors are shares of light per RGB component.
struct ClassicMaterial {
    Rgb ambient{0, 0, 0};
    Rgb diffuse{0.8f, 0.8f, 0.8f};
    Rgb specular{0, 0, 0};               // strength of the highlight of lights
    Highlight highlight = Highlight::phong;
    double shininess = 32;               // exponent of the highlight
    Rgb reflection{0, 0, 0};             // share of the mirrored ray
    Rgb transmission{0, 0, 0};           // share of the refracted ray, and of light passing in shadows
    double ior = 1;                      // index of refraction; 1: straight through
    Rgb attenuation{0, 0, 0};            // absorption inside, 1/m (Beer-Lambert): exp(-attenuation * distance)
    bool fresnel = false;                // reflection and transmission shares follow Fresnel's equations (dielectric)
    Rgb emission{0, 0, 0};
    static const FieldTable<ClassicMaterial>& fields();
    bool operator==(const ClassicMaterial&) const = default;
};

// Which way the grain of a brushed surface runs. Automatic: by a mesh's texture coordinates where it has them, else along the axis.
enum class Grain { automatic, surface, along, around };

// glTF 2.0 metallic-roughness with KHR_materials_ior, _transmission, _volume, _specular, _clearcoat, _sheen, _anisotropy, _iridescence and _dispersion, factors only; metals
// may be given by their optical constants.
struct PhysicalMaterial {
    Rgb base_color{0.8f, 0.8f, 0.8f};
    double metallic = 0;
    double roughness = 0.5;              // perceptual: alpha = roughness^2
    Rgb emissive{0, 0, 0};               // radiance, W/(sr m^2) up to the scene's common scale
    double ior = 1.5;
    double transmission = 0;
    double dispersion = 0;               // 20 over the Abbe number; 0: one index for all wavelengths
    Rgb attenuation{0, 0, 0};            // absorption inside, 1/m
    double specular = 1;                 // of a dielectric: its reflection is so much of what its index says
    Rgb specular_color{1, 1, 1};         // the same at normal incidence, and may be more
    Rgb eta{0, 0, 0};                    // with k, the complex index of refraction eta + i k of a metal, in place of base_color
    Rgb k{0, 0, 0};                      // black: no constants are given
    double clearcoat = 0;                // share of the surface under a clear dielectric coat (index 1.5)
    double clearcoat_roughness = 0;
    Rgb sheen_color{0, 0, 0};            // of fibres that stand up from cloth; black: none
    double sheen_roughness = 0.5;
    double anisotropy = 0;               // how much rougher the surface is along its grain than across: alpha = mix(roughness^2, 1, anisotropy^2)
    double anisotropy_rotation = 0;      // of the grain, radians, counter-clockwise
    Grain grain = Grain::automatic;
    math::Vec3 grain_axis{1, 0, 0};      // in the shape's space; any length but zero
    double iridescence = 0;              // share of the surface under a thin film
    double iridescence_ior = 1.3;        // of the film
    double iridescence_thickness = 400;  // of the film, nm
    double opacity = 1;                  // alpha coverage: the rest passes straight on
    bool double_sided = true;
    bool catcher = false;                // the camera sees only the shadows and reflections that it catches, over what is behind the scene
    static const FieldTable<PhysicalMaterial>& fields();
    bool operator==(const PhysicalMaterial&) const = default;
};

struct Material {
    std::string name;
    std::variant<ClassicMaterial, PhysicalMaterial> model = PhysicalMaterial{};
    std::vector<TextureBinding> textures{};  // several may act on one field
};

}  // namespace crescente::scene
