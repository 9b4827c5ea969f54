// What materials send back of light that is everywhere.
#pragma once

#include "render/scatter.h"
#include "render/scenes.h"

namespace crescente::render::testing {

inline Vec3 direction(double theta, double phi) { return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}; }
inline const Vec3 up{0, 0, 1};

// Calls with n evenly spread triples of numbers (Kronecker's sequence of the powers of the root of x^4 = x + 1; Roberts 2018).
inline void for_each_draw(int n, const std::function<void(std::array<double, 3>)>& draw) {
    for (int i = 1; i <= n; ++i) draw({std::fmod(i * 0.8191725133961645, 1), std::fmod(i * 0.6710436067037893, 1), std::fmod(i * 0.5497004779019703, 1)});
}

// What comes back from a furnace where light of strength 1 is everywhere.
inline double furnace(const Lobes& lobes, double theta, bool inside) {
    constexpr int n = 8000;
    double sum = 0;
    for_each_draw(n, [&](std::array<double, 3> u) {
        if (const auto s = sample_scatter(lobes, {up, up, inside}, direction(theta, 0.4), u, true)) sum += (s->value.diffuse.g + s->value.glossy.g) / s->value.pdf;
    });
    return sum / n;
}

}  // namespace crescente::render::testing
