// Materials and the light of the environment against closed forms and numerical integrals.
#include "render/environment.h"

#include <complex>

#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

Lobes compiled(const scene::ClassicMaterial& m) { return compile({"", m}); }
Lobes compiled(const scene::PhysicalMaterial& m) { return compile({"", m}); }
Vec3 direction(double theta, double phi) { return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)}; }
const Vec3 up{0, 0, 1};

TEST(Fresnel, ClosedForms) {
    for (const double eta : {1.1, 1.33, 1.5, 2.4, 1 / 1.5, 1 / 2.4}) {
        const double r0 = (eta - 1) / (eta + 1);
        EXPECT_NEAR(fresnel_dielectric(1, eta), r0 * r0, 1e-14);
        // Brewster: nothing of the parallel half is reflected.
        const double perpendicular = (1 - eta * eta) / (1 + eta * eta);
        EXPECT_NEAR(fresnel_dielectric(std::cos(std::atan(eta)), eta), 0.5 * perpendicular * perpendicular, 1e-14);
        EXPECT_NEAR(fresnel_dielectric(0, eta), 1, 1e-12);
        for (double cosine = 0.02; cosine < 1; cosine += 0.02) {
            const double f = fresnel_dielectric(cosine, eta), sin2 = (1 - cosine * cosine) / (eta * eta);
            EXPECT_GE(f, 0);
            EXPECT_LE(f, 1);
            if (sin2 >= 1) {
                EXPECT_EQ(f, 1) << "total internal reflection";
            } else {
                EXPECT_NEAR(f, fresnel_dielectric(std::sqrt(1 - sin2), 1 / eta), 1e-12) << "the same both ways";
            }
        }
    }
    EXPECT_EQ(fresnel_dielectric(0.7, 1), 0);
}

TEST(Fresnel, OfMetals) {
    // Against the equations for complex amplitudes themselves.
    for (const auto& [eta, k] : {std::pair{0.18, 3.4}, {1.5, 0.0}, {3.1, 3.3}, {0.0, 2.0}}) {
        for (double cosine = 0.01; cosine <= 1; cosine += 0.03) {
            const std::complex<double> n{eta, k}, inside = std::sqrt(1.0 - (1 - cosine * cosine) / (n * n));
            const double s = std::norm((cosine - n * inside) / (cosine + n * inside)), p = std::norm((n * cosine - inside) / (n * cosine + inside));
            EXPECT_NEAR(fresnel_conductor(cosine, eta, k), 0.5 * (s + p), 1e-12) << eta << " " << k << " " << cosine;
        }
    }
}

TEST(ChildWeights, ShareTheLight) {
    for (const bool inside : {false, true}) {
        for (double cosine = 0.01; cosine <= 1; cosine += 0.01) {
            const double eta = inside ? 1 / 1.5 : 1.5;
            const ChildWeights w = child_weights(compiled(glass({1, 1, 1}, 1.5, true)), cosine, inside);
            EXPECT_NEAR(w.reflected.g, fresnel_dielectric(cosine, eta), 1e-6);
            EXPECT_NEAR(w.reflected.g + w.refracted.g, 1, 1e-6);
            const ChildWeights plain = child_weights(compiled(glass({0.8f, 0.6f, 0.4f}, 1.5)), cosine, inside);
            const bool total = inside && 1 - cosine * cosine > 1 / 2.25;
            EXPECT_EQ(total ? plain.reflected : plain.refracted, (Rgb{0.8f, 0.6f, 0.4f}));
            EXPECT_TRUE(is_black(total ? plain.refracted : plain.reflected));
            PhysicalMaterial clear;
            clear.base_color = {1, 1, 1}, clear.transmission = 1, clear.roughness = 0;
            const ChildWeights p = child_weights(compiled(clear), cosine, inside);
            EXPECT_NEAR(p.reflected.r + p.refracted.r, 1, 1e-6);
            PhysicalMaterial metal;
            metal.base_color = {0.9f, 0.5f, 0.1f}, metal.metallic = 1, metal.roughness = 0;
            const ChildWeights m = child_weights(compiled(metal), cosine, inside);
            EXPECT_NEAR(m.reflected.b, 0.1 + 0.9 * std::pow(1 - cosine, 5), 1e-6);
            EXPECT_TRUE(is_black(m.refracted));
        }
    }
}

TEST(Highlights, ClosedForms) {
    Random random(3);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 l = direction(random.uniform(0, 1.5), random.uniform(0, 7)), v = direction(random.uniform(0, 1.5), random.uniform(0, 7));
        ClassicMaterial m = matte({0.5f, 0.4f, 0.3f});
        m.specular = {0.7f, 0.6f, 0.2f}, m.shininess = 20;
        const Vec3 mirrored = up * (2 * l.z) - l, half = normalize(l + v);
        const double phong = std::pow(std::max(0.0, dot(mirrored, v)), 20), blinn = std::pow(half.z, 20);
        expect_near(reflect_light(compiled(m), up, v, l, l.z, true), m.diffuse * float(l.z) + m.specular * float(phong), 2e-6);
        expect_near(reflect_light(compiled(m), up, v, l, l.z, false), m.diffuse * float(l.z), 1e-6);
        m.highlight = scene::Highlight::blinn;
        expect_near(reflect_light(compiled(m), up, v, l, l.z, true), m.diffuse * float(l.z) + m.specular * float(blinn), 2e-6);

        PhysicalMaterial p;
        p.base_color = {0.9f, 0.6f, 0.2f}, p.metallic = 1, p.roughness = random.uniform(0.2, 1);
        Lobes metal = compiled(p);
        metal.multiple = {};  // the lobe of one reflection alone
        const double a2 = std::pow(p.roughness, 4), h = half.z, vh = dot(v, half);
        const double d = a2 / (pi * std::pow(h * h * (a2 - 1) + 1, 2));
        const auto lambda = [&](double c) { return 0.5 * (std::sqrt(1 + a2 * (1 - c * c) / (c * c)) - 1); };
        const double g = 1 / (1 + lambda(l.z) + lambda(v.z));
        for (int k = 0; k < 3; ++k) {
            const double f = p.base_color[k] + (1 - p.base_color[k]) * std::pow(1 - vh, 5), expected = d * g * f / (4 * v.z);
            EXPECT_NEAR(reflect_light(metal, up, v, l, l.z, true)[k], expected, 1e-5 * (1 + expected));
        }
    }
}

TEST(Highlights, PhysicalOnesAreReciprocal) {
    Random random(4);
    for (int i = 0; i < 2000; ++i) {
        const Vec3 l = direction(random.uniform(0, 1.5), random.uniform(0, 7)), v = direction(random.uniform(0, 1.5), random.uniform(0, 7));
        PhysicalMaterial p;
        p.base_color = {0.9f, 0.6f, 0.2f}, p.metallic = random.uniform(), p.roughness = random.uniform(0.1, 1);
        const Rgb there = reflect_light(compiled(p), up, v, l, l.z, true) * float(v.z), back = reflect_light(compiled(p), up, l, v, v.z, true) * float(l.z);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(there[k], back[k], 1e-5 * (1 + there[k]));
    }
}

// What a surface sends to the viewer when light of strength 1 comes from everywhere.
double directional_albedo(const Lobes& lobes, double view, int n = 400) {
    const Vec3 v = direction(view, 0);
    double sum = 0;
    for (int i = 0; i < n; ++i) {
        const double theta = (i + 0.5) / n * pi / 2;
        for (int j = 0; j < n; ++j) {
            const Vec3 l = direction(theta, (j + 0.5) / n * 2 * pi);
            sum += reflect_light(lobes, up, v, l, l.z, true).g * std::sin(theta);
        }
    }
    return sum * (pi / 2 / n) * (2 * pi / n);
}

TEST(Highlights, WhiteMetalGivesBackWhatItGets) {
    for (const double roughness : {0.3, 0.5, 0.7, 1.0}) {
        for (const double view : {0.05, 0.6, 1.1, 1.5}) {
            PhysicalMaterial metal;
            metal.base_color = {1, 1, 1}, metal.metallic = 1, metal.roughness = roughness;
            const double albedo = directional_albedo(compiled(metal), view);
            EXPECT_NEAR(albedo, 1, 0.015) << roughness << " " << view;
        }
    }
    PhysicalMaterial roughest;  // facets in every direction alike
    roughest.base_color = {1, 1, 1}, roughest.metallic = 1, roughest.roughness = 1;
    Lobes once = compiled(roughest);
    once.multiple = {};
    EXPECT_NEAR(directional_albedo(once, 0), 1 - std::log(2), 2e-4) << "after one reflection";
}

TEST(Layer, ReflectanceIsTheIntegralOfTheLobe) {
    for (const double roughness : {0.3, 0.5, 0.75, 1.0}) {
        for (const double f0 : {0.02, 0.04, 0.2, 1.0}) {
            for (const double view : {0.05, 0.5, 0.9, 1.2, 1.4, 1.5}) {
                PhysicalMaterial metal;
                metal.base_color = gray(float(f0)), metal.metallic = 1, metal.roughness = roughness;
                Lobes lobes = compiled(metal);
                lobes.multiple = {};
                const SplitSum sum = at_cosine(lobes.sums, std::cos(view));
                EXPECT_GE(std::min(sum.scale, sum.bias), 0);
                EXPECT_LE(sum.scale + sum.bias, 1);
                EXPECT_NEAR(sum.scale * f0 + sum.bias, directional_albedo(lobes, view), 0.015) << roughness << " " << f0 << " " << view;
            }
        }
    }
}

TEST(Layer, FollowsFresnelsEquations) {
    for (const double roughness : {0.3, 0.5, 0.75, 1.0}) {
        for (const double ior : {1.1, 1.33, 1.5, 2.4, 5.0}) {
            PhysicalMaterial black;
            black.base_color = {}, black.roughness = roughness, black.ior = ior;
            PhysicalMaterial white = black;
            white.base_color = {1, 1, 1};
            const Lobes lobes = compiled(black), over_white = compiled(white);
            for (const double view : {0.05, 0.5, 0.9, 1.2, 1.4, 1.5}) {
                const double whole = directional_albedo(lobes, view);
                EXPECT_NEAR(tabled_reflectance(lobes, std::cos(view)).g, whole, 0.015) << roughness << " " << ior << " " << view;
                EXPECT_NEAR(at_cosine(over_white.layer[0], std::cos(view)).kept, whole, 0.015) << roughness << " " << ior << " " << view;
            }
        }
    }
    // One facet.
    PhysicalMaterial plastic;
    plastic.roughness = 0;
    for (const double ior : {1.0, 1.2, 1.5, 2.4, 4.5}) {
        plastic.ior = ior;
        const Lobes lobes = compiled(plastic);
        for (double cosine = 0; cosine <= 1; cosine += 0.05) {
            EXPECT_NEAR(facet_reflectance(lobes, cosine).g, fresnel_dielectric(cosine, ior), 1e-6) << ior << " " << cosine;
            EXPECT_NEAR(child_weights(lobes, cosine, false).reflected.g, fresnel_dielectric(cosine, ior), 1e-6) << ior << " " << cosine;
        }
    }
}

TEST(Layer, OfNoIndexReflectsNothing) {
    for (const double roughness : {0.0, 0.4, 1.0}) {
        PhysicalMaterial p;
        p.base_color = {0.6f, 0.6f, 0.6f}, p.roughness = roughness, p.ior = 1;
        const Lobes lobes = compiled(p);
        EXPECT_FALSE(lobes.mirrors());
        for (const double view : {0.0, 1.0, 1.55}) {
            const Vec3 v = direction(view, 0.3);
            for (const double light : {0.1, 1.5}) {
                const Vec3 l = direction(light, 3);
                expect_near(reflect_light(lobes, up, v, l, l.z, true), gray(0.6f * static_cast<float>(l.z / pi)), 1e-6);
            }
        }
    }
}

// KHR_materials_specular: f0 and f90 are met, at any index; between them it rises as the index does.
TEST(Layer, SpecularFactorsAreMet) {
    for (const double ior : {1.2, 1.5, 6.0}) {
        const double r0 = (ior - 1) * (ior - 1) / ((ior + 1) * (ior + 1));
        PhysicalMaterial p;
        p.roughness = 0, p.ior = ior, p.specular = 0.7, p.specular_color = {0.5f, 1, 0};
        const Lobes lobes = compiled(p);
        for (int k = 0; k < 3; ++k) {
            EXPECT_NEAR(facet_reflectance(lobes, 1)[k], 0.7 * r0 * p.specular_color[k], 1e-6);
            EXPECT_NEAR(facet_reflectance(lobes, 0)[k], 0.7, 1e-6);
        }
        for (double cosine = 0; cosine <= 1; cosine += 0.05) {
            EXPECT_NEAR(facet_reflectance(lobes, cosine).g, 0.7 * fresnel_dielectric(cosine, ior), 1e-6);
            EXPECT_GE(facet_reflectance(lobes, cosine).b, 0);
        }
    }
}

TEST(Layer, AWhiteDielectricGivesBackWhatItGets) {
    for (const double ior : {1.0, 1.3, 1.5, 2.0}) {
        for (const double roughness : {0.3, 0.5, 0.7, 1.0}) {
            for (const double view : {0.05, 0.6, 1.1, 1.3, 1.5, 1.55}) {
                PhysicalMaterial p;
                p.base_color = {1, 1, 1}, p.roughness = roughness, p.ior = ior;
                const double albedo = directional_albedo(compiled(p), view, view > 1.5 && roughness < 0.4 ? 1500 : 400);
                EXPECT_LE(albedo, 1.01) << ior << " " << roughness << " " << view;
                EXPECT_GE(albedo, 0.98) << ior << " " << roughness << " " << view;
            }
        }
    }
}

// What is under the layer, of any albedo, sends back so much of what the layer leaves to it (Kelemen and Szirmay-Kalos 2001).
TEST(Layer, DiffusePartIsCoupledToIt) {
    Random random(6);
    for (int i = 0; i < 30; ++i) {
        PhysicalMaterial p;
        p.base_color = {0.9f, 0.6f, 0.2f}, p.roughness = random.uniform(0.3, 1), p.ior = random.uniform(1.1, 2.4);
        PhysicalMaterial black = p;
        black.base_color = {};
        const Lobes lobes = compiled(p), layer = compiled(black);
        constexpr int steps = 48;
        double mean = 0;
        for (int k = 0; k < steps; ++k) mean += tabled_reflectance(layer, std::sqrt((k + 0.5) / steps)).g / steps;
        for (int k = 0; k < 10; ++k) {
            const Vec3 l = direction(random.uniform(0, 1.5), random.uniform(0, 7)), v = direction(random.uniform(0, 1.5), random.uniform(0, 7));
            const double passes = (1 - tabled_reflectance(layer, v.z).g) * (1 - tabled_reflectance(layer, l.z).g) / (1 - mean);
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(reflect_light(lobes, up, v, l, l.z, false)[c], p.base_color[c] / pi * passes * l.z, 1e-3);
        }
    }
}

TEST(Diffuse, AlbedoIsTheShareThatComesBack) {
    PhysicalMaterial p;
    p.base_color = {0.6f, 0.6f, 0.6f};
    Lobes lobes = compiled(p);
    lobes.highlight_lobe = HighlightLobe::none;
    EXPECT_NEAR(directional_albedo(lobes, 0.7), 0.6, 1e-3);
}

TEST(EnvironmentLight, IrradianceIsTheIntegralOfRadiance) {
    const Environment e(scene::Environment{{0.9f, 0.3f, 0.5f}, {0.2f, 0.6f, 0.4f}, {0.1f, 0.05f, 0.7f}, false, {}, {}, false, 1, 0, {}, {}, {}});
    Random random(5);
    std::vector<Vec3> normals{{0, 1, 0}, {0, -1, 0}, {1, 0, 0}};
    for (int i = 0; i < 5; ++i) normals.push_back(random.direction());
    for (const Vec3 n : normals) {
        const Vec3 t = perpendicular(n), b = cross(n, t);
        Rgb sum;
        constexpr int steps = 300;
        for (int i = 0; i < steps; ++i) {
            for (int j = 0; j < steps; ++j) {  // equal shares of the projected solid angle
                const double r = std::sqrt((i + 0.5) / steps), phi = (j + 0.5) / steps * 2 * pi;
                const Vec3 d = t * (r * std::cos(phi)) + b * (r * std::sin(phi)) + n * std::sqrt(1 - r * r);
                sum += environment_radiance(e, d) * (1.0f / (steps * steps));
            }
        }
        expect_near(e.irradiance(n), sum, 2e-4);
    }
}

}  // namespace
}  // namespace crescente::render::testing
