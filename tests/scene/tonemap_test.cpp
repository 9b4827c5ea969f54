#include "scene/tonemap.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

using namespace crescente;
using math::Rgb;
using scene::Tonemap;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float nan_value = std::numeric_limits<float>::quiet_NaN();

// Floats of all sizes, the special ones, and those around each code's threshold.
std::vector<float> trial_values() {
    std::vector<float> values{0.0f, -0.0f, -1.0f, 1.0f, 2.0f, infinity, -infinity, nan_value, std::numeric_limits<float>::denorm_min()};
    for (int code = 0; code < 255; ++code) {
        float edge = scene::srgb_decode((float(code) + 0.5f) / 255.0f);
        for (int i = 0; i < 4; ++i) edge = std::nextafter(edge, 0.0f);
        for (int i = 0; i < 9; ++i, edge = std::nextafter(edge, 2.0f)) values.push_back(edge);
    }
    std::mt19937 random{1};
    for (int i = 0; i < 100000; ++i) values.push_back(std::bit_cast<float>(std::uint32_t(random())));
    for (int i = 0; i < 100000; ++i) values.push_back(std::uniform_real_distribution<float>{0, 1.1f}(random));
    while (values.size() % 3) values.push_back(0.5f);
    return values;
}

template <class Sample>
void expect_image_equals_display(Tonemap tonemap, double exposure) {
    const auto values = trial_values();
    std::vector<Sample> out(values.size());
    scene::display_image(values, tonemap, exposure, std::span<Sample>(out));
    const float top = float(std::numeric_limits<Sample>::max());
    for (std::size_t i = 0; i < values.size(); i += 3) {
        const Rgb c = scene::display({values[i], values[i + 1], values[i + 2]}, tonemap, exposure);
        for (int k = 0; k < 3; ++k) ASSERT_EQ(int(out[i + k]), int(c[k] * top + 0.5f)) << values[i] << " " << values[i + 1] << " " << values[i + 2];
    }
}

}  // namespace

TEST(Srgb, KnownValues) {
    // From IEC 61966-2-1: the linear toe, the junction, and middle grey.
    EXPECT_FLOAT_EQ(scene::srgb_encode(0.002f), 0.02584f);
    EXPECT_NEAR(scene::srgb_encode(0.0031308f), 0.04045f, 1e-5);
    EXPECT_NEAR(scene::srgb_encode(0.5f), 0.735357f, 1e-6);
    EXPECT_EQ(scene::srgb_encode(1.0f), 1.0f);
    EXPECT_NEAR(scene::srgb_decode(128.0f / 255.0f), 0.2158605f, 1e-6);
}

TEST(Srgb, EveryCodeComesBack) {
    for (int code = 0; code < 65536; ++code) {
        const float encoded = float(code) / 65535.0f;
        EXPECT_EQ(int(scene::srgb_encode(scene::srgb_decode(encoded)) * 65535.0f + 0.5f), code);
    }
}

TEST(Display, TableIsExact) {
    for (const Tonemap tonemap : {Tonemap::srgb, Tonemap::neutral}) {
        for (const double exposure : {0.0, 1.5, -3.0}) {
            expect_image_equals_display<std::uint8_t>(tonemap, exposure);
            expect_image_equals_display<std::uint16_t>(tonemap, exposure);
        }
    }
}

// From the formulas of the specification, worked out by hand.
TEST(Display, NeutralAsSpecified) {
    // Below compression only the Fresnel offset is taken away: 0.5 - 0.04.
    EXPECT_NEAR(scene::srgb_decode(scene::display({0.5f, 0.6f, 0.7f}, Tonemap::neutral, 0).r), 0.46f, 1e-5);
    EXPECT_NEAR(scene::srgb_decode(scene::display({0.5f, 0.6f, 0.7f}, Tonemap::neutral, 0).b), 0.66f, 1e-5);
    // A dark colour: offset x - 6.25 x^2 leaves 6.25 x^2.
    EXPECT_NEAR(scene::srgb_decode(scene::display({0.04f, 0.04f, 0.04f}, Tonemap::neutral, 0).g), 0.01f, 1e-5);
    // Grey 2: peak 1.96, new peak 1 - 0.24^2 / (1.96 + 0.24 - 0.76).
    EXPECT_NEAR(scene::srgb_decode(scene::display({2, 2, 2}, Tonemap::neutral, 0).r), 0.96f, 1e-5);
    // Very bright colours end in white, without NaN.
    for (const float c : {1e6f, infinity}) {
        const Rgb white = scene::display({c, c / 2, c / 4}, Tonemap::neutral, 0);
        EXPECT_GT(white.b, 0.98f);
        EXPECT_LE(white.r, 1.0f);
    }
}

TEST(Display, ExposureIsInStops) {
    EXPECT_EQ(scene::display({0.1f, 0.2f, 0.3f}, Tonemap::srgb, 1), scene::display({0.2f, 0.4f, 0.6f}, Tonemap::srgb, 0));
}

TEST(AutomaticExposure, MakesTheLogAverageMiddleGrey) {
    const std::vector<float> even(12, 0.36f);
    EXPECT_DOUBLE_EQ(scene::automatic_exposure(even, 3), -1);
    const std::vector<float> two{0.045f, 0.045f, 0.045f, 0.72f, 0.72f, 0.72f};  // two stops below and above
    EXPECT_DOUBLE_EQ(scene::automatic_exposure(two, 3), 0);
    // What is transparent does not count, nor what is black or no number; alpha is multiplied in.
    const std::vector<float> apart{0.18f, 0.18f, 0.18f, 0.5f, 0, 0, 0, 0, infinity, 1, 1, 1};
    EXPECT_DOUBLE_EQ(scene::automatic_exposure(apart, 4), -1);
    EXPECT_EQ(scene::automatic_exposure(std::vector<float>(9, 0.0f), 3), 0);
    // A tenth of bright pixels before much dark: they are kept from burning out.
    std::vector<float> dark(3 * 90, 0.01f);
    dark.resize(3 * 100, 8.0f);
    EXPECT_DOUBLE_EQ(scene::automatic_exposure(dark, 3), -3);
    // Fewer may.
    std::fill_n(dark.begin() + 3 * 90, 3 * 7, 0.01f);
    EXPECT_GT(scene::automatic_exposure(dark, 3), 2);
    EXPECT_EQ(scene::automatic_exposure({}, 3), 0);
}
