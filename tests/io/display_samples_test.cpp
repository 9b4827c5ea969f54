// What display formats are given.
#include "io/display_samples.h"

#include <gtest/gtest.h>

#include "scene/tonemap.h"

namespace crescente::io {
namespace {

TEST(DisplaySamples, APartIsWhatTheWholeHasThere) {
    std::vector<float> values;
    for (int i = 0; i < 300; ++i) values.push_back(0.01f * static_cast<float>(i));
    const auto whole = display_samples<std::uint8_t>(values, 3, AlphaIs::straight, scene::Tonemap::neutral, 0.5);
    const auto part = display_samples<std::uint8_t>(std::span(values).subspan(60, 90), 3, AlphaIs::straight, scene::Tonemap::neutral, 0.5);
    ASSERT_EQ(whole.size(), 300u);
    EXPECT_TRUE(std::equal(part.begin(), part.end(), whole.begin() + 60));
}

TEST(DisplaySamples, GreyServesForAllColours) {
    const float grey[] = {0.25f, 0.5f};
    const auto samples = display_samples<std::uint8_t>(grey, 1, AlphaIs::straight, scene::Tonemap::srgb, 0);
    ASSERT_EQ(samples.size(), 6u);
    EXPECT_EQ(samples[0], samples[1]);
    EXPECT_EQ(samples[0], samples[2]);
    EXPECT_LT(samples[0], samples[3]);
}

TEST(DisplaySamples, AlphaIsApartOrMultipliedIn) {
    const float half[] = {0.2f, 0.2f, 0.2f, 0.5f};
    const auto straight = display_samples<std::uint8_t>(half, 4, AlphaIs::straight, scene::Tonemap::srgb, 0), multiplied = display_samples<std::uint8_t>(half, 4, AlphaIs::multiplied, scene::Tonemap::srgb, 0);
    EXPECT_EQ(straight[3], 128);
    EXPECT_EQ(multiplied[3], 128);
    EXPECT_EQ(straight[0], static_cast<std::uint8_t>(scene::srgb_encode(0.4f) * 255 + 0.5f));
    EXPECT_NEAR(multiplied[0], straight[0] / 2, 1);
}

}  // namespace
}  // namespace crescente::io
