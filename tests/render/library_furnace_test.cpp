// The library's materials where light is everywhere: none adds to it, and white versions of them take little.
#include "render/furnace.h"
#include "scene/material_library.h"

namespace crescente::render::testing {
namespace {

TEST(LibraryFurnace, AddsNoLight) {
    for (const scene::LibraryMaterial& m : scene::material_library()) {
        const Lobes lobes = compile({m.name, m.material});
        for (const double view : {0.01, 0.9, 1.4}) {
            for (int side = 0; side < (m.material.transmission > 0 ? 2 : 1); ++side) EXPECT_LE(furnace(lobes, view, side == 1), 1.006) << m.name << " " << view;
        }
    }
}

// KHR_materials_ior: an index of 0 stands for infinite, by which all is reflected, in the color of the reflection.
TEST(Furnace, InfiniteIndexReflectsAll) {
    for (const double roughness : {0.0, 0.3, 0.8}) {
        const auto of = [&](double specular, Rgb color, double transmission) {
            PhysicalMaterial m;
            m.base_color = {0.2f, 0.5f, 0.9f}, m.roughness = roughness, m.ior = 0, m.specular = specular, m.specular_color = color, m.transmission = transmission;
            return compile({"", m});
        };
        for (const double view : {0.01, 0.6, 1.1, 1.4, 1.54}) {
            EXPECT_NEAR(furnace(of(1, {1, 1, 1}, 0), view, false), 1, 0.02) << roughness << " " << view;
            EXPECT_NEAR(furnace(of(1, {1, 1, 1}, 1), view, false), 1, 0.02) << "nothing gets in";
            EXPECT_LE(furnace(of(0.5, {1, 1, 1}, 0), view, false), 0.5 + 0.5 * 0.5 + 0.02) << "half of it, and of the rest the color below";
        }
        if (roughness == 0) expect_near(child_weights(of(1, {0.9f, 0.3f, 0.1f}, 0), 1, false).reflected, {0.9f, 0.3f, 0.1f}, 1e-5);
    }
}

// The library in white: all that a material is but its colours. Metals reflect all, whatever is over them.
TEST(LibraryFurnace, InWhiteLosesLittle) {
    for (const scene::LibraryMaterial& m : scene::material_library()) {
        PhysicalMaterial white = m.material;
        white.base_color = white.specular_color = {1, 1, 1}, white.attenuation = {}, white.emissive = {};
        white.sheen_color = gray(max_component(white.sheen_color)), white.iridescence = 0;  // films are colors
        if (white.metallic > 0 && !is_black(white.k)) white.eta = {}, white.k = {4, 3, 2};  // no eta: nothing is absorbed
        Lobes lobes = compile({m.name, white});
        if (lobes.grained()) lobes.tangent = {1, 0.3, 0};
        double least = 1, most = 0;
        for (const double view : {0.01, 0.6, 1.1, 1.4}) {
            const double back = furnace(lobes, view, false);
            least = std::min(least, back), most = std::max(most, back);
        }
        EXPECT_LE(most, 1.006) << m.name;
        EXPECT_GE(least, 0.98) << m.name;
    }
}

}  // namespace
}  // namespace crescente::render::testing
