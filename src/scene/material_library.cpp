#include "scene/material_library.h"

#include <algorithm>

namespace crescente::scene {
namespace {

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
    const auto add = [&all](const char* group, const char* name, const char* note, const PhysicalMaterial& m) { all.push_back({name, group, note, m}); };

    constexpr const char* anodised = "Anodised aluminium";
    all.push_back({"anodised clear", anodised, metals[0].source, metal(metals[0], 0.35)});
    add(anodised, "anodised black", "dyed", tinted_metal({0.03f, 0.03f, 0.032f}, 0.4));
    add(anodised, "anodised blue", "dyed", tinted_metal({0.05f, 0.15f, 0.55f}, 0.35));
    add(anodised, "anodised gold", "dyed", tinted_metal({0.75f, 0.53f, 0.20f}, 0.35));
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
    add(glass, "diamond", "index 2.417", transparent(2.417, 0, {0, 0, 0}));

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
    add(ceramic, "ceramic matte white", "unglazed, index 1.5", dielectric({0.78f, 0.77f, 0.74f}, 0.8, 1.5));
    add(ceramic, "terracotta", "unglazed, index 1.5", dielectric({0.45f, 0.16f, 0.08f}, 0.9, 1.5));
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
