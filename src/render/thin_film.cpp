#include "render/thin_film.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "math/vec.h"
#include "render/fresnel.h"

namespace crescente::render {
namespace {

double index_of_f0(double f0) {
    const double root = std::sqrt(f0);
    return (1 + root) / (1 - root);
}

// Fourier transforms of the eye's responses (CIE 1931), each fitted by Gaussians (Belcour and Barla 2017, appendix): height, place (1/m) and variance of each, in X, Y, Z, and the second bump of X.
struct Response {
    double height, place, variance;
};
constexpr std::array<Response, 4> responses{{{5.4856e-13, 1.6810e6, 4.3278e9}, {4.4201e-13, 1.7953e6, 9.3046e9}, {5.2481e-13, 2.2084e6, 6.6121e9}, {9.7470e-14, 2.2399e6, 4.5282e9}}};

// By Rec. 709, of X, Y, Z.
constexpr double primaries[3][3] = {{3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};

// One channel of what the eye sees of a wave of all wavelengths that is behind by a path (m) and a phase; 1 without either.
double seen(int channel, double path, double phase) {
    const double t = 2 * pi * path;
    const auto sum = [&](double turn, double shift) {
        double xyz[3] = {};
        for (std::size_t i = 0; i < responses.size(); ++i) {
            const Response& r = responses[i];
            xyz[i % 3] += r.height * std::sqrt(2 * pi * r.variance) * std::cos(r.place * turn + shift) * std::exp(-turn * turn * r.variance);
        }
        return primaries[channel][0] * xyz[0] + primaries[channel][1] * xyz[1] + primaries[channel][2] * xyz[2];
    };
    return sum(t, phase) / sum(0, 0);
}

}  // namespace

Rgb thin_film_reflectance(double cosine, double film_ior, double thickness, Rgb base_f0) {
    constexpr double shortest = 0.03;  // nm: what is thinner goes over into no film
    const double s = std::clamp(thickness / shortest, 0.0, 1.0), index = 1 + (film_ior - 1) * s * s * (3 - 2 * s);
    const double inner = std::sqrt(1 - (1 - cosine * cosine) / (index * index));
    const double r12 = fresnel_dielectric(cosine, index), t121 = 1 - r12;
    const double path = 2 * index * thickness * 1e-9 * inner;
    std::array<float, 3> rgb;
    for (int c = 0; c < 3; ++c) {
        const double base_index = index_of_f0(std::clamp(double{base_f0[c]}, 0.0, 0.9999));
        const double r23 = fresnel_dielectric(inner, base_index / index);
        const double phase = base_index < index ? 2 * pi : pi;  // of a round in the film, but for its length: half a wave at its face, and another where the base is the rarer
        const double both = std::min(r12 * r23, 0.9999), amplitude = std::sqrt(both), again = t121 * t121 * r23 / (1 - both);
        double sum = r12 + again, term = again - t121;
        for (int m = 1; m <= 2; ++m) {
            term *= amplitude;
            sum += term * 2 * seen(c, m * path, m * phase);
        }
        rgb[static_cast<std::size_t>(c)] = static_cast<float>(std::clamp(sum, 0.0, 1.0));
    }
    return {rgb[0], rgb[1], rgb[2]};
}

}  // namespace crescente::render
