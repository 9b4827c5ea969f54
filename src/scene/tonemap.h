// From scene light to what a display shows: exposure, tone mapping, the sRGB curve. Same input, same bits, on every machine.
#pragma once

#include <cstdint>
#include <span>

#include "math/color.h"
#include "scene/settings.h"

namespace crescente::scene {

// The transfer function of sRGB (IEC 61966-2-1:1999) and its inverse. Arguments outside 0..1 are clamped; NaN counts as 0.
float srgb_encode(float linear);
float srgb_decode(float encoded);

// Linear radiance to sRGB-encoded display colour, 0..1. `exposure` in stops. Tonemap::neutral is Khronos PBR Neutral (Khronos Group, "Khronos PBR Neutral
// Tone Mapper", specification, 2024): colours below 0.8 keep hue and saturation, highlights run to white. Tonemap::srgb clips; automatic
// must be resolved by the caller and counts as srgb. Negative and NaN components count as 0, infinite ones as very bright.
math::Rgb display(math::Rgb linear, Tonemap tonemap, double exposure);

// The exposure in stops that makes the log-average luminance of a picture middle grey (0.18; Reinhard, Stark, Shirley and Ferwerda 2002, "Photographic Tone Reproduction for Digital
// Images", section 3), or less, so that no more than a twentieth of the pixels is brighter than 1: a model before a dark backdrop is not burnt out. To a hundredth of a stop, from -32 to 32. Pixels
// count by their alpha, where there is one; those that are not finite, and black ones, do not. 0 where nothing is left.
// `linear`: `channels` values a pixel, of which the first three are colours and the fourth, if there are four, is alpha, which is multiplied in.
double automatic_exposure(std::span<const float> linear, std::size_t channels);

// display() for whole pictures, rounded to 8 or 16 bits: exactly floor(display() * (2^n - 1) + 0.5). Both spans hold 3 values a pixel.
void display_image(std::span<const float> linear, Tonemap tonemap, double exposure, std::span<std::uint8_t> out);
void display_image(std::span<const float> linear, Tonemap tonemap, double exposure, std::span<std::uint16_t> out);

}  // namespace crescente::scene
