#include "scene/material_library.h"

#include <algorithm>

namespace crescente::scene {
namespace {

using math::Vec3;

// Complex indices, read off the published tables at 630, 532 and 465 nm (between the two nearest wavelengths, linearly), as tabulated by refractiveindex.info (CC0).
struct Metal {
    const char* name;
    Rgb eta, k;
    const char* source;
};

constexpr const char* noble = "P. B. Johnson and R. W. Christy, Phys. Rev. B 6, 4370 (1972)";
constexpr const char* transition = "P. B. Johnson and R. W. Christy, Phys. Rev. B 9, 5056 (1974)";

constexpr Metal metals[] = {
    {"aluminium", {1.430f, 0.939f, 0.686f}, {7.508f, 6.420f, 5.635f}, "A. D. Rakic, Appl. Opt. 34, 4755 (1995)"},
    {"brass", {0.445f, 0.568f, 0.947f}, {3.522f, 2.588f, 1.920f}, "M. R. Querry, Optical constants, CRDC-CR-85034 (1985): 70 % Cu, 30 % Zn"},
    {"chromium", {3.145f, 3.034f, 2.456f}, {3.312f, 3.330f, 3.210f}, transition},
    {"cobalt", {2.209f, 2.001f, 1.789f}, {4.160f, 3.735f, 3.371f}, transition},
    {"copper", {0.275f, 1.116f, 1.247f}, {3.373f, 2.596f, 2.456f}, noble},
    {"gold", {0.188f, 0.544f, 1.332f}, {3.403f, 2.231f, 1.869f}, noble},
    {"iron", {2.892f, 2.895f, 2.646f}, {3.065f, 2.918f, 2.805f}, transition},
    {"nickel", {1.990f, 1.877f, 1.765f}, {4.094f, 3.495f, 3.048f}, transition},
    {"palladium", {1.765f, 1.597f, 1.445f}, {4.275f, 3.743f, 3.351f}, transition},
    {"platinum", {2.310f, 2.046f, 1.887f}, {4.147f, 3.602f, 3.224f}, "A. D. Rakic et al., Appl. Opt. 37, 5271 (1998), Lorentz-Drude"},
    {"silver", {0.057f, 0.054f, 0.047f}, {4.254f, 3.429f, 2.803f}, noble},
    {"stainless steel", {2.141f, 1.846f, 1.561f}, {3.419f, 3.113f, 2.839f}, "B. Karlsson and C. G. Ribbing, J. Appl. Phys. 53, 6340 (1982): ferritic, 13.5 % Cr"},
    {"titanium", {2.698f, 2.479f, 2.305f}, {3.757f, 3.351f, 3.082f}, transition},
    {"vanadium", {3.450f, 3.915f, 3.744f}, {3.042f, 3.125f, 3.404f}, transition},
};

struct Finish {
    const char* name;
    double roughness;
};
constexpr Finish finishes[] = {{"polished", 0.03}, {"satin", 0.25}, {"blasted", 0.5}};

// A procedure carved from a block, of the given size (m) along an axis.
Texture carved(TextureKind kind, double size, Rgb a = {1, 1, 1}, Rgb b = {0, 0, 0}, Vec3 axis = {1, 0, 0}) {
    Texture t;
    t.kind = kind, t.projection = TextureProjection::solid, t.size = size, t.color_a = a, t.color_b = b, t.axis = axis;
    return t;
}

// Scratches along the grain, which make some lines of the surface rougher than others.
std::vector<TextureBinding> scratches(double width, Grain grain) {
    if (grain == Grain::around) return {};  // whose scratches are no straight lines
    Texture lines = carved(TextureKind::brushed, width, {1, 1, 1}, {0.55f, 0.55f, 0.55f});
    lines.stretch = 120;
    return {{"roughness", lines}};
}

PhysicalMaterial brushed(PhysicalMaterial m, double roughness, double anisotropy, Grain grain) {
    m.roughness = roughness, m.anisotropy = anisotropy, m.grain = grain;
    if (grain == Grain::around) m.grain_axis = {0, 1, 0};
    return m;
}

// Flakes of aluminium in a clear base under a clear coat: mirrors of a cell each, whose slopes differ.
std::vector<TextureBinding> flakes(double size, double slopes) {
    Texture normals = carved(TextureKind::flakes, size);
    normals.strength = slopes;
    return {{"normal", normals}, {"base_color", carved(TextureKind::flakes, size, {1, 1, 1}, {0.45f, 0.45f, 0.45f})}};
}

// Rings about a trunk along x; colours of early and late wood.
std::vector<TextureBinding> rings(double width, Rgb early, Rgb late) { return {{"base_color", carved(TextureKind::wood, width, early, late)}}; }

// Grains of hide, raised by `height` (m), darker between.
std::vector<TextureBinding> hide(double grain, double height) {
    Texture bumps = carved(TextureKind::leather, grain);
    bumps.strength = height;
    return {{"bump", bumps}, {"base_color", carved(TextureKind::leather, grain, {1, 1, 1}, {0.7f, 0.68f, 0.66f})}};
}

PhysicalMaterial metal(const Metal& of, double roughness) {
    PhysicalMaterial m;
    m.base_color = {1, 1, 1}, m.metallic = 1, m.roughness = roughness, m.eta = of.eta, m.k = of.k;
    return m;
}

PhysicalMaterial dielectric(Rgb color, double roughness, double ior) {
    PhysicalMaterial m;
    m.base_color = color, m.roughness = roughness, m.ior = ior;
    return m;
}

PhysicalMaterial coated(Rgb color, double metallic, double roughness) {
    PhysicalMaterial m = dielectric(color, roughness, 1.5);
    m.metallic = metallic, m.clearcoat = 1;
    return m;
}

// What anodising makes of aluminium: the metal seen through a dyed layer, as one tinted reflectance.
PhysicalMaterial tinted_metal(Rgb color, double roughness) {
    PhysicalMaterial m;
    m.base_color = color, m.metallic = 1, m.roughness = roughness;
    return m;
}

// attenuation: 1/m.
PhysicalMaterial transparent(double ior, double roughness, Rgb attenuation) {
    PhysicalMaterial m;
    m.base_color = {1, 1, 1}, m.roughness = roughness, m.ior = ior, m.transmission = 1, m.attenuation = attenuation;
    return m;
}

std::vector<LibraryMaterial> make_library() {
    std::vector<LibraryMaterial> all;
    for (const Metal& m : metals) {
        for (const Finish& finish : finishes) all.push_back({std::string(m.name) + " " + finish.name, "Metals", m.source, metal(m, finish.roughness)});
    }
    const auto add = [&all](const char* group, const char* name, const char* note, const PhysicalMaterial& m, std::vector<TextureBinding> textures = {}) {
        all.push_back({name, group, note, m, std::move(textures)});
    };
    constexpr const char* brush = "Brushed metals";
    const auto brushed_metal = [&](const char* of, const char* name, double roughness, double anisotropy, Grain grain, const char* note) {
        const auto* found = std::find_if(std::begin(metals), std::end(metals), [of](const Metal& m) { return std::string_view(m.name) == of; });
        add(brush, name, note, brushed(metal(*found, roughness), roughness, anisotropy, grain), scratches(1.5e-4, grain));
    };
    constexpr const char *line_grain = "grain along an axis, or along u of meshes with texture coordinates", *lathe = "turned: grain about an upright axis";
    brushed_metal("aluminium", "aluminium brushed", 0.22, 0.6, Grain::automatic, line_grain);
    brushed_metal("aluminium", "aluminium turned", 0.16, 0.65, Grain::around, lathe);
    brushed_metal("stainless steel", "stainless steel brushed", 0.25, 0.6, Grain::automatic, line_grain);
    brushed_metal("stainless steel", "stainless steel turned", 0.18, 0.65, Grain::around, lathe);
    brushed_metal("brass", "brass brushed", 0.22, 0.6, Grain::automatic, line_grain);
    brushed_metal("copper", "copper brushed", 0.24, 0.55, Grain::automatic, line_grain);
    brushed_metal("titanium", "titanium brushed", 0.28, 0.55, Grain::automatic, line_grain);
    brushed_metal("nickel", "nickel brushed", 0.2, 0.6, Grain::automatic, line_grain);

    constexpr const char* anodised = "Anodised aluminium";
    all.push_back({"anodised clear", anodised, metals[0].source, metal(metals[0], 0.35)});
    add(anodised, "anodised black", "dyed", tinted_metal({0.03f, 0.03f, 0.032f}, 0.4));
    add(anodised, "anodised blue", "dyed", tinted_metal({0.05f, 0.15f, 0.55f}, 0.35));
    add(anodised, "anodised gold", "dyed", tinted_metal({0.75f, 0.53f, 0.20f}, 0.35));
    add(anodised, "anodised green", "dyed", tinted_metal({0.06f, 0.35f, 0.12f}, 0.35));
    add(anodised, "anodised orange", "dyed", tinted_metal({0.85f, 0.25f, 0.03f}, 0.35));
    add(anodised, "anodised purple", "dyed", tinted_metal({0.25f, 0.07f, 0.45f}, 0.35));
    add(anodised, "anodised gray brushed", "dyed after brushing", brushed(tinted_metal({0.28f, 0.29f, 0.31f}, 0.3), 0.3, 0.5, Grain::automatic), scratches(1.5e-4, Grain::automatic));
    PhysicalMaterial interference = tinted_metal({0.65f, 0.62f, 0.58f}, 0.25);
    interference.iridescence = 1, interference.iridescence_ior = 2.3, interference.iridescence_thickness = 130;
    add(anodised, "titanium anodised gold", "titanium under 130 nm of its oxide, index 2.3: the colour is interference", interference);
    interference.iridescence_thickness = 185;
    add(anodised, "titanium anodised purple", "titanium under 185 nm of its oxide, index 2.3", interference);
    add(anodised, "anodised red", "dyed", tinted_metal({0.55f, 0.03f, 0.03f}, 0.35));

    constexpr const char* plastic = "Plastics";
    add(plastic, "plastic glossy black", "ABS, index 1.54", dielectric({0.02f, 0.02f, 0.02f}, 0.12, 1.54));
    add(plastic, "plastic glossy white", "ABS, index 1.54", dielectric({0.8f, 0.8f, 0.78f}, 0.12, 1.54));
    add(plastic, "plastic matte black", "textured ABS, index 1.54", dielectric({0.03f, 0.03f, 0.03f}, 0.5, 1.54));
    add(plastic, "plastic matte gray", "textured ABS, index 1.54", dielectric({0.32f, 0.32f, 0.33f}, 0.5, 1.54));
    add(plastic, "plastic matte white", "textured ABS, index 1.54", dielectric({0.78f, 0.78f, 0.76f}, 0.5, 1.54));
    add(plastic, "plastic soft-touch black", "lacquered with polyurethane, index 1.5", dielectric({0.025f, 0.025f, 0.025f}, 0.8, 1.5));
    add(plastic, "nylon natural", "polyamide, index 1.53", dielectric({0.72f, 0.69f, 0.6f}, 0.4, 1.53));

    constexpr const char* paint = "Paints";
    add(paint, "paint black", "solid, under a clear coat", coated({0.01f, 0.01f, 0.01f}, 0, 0.4));
    add(paint, "paint blue", "solid, under a clear coat", coated({0.02f, 0.08f, 0.4f}, 0, 0.4));
    add(paint, "paint green", "solid, under a clear coat", coated({0.02f, 0.22f, 0.07f}, 0, 0.4));
    add(paint, "paint red", "solid, under a clear coat", coated({0.5f, 0.015f, 0.01f}, 0, 0.4));
    add(paint, "paint white", "solid, under a clear coat", coated({0.8f, 0.8f, 0.79f}, 0, 0.4));
    add(paint, "paint yellow", "solid, under a clear coat", coated({0.75f, 0.42f, 0.01f}, 0, 0.4));
    add(paint, "paint metallic blue", "aluminium pigment, under a clear coat; the flakes are too small to see", coated({0.05f, 0.15f, 0.45f}, 0.8, 0.4));
    add(paint, "paint metallic gray", "aluminium pigment, under a clear coat; the flakes are too small to see", coated({0.25f, 0.26f, 0.28f}, 0.8, 0.4));
    add(paint, "paint metallic silver", "aluminium pigment, under a clear coat; the flakes are too small to see", coated({0.62f, 0.63f, 0.65f}, 0.8, 0.4));
    add(paint, "paint flake silver", "aluminium flakes of 0.2 mm under a clear coat; from afar a rough metal", coated({0.8f, 0.81f, 0.83f}, 1, 0.18), flakes(2e-4, 0.13));
    add(paint, "paint flake blue", "tinted flakes of 0.2 mm under a clear coat", coated({0.06f, 0.2f, 0.6f}, 1, 0.18), flakes(2e-4, 0.13));
    add(paint, "paint flake red", "tinted flakes of 0.2 mm under a clear coat", coated({0.6f, 0.03f, 0.03f}, 1, 0.18), flakes(2e-4, 0.13));
    add(paint, "paint flake green coarse", "tinted flakes of 0.5 mm under a clear coat", coated({0.08f, 0.4f, 0.15f}, 1, 0.16), flakes(5e-4, 0.17));
    PhysicalMaterial pearl = coated({0.78f, 0.78f, 0.8f}, 0.3, 0.3);
    pearl.iridescence = 0.7, pearl.iridescence_ior = 1.9, pearl.iridescence_thickness = 260;
    add(paint, "paint pearl white", "mica under a clear coat: a film of 260 nm, index 1.9", pearl);
    add(paint, "powder coat black", "polyester powder, without a coat", dielectric({0.025f, 0.025f, 0.025f}, 0.6, 1.5));
    add(paint, "powder coat white", "polyester powder, without a coat", dielectric({0.76f, 0.76f, 0.74f}, 0.6, 1.5));

    constexpr const char* glass = "Glasses and clear materials";
    add(glass, "glass clear", "soda-lime, index 1.52", transparent(1.52, 0, {0.8f, 0.2f, 0.6f}));
    add(glass, "glass frosted", "etched soda-lime, index 1.52", transparent(1.52, 0.4, {0.8f, 0.2f, 0.6f}));
    add(glass, "glass green", "bottle glass, index 1.52", transparent(1.52, 0, {120, 25, 110}));
    add(glass, "glass brown", "bottle glass, index 1.52", transparent(1.52, 0, {40, 130, 500}));
    add(glass, "glass crown", "BK7, index 1.517", transparent(1.517, 0, {0, 0, 0}));
    add(glass, "glass flint", "SF10, index 1.728", transparent(1.728, 0, {0, 0, 0}));
    add(glass, "acrylic", "PMMA, index 1.491", transparent(1.491, 0, {0, 0, 0}));
    add(glass, "acrylic satin", "PMMA, index 1.491, satin surface", transparent(1.491, 0.3, {0, 0, 0}));
    add(glass, "polycarbonate", "index 1.585", transparent(1.585, 0, {0.5f, 0.3f, 1.0f}));
    add(glass, "water", "index 1.333", transparent(1.333, 0, {0.3f, 0.05f, 0.02f}));
    add(glass, "sapphire", "index 1.768, without birefringence", transparent(1.768, 0, {0, 0, 0}));
    add(glass, "diamond", "index 2.417, Abbe number 55", transparent(2.417, 0, {0, 0, 0}));
    all.back().material.dispersion = 20 / 55.3;
    add(glass, "glass flint dispersing", "SF10, index 1.728, Abbe number 28.4", transparent(1.728, 0, {0, 0, 0}));
    all.back().material.dispersion = 20 / 28.4;

    constexpr const char* rubber = "Rubber";
    add(rubber, "rubber black", "filled with carbon black, index 1.52", dielectric({0.018f, 0.018f, 0.018f}, 0.7, 1.52));
    add(rubber, "rubber gray", "index 1.52", dielectric({0.2f, 0.2f, 0.2f}, 0.7, 1.52));
    add(rubber, "rubber red", "index 1.52", dielectric({0.35f, 0.03f, 0.02f}, 0.7, 1.52));
    add(rubber, "silicone white", "index 1.41", dielectric({0.7f, 0.7f, 0.69f}, 0.6, 1.41));

    constexpr const char* ceramic = "Ceramic";
    PhysicalMaterial glazed = coated({0.8f, 0.79f, 0.76f}, 0, 0.6);
    add(ceramic, "porcelain", "white body under a glaze", glazed);
    glazed.base_color = {0.02f, 0.025f, 0.03f};
    add(ceramic, "ceramic glazed black", "dark body under a glaze", glazed);
    glazed.base_color = {0.03f, 0.12f, 0.35f};
    add(ceramic, "ceramic glazed blue", "coloured body under a glaze", glazed);
    add(ceramic, "ceramic matte white", "unglazed, index 1.5", dielectric({0.78f, 0.77f, 0.74f}, 0.8, 1.5));
    add(ceramic, "terracotta", "unglazed, index 1.5", dielectric({0.45f, 0.16f, 0.08f}, 0.9, 1.5));

    constexpr const char* wood = "Wood";
    const auto oiled = dielectric({1, 1, 1}, 0.45, 1.5);
    PhysicalMaterial varnished = coated({1, 1, 1}, 0, 0.5);
    varnished.clearcoat_roughness = 0.08;
    add(wood, "oak oiled", "rings of 3 mm about an axis", oiled, rings(0.003, {0.50f, 0.31f, 0.15f}, {0.27f, 0.145f, 0.06f}));
    add(wood, "walnut oiled", "rings of 4 mm about an axis", oiled, rings(0.004, {0.20f, 0.105f, 0.055f}, {0.075f, 0.035f, 0.018f}));
    add(wood, "beech oiled", "rings of 2.5 mm about an axis", oiled, rings(0.0025, {0.60f, 0.38f, 0.22f}, {0.46f, 0.26f, 0.13f}));
    add(wood, "pine raw", "rings of 5 mm about an axis", dielectric({1, 1, 1}, 0.7, 1.5), rings(0.005, {0.72f, 0.50f, 0.26f}, {0.48f, 0.25f, 0.08f}));
    add(wood, "cherry varnished", "rings of 3 mm about an axis, under a varnish", varnished, rings(0.003, {0.42f, 0.17f, 0.07f}, {0.24f, 0.08f, 0.03f}));

    constexpr const char* leather = "Leather and cloth";
    add(leather, "leather black", "grains of 1.2 mm, raised by 0.1 mm", dielectric({0.025f, 0.023f, 0.022f}, 0.45, 1.5), hide(0.0012, 1e-4));
    add(leather, "leather brown", "grains of 1.2 mm, raised by 0.1 mm", dielectric({0.16f, 0.06f, 0.025f}, 0.45, 1.5), hide(0.0012, 1e-4));
    add(leather, "leather tan coarse", "grains of 2.5 mm, raised by 0.25 mm", dielectric({0.42f, 0.2f, 0.08f}, 0.5, 1.5), hide(0.0025, 2.5e-4));
    PhysicalMaterial cloth = dielectric({0.03f, 0.05f, 0.14f}, 0.9, 1.5);
    cloth.specular = 0.3, cloth.sheen_color = {0.5f, 0.62f, 0.95f}, cloth.sheen_roughness = 0.5;
    add(leather, "velvet blue", "with a sheen of upright fibres", cloth);
    cloth.base_color = {0.16f, 0.015f, 0.02f}, cloth.sheen_color = {0.95f, 0.5f, 0.5f}, cloth.sheen_roughness = 0.5;
    add(leather, "velvet red", "with a sheen of upright fibres", cloth);
    cloth.base_color = {0.3f, 0.29f, 0.27f}, cloth.sheen_color = {0.35f, 0.35f, 0.35f}, cloth.sheen_roughness = 0.8;
    add(leather, "felt gray", "with a sheen of fibres in all directions", cloth);
    return all;
}

}  // namespace

std::span<const LibraryMaterial> material_library() {
    static const std::vector<LibraryMaterial> library = make_library();
    return library;
}

const std::vector<std::string>& library_names() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> all;
        for (const LibraryMaterial& m : material_library()) all.push_back(m.name);
        return all;
    }();
    return names;
}

const LibraryMaterial* find_in_library(std::string_view name) {
    const auto library = material_library();
    const auto found = std::find_if(library.begin(), library.end(), [name](const LibraryMaterial& m) { return m.name == name; });
    return found == library.end() ? nullptr : &*found;
}

}  // namespace crescente::scene
