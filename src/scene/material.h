// Materials as users describe them. render/lobes.h compiles both kinds to lobes; the tracer knows lobes only.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "base/fields.h"
#include "math/color.h"
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

// glTF 2.0 metallic-roughness with KHR_materials_ior, _transmission, _volume and _clearcoat, factors only; metals may be given by their optical constants.
struct PhysicalMaterial {
    Rgb base_color{0.8f, 0.8f, 0.8f};
    double metallic = 0;
    double roughness = 0.5;              // perceptual: alpha = roughness^2
    Rgb emissive{0, 0, 0};               // radiance, W/(sr m^2) up to the scene's common scale
    double ior = 1.5;
    double transmission = 0;
    Rgb attenuation{0, 0, 0};            // absorption inside, 1/m
    Rgb eta{0, 0, 0};                    // with k, the complex index of refraction eta + i k of a metal, in place of base_color
    Rgb k{0, 0, 0};                      // black: no constants are given
    double clearcoat = 0;                // share of the surface under a clear dielectric coat (index 1.5)
    double clearcoat_roughness = 0;
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
