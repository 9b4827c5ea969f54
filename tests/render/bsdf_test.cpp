// Scattering of light by materials and the directions drawn from it: energy, reciprocity, and that densities are those of the sampler.
#include "render/bsdf.h"

#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

Vec3 direction(double theta, double phi) { return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}; }
const Vec3 up{0, 0, 1};

struct Named {
    std::string name;
    Lobes lobes;
};
Named physical(std::string name, Rgb color, double metallic, double roughness, double transmission = 0, double opacity = 1, double ior = 1.5) {
    PhysicalMaterial m;
    m.base_color = color, m.metallic = metallic, m.roughness = roughness, m.transmission = transmission, m.opacity = opacity, m.ior = ior;
    return {std::move(name), compile({"", m})};
}
Named classic(std::string name, float diffuse, float specular, double shininess, scene::Highlight form, float reflection, float transmission, bool fresnel) {
    ClassicMaterial m = matte(gray(diffuse));
    m.specular = gray(specular), m.shininess = shininess, m.highlight = form, m.reflection = gray(reflection), m.transmission = gray(transmission);
    m.ior = 1.5, m.fresnel = fresnel;
    return {std::move(name), compile({"", m})};
}

// Materials that take nothing.
std::vector<Named> white() {
    std::vector<Named> all;
    const Rgb one{1, 1, 1};
    for (const double roughness : {0.0, 0.1, 0.3, 0.6, 1.0}) {
        const std::string r = " " + std::to_string(roughness);
        all.push_back(physical("metal" + r, one, 1, roughness));
        all.push_back(physical("plastic" + r, one, 0, roughness));
        all.push_back(physical("half metal" + r, one, 0.5, roughness));
        all.push_back(physical("glass" + r, one, 0, roughness, 1));
        all.push_back(physical("diamond" + r, one, 0, roughness, 1, 1, 2.4));
        all.push_back(physical("milk glass" + r, one, 0.2, roughness, 0.5));
        all.push_back(physical("veil" + r, one, 0.3, roughness, 0, 0.6));
        all.push_back(physical("glass veil" + r, one, 0, roughness, 0.7, 0.6));
    }
    all.push_back(physical("straight", one, 0, 0.5, 1, 1, 1.0));
    all.push_back(classic("matte", 1, 0, 1, scene::Highlight::phong, 0, 0, false));
    all.push_back(classic("phong", 0.5f, 0.5f, 20, scene::Highlight::phong, 0, 0, false));
    all.push_back(classic("blinn", 0.5f, 0.5f, 20, scene::Highlight::blinn, 0, 0, false));
    all.push_back(classic("broad phong", 0.5f, 0.5f, 0.5, scene::Highlight::phong, 0, 0, false));
    all.push_back(classic("broad blinn", 0.5f, 0.5f, 2, scene::Highlight::blinn, 0, 0, false));
    all.push_back(classic("whitted", 0.3f, 0.2f, 50, scene::Highlight::phong, 0.3f, 0.2f, false));
    all.push_back(classic("classic glass", 0, 0, 1, scene::Highlight::phong, 1, 1, true));
    return all;
}

// What comes back from a furnace, by drawing.
double furnace(const Lobes& lobes, double theta, bool inside, int n) {
    const Facing facing{up, up, {}, inside};
    const Vec3 v = direction(theta, 0.4);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
            const double lobe = std::fmod((i * n + j) * 0.6180339887498949, 1);
            if (const auto s = sample_scatter(lobes, facing, v, {lobe, (i + 0.5) / n, (j + 0.5) / n}, true)) {
                sum += (s->value.diffuse.g + s->value.glossy.g) / s->value.pdf;
            }
        }
    }
    return sum / (n * n);
}

TEST(Bsdf, Furnace) {
    for (const Named& m : white()) {
        for (const bool inside : {false, true}) {
            for (const double theta : {0.01, 0.6, 1.1, 1.4, 1.54}) {
                const double back = furnace(m.lobes, theta, inside, 100);
                EXPECT_LE(back, 1.02) << m.name << " " << theta << (inside ? " inside" : "");
                EXPECT_GE(back, 0.3) << m.name << " " << theta << (inside ? " inside" : "");
            }
        }
    }
}

}  // namespace
}  // namespace crescente::render::testing
