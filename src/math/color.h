// Colours and influences: linear RGB, Rec. 709 primaries, single precision.
#pragma once

#include <algorithm>
#include <cmath>

namespace crescente::math {

struct Rgb {
    float r = 0, g = 0, b = 0;

    constexpr float operator[](int channel) const { return channel == 0 ? r : channel == 1 ? g : b; }
    constexpr bool operator==(const Rgb&) const = default;
};

constexpr Rgb gray(float v) { return {v, v, v}; }
constexpr Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
constexpr Rgb operator-(Rgb a, Rgb b) { return {a.r - b.r, a.g - b.g, a.b - b.b}; }
constexpr Rgb operator*(Rgb a, Rgb b) { return {a.r * b.r, a.g * b.g, a.b * b.b}; }
constexpr Rgb operator*(Rgb a, float s) { return {a.r * s, a.g * s, a.b * s}; }
constexpr Rgb operator*(float s, Rgb a) { return a * s; }
constexpr Rgb& operator+=(Rgb& a, Rgb b) { return a = a + b; }
constexpr Rgb& operator*=(Rgb& a, Rgb b) { return a = a * b; }
constexpr Rgb mix(Rgb a, Rgb b, float t) { return a * (1.0f - t) + b * t; }
constexpr float max_component(Rgb a) { return std::max(a.r, std::max(a.g, a.b)); }
constexpr bool is_black(Rgb a) { return a.r == 0 && a.g == 0 && a.b == 0; }
inline bool is_finite(Rgb a) { return std::isfinite(a.r) && std::isfinite(a.g) && std::isfinite(a.b); }
constexpr float luminance(Rgb a) { return 0.2126f * a.r + 0.7152f * a.g + 0.0722f * a.b; }

}  // namespace crescente::math
