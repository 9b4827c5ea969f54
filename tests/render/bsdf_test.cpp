// Scattering of light by materials, and the directions drawn from it: energy, reciprocity, and that the densities are those of the sampler.
#include "render/bsdf.h"

#include "render/furnace.h"
#include "render/scatter.h"
#include "render/thin_film.h"

namespace crescente::render::testing {
namespace {

struct Named {
    std::string name;
    Lobes lobes;
};

Named physical(std::string name, Rgb color, double metallic, double roughness, double transmission = 0, double opacity = 1, double ior = 1.5) {
    PhysicalMaterial m;
    m.base_color = color, m.metallic = metallic, m.roughness = roughness, m.transmission = transmission, m.opacity = opacity, m.ior = ior;
    return {std::move(name) + " " + std::to_string(roughness), compile({"", m})};
}

// A metal given by its constants under a clear coat; k black: white.
Named coated(std::string name, Rgb eta, Rgb k, double metallic, double roughness, double coat, double coat_roughness) {
    PhysicalMaterial m;
    m.base_color = {1, 1, 1}, m.eta = eta, m.k = k, m.metallic = metallic, m.roughness = roughness, m.clearcoat = coat, m.clearcoat_roughness = coat_roughness;
    return {std::move(name) + " " + std::to_string(roughness), compile({"", m})};
}
// A physical material with something changed.
template <class Change>
Named finished(std::string name, Rgb color, double metallic, double roughness, Change&& change) {
    PhysicalMaterial m;
    m.base_color = color, m.metallic = metallic, m.roughness = roughness;
    change(m);
    Named named{std::move(name) + " " + std::to_string(roughness), compile({"", m})};
    if (named.lobes.grained()) named.lobes.tangent = {1, 0.3, 0};
    return named;
}
const Rgb gold_eta{0.183f, 0.53f, 1.33f}, gold_k{3.41f, 2.25f, 1.87f}, perfect_k{4, 3, 2};  // no eta: nothing is absorbed

Named classic(std::string name, float diffuse, float specular, double shininess, scene::Highlight form, float reflection = 0, float transmission = 0, bool fresnel = false) {
    ClassicMaterial m = matte(gray(diffuse));
    m.specular = gray(specular), m.shininess = shininess, m.highlight = form, m.reflection = gray(reflection), m.transmission = gray(transmission);
    m.ior = 1.5, m.fresnel = fresnel;
    return {std::move(name), compile({"", m})};
}

const std::vector<double> roughnesses{0, 0.1, 0.3, 0.6, 1};
constexpr Rgb one{1, 1, 1};

// Materials that take no light, of every kind of lobe.
std::vector<Named> white() {
    using scene::Highlight;
    std::vector<Named> all;
    for (const double roughness : roughnesses) {
        all.push_back(physical("metal", one, 1, roughness));
        all.push_back(physical("plastic", one, 0, roughness));
        all.push_back(physical("half metal", one, 0.5, roughness));
        all.push_back(physical("glass", one, 0, roughness, 1));
        all.push_back(physical("diamond", one, 0, roughness, 1, 1, 2.4));
        all.push_back(physical("air", one, 0, roughness, 1, 1, 1));
        all.push_back(physical("milk glass", one, 0.2, roughness, 0.5));
        all.push_back(physical("veil", one, 0.3, roughness, 0, 0.6));
        all.push_back(physical("glass veil", one, 0, roughness, 0.7, 0.6));
        all.push_back(coated("perfect metal", {}, perfect_k, 1, roughness, 0, 0));
        all.push_back(coated("perfect half metal", {}, perfect_k, 0.5, roughness, 0, 0));
        all.push_back(coated("coated metal", {}, perfect_k, 1, roughness, 1, 0));
        all.push_back(coated("matt coated metal", {}, perfect_k, 1, roughness, 1, 0.4));
        all.push_back(coated("half coated plastic", {}, {}, 0, roughness, 0.5, 0.2));
        using P = PhysicalMaterial;
        all.push_back(finished("dull plastic", one, 0, roughness, [](P& m) { m.specular = 0.3; }));
        all.push_back(finished("specular plastic", one, 0, roughness, [](P& m) { m.specular_color = {30, 8, 2}; }));
        all.push_back(finished("dull glass", one, 0, roughness, [](P& m) { m.specular = 0.4, m.transmission = 1; }));
        all.push_back(finished("specular glass", one, 0.2, roughness, [](P& m) { m.specular_color = {4, 2, 8}, m.transmission = 0.8; }));
        for (const double anisotropy : {0.4, 0.8}) {
            all.push_back(finished("brushed metal", one, 1, roughness, [=](P& m) { m.anisotropy = anisotropy; }));
            all.push_back(finished("brushed plastic", one, 0, roughness, [=](P& m) { m.anisotropy = anisotropy; }));
            all.push_back(finished("brushed glass", one, 0, roughness, [=](P& m) { m.anisotropy = anisotropy, m.transmission = 1; }));
        }
        for (const double sheen : {0.0, 0.3, 1.0}) all.push_back(finished("cloth", one, 0, roughness, [=](P& m) { m.sheen_color = {0.5f, 1, 0.2f}, m.sheen_roughness = sheen; }));
        all.push_back(finished("coated cloth veil", one, 0.2, roughness, [](P& m) { m.sheen_color = one, m.clearcoat = 0.6, m.opacity = 0.7; }));
        for (const double thickness : {0.0, 180.0, 550.0}) {
            all.push_back(finished("film on metal", one, 1, roughness, [=](P& m) { m.iridescence = 1, m.iridescence_thickness = thickness; }));
            all.push_back(finished("film on plastic", one, 0, roughness, [=](P& m) { m.iridescence = 0.8, m.iridescence_ior = 1.8, m.iridescence_thickness = thickness; }));
            all.push_back(finished("bubble", one, 0, roughness, [=](P& m) { m.iridescence = 1, m.iridescence_thickness = thickness, m.transmission = 1; }));
        }
        all.push_back(finished("coat of its own", one, 0.5, roughness, [](P& m) { m.clearcoat = 1, m.clearcoat_roughness = 0.2; }));
        all.back().lobes.coat_normal = normalize(Vec3{0.2, -0.1, 1});
    }
    all.push_back(classic("matte", 1, 0, 1, Highlight::phong));
    all.push_back(classic("phong", 0.5f, 0.5f, 20, Highlight::phong));
    all.push_back(classic("blinn", 0.5f, 0.5f, 20, Highlight::blinn));
    all.push_back(classic("broad phong", 0.5f, 0.5f, 0.5, Highlight::phong));
    all.push_back(classic("broad blinn", 0.5f, 0.5f, 2, Highlight::blinn));
    all.push_back(classic("whitted", 0.3f, 0.2f, 50, Highlight::phong, 0.3f, 0.2f));
    all.push_back(classic("classic glass", 0, 0, 1, Highlight::phong, 1, 1, true));
    return all;
}

const std::vector<double> views{0.01, 0.6, 1.1, 1.4, 1.54};

TEST(Bsdf, GivesBackNoMoreThanItGets) {
    for (const Named& m : white()) {
        for (const bool inside : {false, true}) {
            for (const double view : views) {
                const double back = furnace(m.lobes, view, inside);
                EXPECT_LE(back, 1.006) << m.name << " " << view << (inside ? " inside" : "");
                const double least = m.name.starts_with("specular plastic") ? 0.05 : 0.3;  // coloured
                EXPECT_GE(back, least) << m.name << " " << view << (inside ? " inside" : "");
            }
        }
    }
}

TEST(Bsdf, RoughMetalAndGlassLoseNothing) {
    for (const double roughness : roughnesses) {
        for (const double view : views) {
            EXPECT_GE(furnace(physical("", one, 1, roughness).lobes, view, false), 0.98) << roughness << " " << view;
            EXPECT_GE(furnace(coated("", {}, perfect_k, 1, roughness, 0, 0).lobes, view, false), 0.98) << roughness << " " << view;
            for (const double ior : {1.2, 1.5, 2.4}) {
                for (const bool inside : {false, true}) EXPECT_GE(furnace(physical("", one, 0, roughness, 1, 1, ior).lobes, view, inside), 0.98) << roughness << " " << view << " " << ior << inside;
            }
        }
    }
}

TEST(Bsdf, WhiteDielectricsLoseNothing) {
    for (const double roughness : roughnesses) {
        for (const double ior : {1.0, 1.1, 1.33, 1.5, 1.8, 2.4, 5.0}) {
            const Lobes plain = physical("", one, 0, roughness, 0, 1, ior).lobes, milky = physical("", one, 0, roughness, 0.5, 1, ior).lobes;
            for (const double view : views) {
                EXPECT_NEAR(furnace(plain, view, false), 0.993, 0.013) << roughness << " " << view << " " << ior;
                EXPECT_NEAR(furnace(milky, view, false), 0.993, 0.013) << "milky " << roughness << " " << view << " " << ior;
                // From inside a rough one loses near the angle of total reflection, where the tables are too coarse for what rises so steeply; and gains nowhere.
                const double inner = furnace(milky, view, true);
                EXPECT_LE(inner, 1.006) << "milky inside " << roughness << " " << view << " " << ior;
                EXPECT_GE(inner, roughness == 0 && ior < 5 ? 0.98 : 0.6) << "milky inside " << roughness << " " << view << " " << ior;
            }
        }
    }
}

// What is over the diffuse lobe takes from it what it reflects, and no more.
TEST(Bsdf, LayersOverWhiteLoseLittle) {
    for (const double roughness : roughnesses) {
        const std::vector<Named> layered{finished("lacquer", one, 0, roughness, [](PhysicalMaterial& m) { m.clearcoat = 1; }),
                                         finished("matt lacquer", one, 0, roughness, [](PhysicalMaterial& m) { m.clearcoat = 0.7, m.clearcoat_roughness = 0.5; }),
                                         finished("velvet", one, 0, roughness, [](PhysicalMaterial& m) { m.sheen_color = gray(0.8f); }),
                                         finished("lacquered velvet", one, 0, roughness, [](PhysicalMaterial& m) { m.sheen_color = gray(0.8f), m.clearcoat = 1; }),
                                         finished("film", one, 0, roughness, [](PhysicalMaterial& m) { m.iridescence = 1, m.iridescence_ior = 1.33, m.specular = 0; }),
                                         finished("brushed", one, 0, roughness, [](PhysicalMaterial& m) { m.anisotropy = 0.6; }),
                                         finished("metal", one, 1, roughness, [](PhysicalMaterial& m) { m.clearcoat = 1; }),
                                         finished("metal, velvet", one, 1, roughness, [](PhysicalMaterial& m) { m.sheen_color = gray(0.8f); })};
        for (const Named& m : layered) {
            const double least = m.name.starts_with("film") ? 0.85 : 0.96;  // coloured
            for (const double view : views) {
                const double back = furnace(m.lobes, view, false);
                EXPECT_LE(back, 1.006) << m.name << " " << view;
                EXPECT_GE(back, least) << m.name << " " << view;
            }
        }
    }
}

TEST(Bsdf, BrushedMetalLosesLittle) {
    for (const double roughness : {0.2, 0.4, 0.7}) {
        for (const double anisotropy : {0.3, 0.6, 0.9}) {
            for (const double view : {0.01, 0.6, 1.1, 1.4}) {
                const double back = furnace(finished("", one, 1, roughness, [=](PhysicalMaterial& m) { m.anisotropy = anisotropy; }).lobes, view, false);
                EXPECT_NEAR(back, 0.99, 0.016) << roughness << " " << anisotropy << " " << view;
            }
        }
    }
}

// The lobe of a brushed surface is wide along the grain.
TEST(Bsdf, GrainDrawsOutTheHighlight) {
    Lobes steel = finished("", one, 1, 0.3, [](PhysicalMaterial& m) { m.anisotropy = 0.7; }).lobes;
    steel.tangent = {0, 2, 0};
    const Facing facing{up, up, false};
    EXPECT_GT(scatter(steel, facing, up, direction(0.5, pi / 2)).glossy.g, 8 * scatter(steel, facing, up, direction(0.5, 0)).glossy.g);
    EXPECT_EQ(reflect_light(steel, up, up, direction(0.5, pi / 2), std::cos(0.5), true), scatter(steel, facing, up, direction(0.5, pi / 2)).glossy) << "lights without extent";
}

TEST(Bsdf, SpecularFactorsWeighTheReflection) {
    const auto mirrored = [](double specular, Rgb color, double theta) {
        return child_weights(finished("", {}, 0, 0, [=](PhysicalMaterial& m) { m.specular = specular, m.specular_color = color; }).lobes, std::cos(theta), false).reflected;
    };
    expect_near(mirrored(1, one, 0), gray(0.04f), 1e-6);
    expect_near(mirrored(0.5, {2, 1, 100}, 0), {0.04f, 0.02f, 0.5f}, 1e-6);
    expect_near(mirrored(0.5, {2, 1, 100}, pi / 2), gray(0.5f), 1e-6);
    EXPECT_NEAR(furnace(finished("", gray(0.6f), 0, 0.5, [](PhysicalMaterial& m) { m.specular = 0; }).lobes, 1.2, false), 0.6, 2e-3) << "nothing but the diffuse lobe is left";
}

TEST(Bsdf, ThinFilms) {
    for (const float f0 : {0.04f, 0.6f}) {
        expect_near(thin_film_reflectance(1, 1.3, 0, gray(f0)), gray(f0), 1e-5);
        // So thick that waves of all lengths are mixed: the sum of the reflections between the two faces.
        const double root = std::sqrt(f0), base = (1 + root) / (1 - root), cosine = 0.6, inner = std::sqrt(1 - (1 - cosine * cosine) / (1.3 * 1.3));
        const double r12 = fresnel_dielectric(cosine, 1.3), r23 = fresnel_dielectric(inner, base / 1.3), both = r12 + (1 - r12) * (1 - r12) * r23 / (1 - r12 * r23);
        expect_near(thin_film_reflectance(cosine, 1.3, 20000, gray(f0)), gray(static_cast<float>(both)), 1e-3);
    }
    // A quarter of a green wave takes most of the reflection of glass away (an antireflective coat); half a wave, nothing of green.
    EXPECT_LT(thin_film_reflectance(1, 1.23, 550 / 1.23 / 4, gray(0.04f)).g, 0.003f);
    EXPECT_NEAR(thin_film_reflectance(1, 1.23, 550 / 1.23 / 2, gray(0.04f)).g, 0.04f, 0.004f);
    EXPECT_LT(thin_film_reflectance(1, 1.23, 550 / 1.23 / 2, gray(0.04f)).b, 0.03f);
}

TEST(Bsdf, ClothSendsBackWhatTheSumsSay) {
    for (const double roughness : {0.3, 0.6, 1.0}) {
        const Lobes cloth = finished("", {}, 0, 1, [=](PhysicalMaterial& m) { m.sheen_color = one, m.sheen_roughness = roughness, m.specular = 0; }).lobes;
        for (const double theta : {0.2, 0.9, 1.4}) EXPECT_NEAR(furnace(cloth, theta, false), sheen_reflectance(cloth, std::cos(theta)), 0.01) << roughness << " " << theta;
    }
}

TEST(Bsdf, ClassicSharesAreWhatComesBack) {
    const auto back = [](float diffuse, float specular, double n, scene::Highlight form) { return furnace(classic("", diffuse, specular, n, form).lobes, 0.01, false); };
    EXPECT_NEAR(back(0.7f, 0, 1, scene::Highlight::phong), 0.7, 1e-3);
    EXPECT_NEAR(back(0, 0.5f, 9, scene::Highlight::phong), 0.5 * 2 / 10, 1e-3) << "the integral of a power of the cosine, over pi";
    EXPECT_NEAR(back(0, 0.5f, 0.2, scene::Highlight::phong), 0.5, 1e-3) << "no more than its strength";
    EXPECT_LE(back(0, 0.5f, 1, scene::Highlight::blinn), 0.5);
}

// The same light as the levels that do not sample see.
TEST(Bsdf, AgreesWithLightsWithoutExtent) {
    Random random(11);
    for (const Named& m : white()) {
        const bool fresnel = m.lobes.transmits();  // reflect_light knows Schlick's approximation alone
        for (int i = 0; i < 100 && !fresnel; ++i) {
            const Vec3 v = direction(random.uniform(0, 1.5), random.uniform(0, 7)), l = direction(random.uniform(0, 1.5), random.uniform(0, 7));
            const Scattered s = scatter(m.lobes, {up, up, false}, v, l);
            const float unit = m.lobes.layered() ? 1 : static_cast<float>(1 / pi);
            const Rgb diffuse = reflect_light(m.lobes, up, v, l, l.z, false) * unit, whole = reflect_light(m.lobes, up, v, l, l.z, true) * unit;
            expect_near(s.diffuse, diffuse, 1e-5);
            if (m.lobes.layered() ? m.lobes.alpha <= smoothest_alpha || (m.lobes.coat > 0 && m.lobes.coat_is_smooth()) : m.name.starts_with("broad")) continue;  // a mirror, or kept from giving back too much
            const float size = 1 + max_component(whole);
            expect_near((s.diffuse + s.glossy) * (1 / size), whole * (1 / size), 2e-5);
        }
    }
}

// f is the same both ways; through the surface, but for the squares of the indices (f over the cosine of the light is what scatter returns of f).
TEST(Bsdf, IsReciprocal) {
    Random random(12);
    int crossing = 0;
    for (const Named& m : white()) {
        if (!m.lobes.layered() || m.lobes.coat_normal != Vec3{}) continue;  // Phong's model is not, nor are surfaces of two normals
        for (int i = 0; i < 400; ++i) {
            const Vec3 v = direction(random.uniform(0, 1.5), random.uniform(0, 7));
            Vec3 l = direction(random.uniform(0, 1.5), random.uniform(0, 7));
            const bool inside = i % 2, through = i % 4 > 1;
            if (through) l = -l;
            const double index_v = inside ? m.lobes.ior : 1, index_l = inside != through ? m.lobes.ior : 1;
            const Facing there{up, up, inside}, back{through ? -up : up, through ? -up : up, inside != through};
            const Scattered a = scatter(m.lobes, there, v, l), b = scatter(m.lobes, back, l, v);
            const double x = (a.diffuse.g + a.glossy.g) * std::abs(v.z) * index_v * index_v, y = (b.diffuse.g + b.glossy.g) * std::abs(l.z) * index_l * index_l;
            EXPECT_NEAR(x, y, 1e-5 * (1 + x)) << m.name << (through ? " through" : "") << (inside ? " inside" : "");
            crossing += through && x > 0;
        }
    }
    EXPECT_GT(crossing, 500);
}

// Directions by cells of equal solid angle, on both sides; the density in a cell is integrated by its means over ever smaller parts.
struct Cells {
    static constexpr int heights = 24, turns = 24;

    static std::size_t of(Vec3 d) {
        const auto i = std::min(heights - 1, static_cast<int>((d.z + 1) / 2 * heights)), j = std::min(turns - 1, static_cast<int>((std::atan2(d.y, d.x) / (2 * pi) + 0.5) * turns));
        return static_cast<std::size_t>(i * turns + j);
    }
    static double integral(const std::function<double(Vec3)>& density, double z0, double z1, double t0, double t1, int depth = 0) {
        const auto sum = [&](int n) {
            double all = 0;
            for (int i = 0; i < n; ++i) {
                for (int j = 0; j < n; ++j) {
                    const double z = z0 + (z1 - z0) * (i + 0.5) / n, t = t0 + (t1 - t0) * (j + 0.5) / n, r = std::sqrt(std::max(0.0, 1 - z * z));
                    all += density({r * std::cos(t), r * std::sin(t), z});
                }
            }
            return all / (n * n) * (z1 - z0) * (t1 - t0);
        };
        const double coarse = sum(2), fine = sum(5);
        if ((depth > 1 && std::abs(coarse - fine) < 1e-6 + 1e-3 * fine) || depth == 8) return fine;
        const double z = (z0 + z1) / 2, t = (t0 + t1) / 2;
        return integral(density, z0, z, t0, t, depth + 1) + integral(density, z, z1, t0, t, depth + 1) + integral(density, z0, z, t, t1, depth + 1) + integral(density, z, z1, t, t1, depth + 1);
    }
    static std::vector<double> integrals(const std::function<double(Vec3)>& density) {
        std::vector<double> all;
        for (int i = 0; i < heights; ++i) {
            for (int j = 0; j < turns; ++j) {
                const auto at = [](int k, int n, double from, double to) { return from + (to - from) * k / n; };
                all.push_back(integral(density, at(i, heights, -1, 1), at(i + 1, heights, -1, 1), at(j, turns, -pi, pi), at(j + 1, turns, -pi, pi)));
            }
        }
        return all;
    }
};

// Upper tail of the chi-square distribution (Wilson and Hilferty 1931), good beyond 30 degrees of freedom and no worse than a factor of two below.
double tail_of_chi_square(double statistic, int freedom) {
    const double k = freedom, z = (std::cbrt(statistic / k) - (1 - 2 / (9 * k))) / std::sqrt(2 / (9 * k));
    return 0.5 * std::erfc(z / std::sqrt(2.0));
}

// Pearson's test at a significance of 1e-4 for all cases together (Sidak 1967). What is not drawn from a rough lobe is a cell of its own. Cells that expect
// few are merged.
void expect_density_of_sampler(const Named& m, double theta, bool inside, bool with_delta, int cases) {
    constexpr int draws = 20000;
    const Facing facing{up, up, inside};
    const Vec3 v = direction(theta, 0.7);
    const std::string what = m.name + " " + std::to_string(theta) + (inside ? " inside" : "") + (with_delta ? " with delta" : "");
    std::vector<double> expected = Cells::integrals([&](Vec3 d) { return scatter(m.lobes, facing, v, d, with_delta).pdf; });
    double rough = 0;
    for (double& e : expected) rough += e, e *= draws;
    EXPECT_LE(rough, 1.002) << what;
    expected.push_back(std::max(0.0, 1 - rough) * draws);
    std::vector<double> found(expected.size());
    Random random(13);
    for (int i = 0; i < draws; ++i) {
        const auto s = sample_scatter(m.lobes, facing, v, {random.uniform(), random.uniform(), random.uniform()}, with_delta);
        ++found[s && !s->delta ? Cells::of(s->direction) : expected.size() - 1];
        if (!s) continue;
        EXPECT_NEAR(length(s->direction), 1, 1e-12);
        if (s->delta) {
            EXPECT_TRUE(with_delta);
            continue;
        }
        EXPECT_EQ(s->crosses, s->direction.z < 0);
        EXPECT_EQ(s->value.pdf, scatter(m.lobes, facing, v, s->direction, with_delta).pdf) << what;
    }
    double statistic = 0, few_expected = 0, few_found = 0;
    int cells = 0;
    const auto add = [&](double e, double f) { statistic += (f - e) * (f - e) / e, ++cells; };
    for (std::size_t i = 0; i < expected.size(); ++i) {
        if (expected[i] >= 8) {
            add(expected[i], found[i]);
        } else {
            few_expected += expected[i], few_found += found[i];
            if (few_expected >= 8) add(few_expected, few_found), few_expected = few_found = 0;
        }
    }
    if (few_expected > 0.5) add(few_expected, few_found);
    else EXPECT_LE(few_found, 12) << what << ": drawn where the density says never";
    if (cells < 2) return;
    EXPECT_GT(tail_of_chi_square(statistic, cells - 1), 1 - std::pow(1 - 1e-4, 1.0 / cases)) << what << ": " << statistic << " in " << cells << " cells";
}

TEST(Bsdf, DensityIsThatOfTheSampler) {
    using scene::Highlight;
    struct Case {
        Named material;
        bool both_sides;
    };
    std::vector<Case> all{{classic("matte", 0.7f, 0, 1, Highlight::phong), false},
                          {classic("phong", 0.3f, 0.5f, 12, Highlight::phong, 0.2f), false},
                          {classic("blinn", 0.2f, 0.6f, 25, Highlight::blinn), false},
                          {physical("veil", {0.9f, 0.5f, 0.2f}, 0.4, 0.5, 0, 0.6), false}};
    for (const double roughness : {0.25, 0.5, 1.0}) {
        all.push_back({physical("metal", {0.9f, 0.6f, 0.2f}, 1, roughness), false});
        all.push_back({physical("plastic", {0.2f, 0.6f, 0.8f}, 0, roughness), false});
        all.push_back({physical("glass", {0.9f, 1, 0.9f}, 0, roughness, 1), true});
    }
    all.push_back({coated("gold", gold_eta, gold_k, 1, 0.35, 0, 0), false});
    all.push_back({coated("coated gold", gold_eta, gold_k, 0.6, 0.5, 0.7, 0.3), false});
    all.push_back({coated("glossy coat", {}, {}, 0, 0.6, 1, 0), false});
    all.push_back({physical("milk glass", {0.9f, 1, 0.9f}, 0.1, 0.4, 0.6, 0.8, 1.8), true});
    using P = PhysicalMaterial;
    all.push_back({finished("brushed metal", {0.9f, 0.6f, 0.2f}, 1, 0.4, [](P& m) { m.anisotropy = 0.7; }), false});
    all.push_back({finished("brushed glass", one, 0, 0.4, [](P& m) { m.anisotropy = 0.6, m.transmission = 1; }), true});
    all.push_back({finished("cloth", {0.1f, 0.2f, 0.5f}, 0, 0.8, [](P& m) { m.sheen_color = {0.3f, 0.5f, 1}, m.sheen_roughness = 0.3; }), false});
    all.push_back({finished("bubble", one, 0, 0.3, [](P& m) { m.iridescence = 1, m.transmission = 1, m.specular = 0.7; }), true});
    all.push_back({finished("coat of its own", one, 0.5, 0.5, [](P& m) { m.clearcoat = 1, m.clearcoat_roughness = 0.4; }), false});
    all.back().material.lobes.coat_normal = normalize(Vec3{0.2, -0.1, 1});
    const std::vector<double> thetas{0.2, 0.9, 1.4};
    int cases = 0;
    for (const Case& c : all) cases += static_cast<int>(thetas.size()) * (c.both_sides ? 2 : 1);
    for (const Case& c : all) {
        for (const double theta : thetas) {
            for (int side = 0; side < (c.both_sides ? 2 : 1); ++side) expect_density_of_sampler(c.material, theta, side == 1, theta == 0.9, cases);
        }
    }
}

// The mean of value over density is the integral of the value: over all directions, without drawing.
TEST(Bsdf, DrawnMeanIsTheIntegral) {
    for (const Named& m : {physical("metal", {0.9f, 0.6f, 0.2f}, 1, 0.5), physical("glass", {0.9f, 1, 0.9f}, 0, 0.6, 1), physical("plastic", {0.2f, 0.6f, 0.8f}, 0, 0.4)}) {
        const Facing facing{up, up, false};
        const Vec3 v = direction(0.8, 0.3);
        double whole = 0, drawn = 0;
        for (const double part : Cells::integrals([&](Vec3 d) {
                 const Scattered s = scatter(m.lobes, facing, v, d);
                 return double(s.diffuse.g) + s.glossy.g;
             })) {
            whole += part;
        }
        for_each_draw(20000, [&](std::array<double, 3> u) {
            if (const auto s = sample_scatter(m.lobes, facing, v, u, false)) drawn += (s->value.diffuse.g + s->value.glossy.g) / s->value.pdf / 20000;
        });
        EXPECT_NEAR(drawn, whole, 2e-3) << m.name;
    }
}

TEST(Bsdf, NormalsThatDisagreeLetNothingThrough) {
    const Lobes lobes = physical("", one, 0, 0.5, 0.5).lobes;
    const Facing facing{normalize(Vec3{0.5, 0, 1}), up, false};
    const Vec3 v = direction(0.3, 0);
    EXPECT_EQ(scatter(lobes, facing, v, normalize(Vec3{1, 0, -0.1})).pdf, 0) << "in front of the shading normal alone";
    EXPECT_EQ(scatter(lobes, facing, v, normalize(Vec3{-1, 0, 0.1})).pdf, 0) << "in front of the true normal alone";
    EXPECT_FALSE(sample_scatter(lobes, facing, direction(1.7, 0), {0.1, 0.2, 0.3}, true)) << "the back";
    for_each_draw(1600, [&](std::array<double, 3> u) {
        if (const auto s = sample_scatter(lobes, facing, v, u, false)) {
            EXPECT_EQ(s->direction.z < 0, s->crosses);
            EXPECT_EQ(dot(s->direction, facing.shading) < 0, s->crosses);
        }
    });
}

TEST(Bsdf, MetalsReflectAsFresnelSays) {
    for (const double roughness : {0.0, 0.05}) {
        for (double theta = 0.1; theta < 1.4; theta += 0.2) {
            const Lobes gold = coated("", gold_eta, gold_k, 1, roughness, 0, 0).lobes;
            const Rgb expected = fresnel_conductor(std::cos(theta), gold_eta, gold_k);
            EXPECT_NEAR(furnace(gold, theta, false), expected.g, 3e-3);
            if (!gold.smooth()) continue;
            expect_near(smooth_weights(gold, std::cos(theta), false).reflected, expected, 1e-6);
            expect_near(child_weights(gold, std::cos(theta), false).reflected, expected, 1e-6);
        }
    }
}

TEST(Bsdf, SmoothLobesAreRays) {
    const Vec3 v = direction(0.7, 0.2);
    for (const bool inside : {false, true}) {
        const Facing facing{up, up, inside};
        const Lobes glass = physical("glass", {0.9f, 0.8f, 0.7f}, 0, 0, 1, 0.9).lobes;
        const ChildWeights weights = child_weights(glass, v.z, inside), smooth = smooth_weights(glass, v.z, inside);
        expect_near(smooth.reflected, weights.reflected, 1e-6), expect_near(smooth.refracted, weights.refracted, 1e-6);
        double chances = 0;
        Rgb sum[3];
        for_each_draw(10000, [&](std::array<double, 3> u) {
            const auto s = sample_scatter(glass, facing, v, u, true);
            ASSERT_TRUE(s && s->delta);
            const Vec3 reflected{-v.x, -v.y, v.z};
            const int ray = !s->crosses ? 0 : length(s->direction + v) < 1e-9 ? 2 : 1;
            const double sine = std::hypot(s->direction.x, s->direction.y), snell = std::hypot(v.x, v.y) * (inside ? 1.5 : 1 / 1.5);
            EXPECT_TRUE(ray != 0 || length(s->direction - reflected) < 1e-9);
            EXPECT_TRUE(ray != 1 || std::abs(sine - snell) < 1e-9);
            sum[ray] += s->value.glossy * static_cast<float>(1 / s->value.pdf / 1e4);
            chances += 1 / s->value.pdf;
        });
        expect_near(sum[0], smooth.reflected, 2e-3), expect_near(sum[1], smooth.refracted, 2e-3), expect_near(sum[2], glass.straight, 2e-3);
        EXPECT_FALSE(sample_scatter(glass, facing, v, {0.5, 0.5, 0.5}, false)) << "nothing else";
    }
}

TEST(Bsdf, AnyNumbersGiveFiniteValues) {
    Random random(14);
    for (const Named& m : white()) {
        for (int i = 0; i < 300; ++i) {
            const auto number = [&] { return random.chance(0.2) ? 0.0 : random.chance(0.2) ? 1 - 0x1p-53 : random.uniform(); };
            const Vec3 v = direction(random.chance(0.3) ? pi / 2 - std::pow(10, random.uniform(-9, -2)) : random.uniform(0, 1.57), random.uniform(0, 7));
            const auto s = sample_scatter(m.lobes, {up, up, random.chance(0.5)}, v, {number(), number(), number()}, random.chance(0.5));
            if (!s) continue;
            EXPECT_TRUE(is_finite(s->direction) && is_finite(s->value.diffuse) && is_finite(s->value.glossy) && std::isfinite(s->value.pdf)) << m.name;
            EXPECT_GT(s->value.pdf, 0);
            EXPECT_GE(std::min({s->value.diffuse.r, s->value.diffuse.g, s->value.diffuse.b, s->value.glossy.r, s->value.glossy.g, s->value.glossy.b}), 0);
        }
    }
}

}  // namespace
}  // namespace crescente::render::testing
