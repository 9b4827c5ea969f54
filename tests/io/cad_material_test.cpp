// Colours of CAD files become the materials that docs/cad.md says.
#include "io/cad_material.h"

#include <gtest/gtest.h>

namespace crescente::io {
namespace {

const scene::PhysicalMaterial& model_of(const scene::Material& material) { return std::get<scene::PhysicalMaterial>(material.model); }

TEST(CadMaterial, SaturationAndBrightnessDecide) {
    const auto name = [](float r, float g, float b, float alpha = 1) { return cad_material({{r, g, b}, alpha}).name; };
    EXPECT_EQ(name(1, 0, 0), "plastic #ff0000");
    EXPECT_EQ(name(0, 0, 0), "plastic #000000");
    EXPECT_EQ(name(1, 1, 1), "plastic #ffffff");
    EXPECT_TRUE(name(0.3f, 0.3f, 0.3f).starts_with("metal #"));
    EXPECT_TRUE(name(0.5f, 0.4f, 0.25f).starts_with("painted metal #"));
    EXPECT_TRUE(name(0, 0, 1, 0.5f).starts_with("glass #0000ff"));
    EXPECT_TRUE(name(0, 0, 1, 0.99f).starts_with("plastic"));
    EXPECT_EQ(uncolored_cad_material().name, "uncoloured");
}

TEST(CadMaterial, GlassLetsThroughMoreColorTheLessTransparentItIs) {
    const auto clear = cad_material({{0, 0, 1}, 0.1f}), dense = cad_material({{0, 0, 1}, 0.9f});
    EXPECT_EQ(model_of(clear).transmission, 1);
    EXPECT_NEAR(model_of(clear).base_color.r, 0.9f, 1e-6f);
    EXPECT_NEAR(model_of(dense).base_color.r, 0.1f, 1e-6f);
    EXPECT_EQ(model_of(dense).base_color.b, 1);
}

TEST(CadMaterial, ValuesOutOfRangeAreBroughtIn) {
    const auto material = cad_material({{-1, 7, 0.5f}, 1});
    EXPECT_EQ(model_of(material).base_color, (math::Rgb{0, 1, 0.5f}));
}

}  // namespace
}  // namespace crescente::io
