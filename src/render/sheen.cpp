#include "render/sheen.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "math/vec.h"

namespace crescente::render {
namespace {

using math::pi;

// Smith's function of the distribution, fitted by a curve in the cosine (Estevez and Kulla 2017, table 1).
double fitted(double cosine, double alpha) {
    const double p = (1 - alpha) * (1 - alpha);
    const auto between = [p](double rough, double smooth) { return smooth * p + rough * (1 - p); };
    const double a = between(21.5473, 25.3245), b = between(3.82987, 3.32435), c = between(0.19823, 0.16801), d = between(-1.97760, -1.27393), e = between(-4.32054, -4.85967);
    return a / (1 + b * std::pow(cosine, c)) + d * cosine + e;
}

double hidden(double cosine, double alpha) {
    return std::exp(cosine < 0.5 ? fitted(cosine, alpha) : 2 * fitted(0.5, alpha) - fitted(1 - cosine, alpha));
}

}  // namespace

double sheen_reflected(double alpha, double n_v, double n_l, double n_h) {
    const double sine = std::sqrt(std::max(0.0, 1 - n_h * n_h));
    const double density = (2 + 1 / alpha) * std::pow(sine, 1 / alpha) / (2 * pi);
    return density / ((1 + hidden(n_v, alpha) + hidden(n_l, alpha)) * 4 * std::max(n_v, 1e-4));
}

SheenSums sheen_sums(double alpha) {
    constexpr int heights = 48, turns = 48;
    // Even in the root of the light's cosine, where most changes.
    std::array<double, heights> cosines, hides;
    for (int i = 0; i < heights; ++i) {
        const double root = (i + 0.5) / heights;
        cosines[static_cast<std::size_t>(i)] = root * root, hides[static_cast<std::size_t>(i)] = hidden(root * root, alpha);
    }
    SheenSums sums;
    for (std::size_t k = 0; k < sums.size(); ++k) {
        const double n_v = std::max(1e-4, tabled_cosine(k)), sin_v = std::sqrt(1 - n_v * n_v), hides_v = hidden(n_v, alpha);
        double sum = 0;
        for (std::size_t i = 0; i < heights; ++i) {
            const double n_l = cosines[i], sin_l = std::sqrt(1 - n_l * n_l);
            double around = 0;
            for (int j = 0; j < turns; ++j) {
                const double between = n_v * n_l + sin_v * sin_l * std::cos(pi * (j + 0.5) / turns);
                const double n_h2 = (n_v + n_l) * (n_v + n_l) / std::max(1e-12, 2 + 2 * between);
                around += std::pow(std::max(0.0, 1 - n_h2), 0.5 / alpha);
            }
            sum += around / (1 + hides_v + hides[i]) * 2 * std::sqrt(n_l);  // d(root^2)
        }
        sums[k] = static_cast<float>(sum * (2 + 1 / alpha) / (2 * pi) / (4 * n_v) * (1.0 / heights) * (2 * pi / turns));
    }
    return sums;
}

SheenSums tabled_sheen_sums(double alpha) {
    constexpr std::size_t steps = 32;
    static const std::vector<SheenSums> rows = [] {
        std::vector<SheenSums> all;
        for (std::size_t i = 0; i <= steps; ++i) {
            const double roughness = static_cast<double>(i) / steps;
            all.push_back(sheen_sums(std::max(double{least_sheen_alpha}, roughness * roughness)));
        }
        return all;
    }();
    return row_at(rows, std::sqrt(std::clamp(alpha, 0.0, 1.0)));
}

}  // namespace crescente::render
