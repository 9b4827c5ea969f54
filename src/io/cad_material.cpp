#include "io/cad_material.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace crescente::io {
namespace {

using scene::PhysicalMaterial;

// IEC 61966-2-1: what the author of the file saw on the screen.
float encoded(float linear) { return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f; }

scene::Material named(const char* kind, const math::Rgb& screen, PhysicalMaterial model) {
    const auto byte = [](float v) { return static_cast<unsigned>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255)); };
    char name[48];
    std::snprintf(name, sizeof name, "%s #%02x%02x%02x", kind, byte(screen.r), byte(screen.g), byte(screen.b));
    return {name, model};
}

}  // namespace

scene::Material cad_material(const CadColor& color) {
    const auto within = [](float v) { return std::clamp(v, 0.0f, 1.0f); };
    const math::Rgb rgb{within(color.rgb.r), within(color.rgb.g), within(color.rgb.b)};
    const math::Rgb screen{encoded(rgb.r), encoded(rgb.g), encoded(rgb.b)};
    const float brightest = std::max({screen.r, screen.g, screen.b}), darkest = std::min({screen.r, screen.g, screen.b});
    const float saturation = brightest > 0 ? (brightest - darkest) / brightest : 0;

    PhysicalMaterial model;
    model.base_color = rgb;
    constexpr float opaque = 0.98f;
    if (color.alpha < opaque) {  // the more transparent the less colour is left in what passes
        const float tint = within(color.alpha);
        model.base_color = {1 - tint * (1 - rgb.r), 1 - tint * (1 - rgb.g), 1 - tint * (1 - rgb.b)};
        model.roughness = 0;
        model.transmission = 1;
        return named("glass", screen, model);
    }
    constexpr float grey = 0.12f, muted = 0.55f, near_black = 0.3f, near_white = 0.93f;
    if (saturation < grey && brightest > near_black && brightest < near_white) {
        model.metallic = 1;
        model.roughness = 0.3;
        return named("metal", screen, model);
    }
    if (saturation >= grey && saturation < muted) {
        model.roughness = 0.25;
        return named("painted metal", screen, model);
    }
    model.roughness = 0.4;
    return named("plastic", screen, model);
}

scene::Material uncolored_cad_material() {
    PhysicalMaterial model;
    model.base_color = {0.55f, 0.57f, 0.6f};
    model.roughness = 0.35;
    return {"uncoloured", model};
}

}  // namespace crescente::io
