#include "render/fresnel.h"

namespace crescente::render {

Rgb schlick(Rgb f0, float f90, double cosine) { return f0 + (gray(f90) - f0) * static_cast<float>(fifth_power(1 - cosine)); }

double fresnel_dielectric(double cosine, double eta) {
    const double eta2 = eta * eta;
    return eta < 1 && eta2 - 1.0 + cosine * cosine <= 0 ? 1 : fresnel_refracting(cosine, eta2);
}

double fresnel_conductor(double cosine, double eta, double k) {
    // Born and Wolf, "Principles of Optics", section 14.2: with a^2 - b^2 = eta^2 - k^2 - sin^2 and a b = eta k.
    const double cos2 = cosine * cosine, sin2 = 1 - cos2, difference = eta * eta - k * k - sin2;
    const double a2_b2 = std::sqrt(difference * difference + 4 * eta * eta * k * k), a = std::sqrt(std::max(0.0, 0.5 * (a2_b2 + difference)));
    const double perpendicular = (a2_b2 - 2 * a * cosine + cos2) / (a2_b2 + 2 * a * cosine + cos2);
    const double c = cos2 * a2_b2 + sin2 * sin2, d = 2 * a * cosine * sin2;
    const double parallel = c + d > 0 ? perpendicular * (c - d) / (c + d) : 1;
    return 0.5 * (parallel + perpendicular);
}

Rgb fresnel_conductor(double cosine, Rgb eta, Rgb k) {
    return {static_cast<float>(fresnel_conductor(cosine, eta.r, k.r)), static_cast<float>(fresnel_conductor(cosine, eta.g, k.g)),
            static_cast<float>(fresnel_conductor(cosine, eta.b, k.b))};
}

Rgb mean_fresnel_conductor(Rgb eta, Rgb k) {
    constexpr int steps = 64;
    Rgb sum;
    for (int i = 0; i < steps; ++i) sum += fresnel_conductor(std::sqrt((i + 0.5) / steps), eta, k);
    return sum * (1.0f / steps);
}

}  // namespace crescente::render
