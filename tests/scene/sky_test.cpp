#include "scene/sky.h"

#include <gtest/gtest.h>

namespace crescente::scene {
namespace {

using math::Rgb;
using math::Vec3;
using math::pi;
constexpr double degree = pi / 180;

void expect_sun(const Moment& moment, double latitude, double longitude, double azimuth, double elevation, double tolerance) {
    const SunPosition sun = sun_position(moment, latitude * degree, longitude * degree);
    EXPECT_NEAR(sun.elevation / degree, elevation, tolerance);
    EXPECT_NEAR(std::remainder(sun.azimuth / degree - azimuth, 360) * std::cos(sun.elevation), 0, tolerance);
}

TEST(Sun, StandsWhereTheAlmanacSays) {
    // The example of Reda and Andreas 2004 ("Solar Position Algorithm"), of which the elevation is without refraction.
    expect_sun({2003, 10, 17, 19 + 30.0 / 60 + 30.0 / 3600}, 39.742476, -105.1786, 194.3402, 39.8721, 0.02);
    // Noon of an equinox on the equator, and midnight sun at the pole.
    expect_sun({2024, 3, 20, 12 + 7.5 / 60}, 0, 0, 0, 90, 0.3);
    EXPECT_NEAR(sun_position({2024, 6, 20, 21}, pi / 2, 0).elevation / degree, 23.44, 0.02);
}

TEST(Sun, DirectionsGoWithTheCompass) {
    EXPECT_LT(length(direction_to({0, 0}) - Vec3{0, 0, -1}), 1e-12);
    EXPECT_LT(length(direction_to({pi / 2, 0}) - Vec3{1, 0, 0}), 1e-12);
    EXPECT_LT(length(direction_to({1, pi / 2}) - Vec3{0, 1, 0}), 1e-12);
}

TEST(Sun, IsDimmerAndRedderWhenLow) {
    Rgb before{9, 9, 9};
    double before_warmth = 0;
    for (const double height : {80.0, 40.0, 15.0, 5.0, 1.0}) {
        const Rgb now = sun_irradiance({{0, height * degree}, 3});
        EXPECT_LT(now.b, before.b);
        EXPECT_GT(now.r / now.b, before_warmth);
        before = now, before_warmth = now.r / now.b;
    }
    EXPECT_TRUE(is_black(sun_irradiance({{0, -0.01}, 3})));
    // About 100 klx in a high sun and clear air.
    EXPECT_NEAR(luminance(sun_irradiance({{0, 60 * degree}, 2.5})) / daylight_unit, 1e5, 1e4);
}

TEST(Sky, IsBlueAwayFromTheSunAndBrightestAtIt) {
    const Daylight noon{{0, 50 * degree}, 2.5};
    const Vec3 to_sun = direction_to(noon.sun), away = normalize(Vec3{to_sun.x, 1, -to_sun.z});
    const Rgb blue = sky_radiance(noon, away);
    EXPECT_GT(blue.b, 1.4f * blue.r);
    EXPECT_GT(luminance(sky_radiance(noon, to_sun)), 3 * luminance(blue));
    // The zenith's luminance is the model's own formula, kcd/m2.
    const double zenith = (4.0453 * 2.5 - 4.9710) * std::tan((4.0 / 9 - 2.5 / 120) * (pi - 2 * 40 * degree)) - 0.2155 * 2.5 + 2.4192;
    EXPECT_NEAR(luminance(sky_radiance(noon, {0, 1, 0})) / daylight_unit / 1000, zenith, 0.01 * zenith);
    // Hazier air hides the blue.
    const Rgb haze = sky_radiance({noon.sun, 8}, away);
    EXPECT_LT(haze.b / haze.r, blue.b / blue.r);
    EXPECT_TRUE(is_black(sky_radiance({{0, -0.1}, 3}, {0, 1, 0})));
}

TEST(Sky, TheSunIsALightOfItsOwn) {
    const Daylight day{{120 * degree, 35 * degree}, 3};
    const Light sun = sun_of(day, {1, 2, 3}, 0.5, 0);
    EXPECT_LT(length(normalize(sun.position - Vec3{1, 2, 3}) - direction_to(day.sun)), 1e-12);
    const double distance = length(sun.position - Vec3{1, 2, 3});
    EXPECT_NEAR(2 * std::asin(sun.radius / distance) / degree, 0.53, 1e-9);
    const Rgb irradiance = sun.color * static_cast<float>(sun.intensity / (distance * distance)), expected = sun_irradiance(day);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(irradiance[k], expected[k], 1e-5);
    Environment environment;
    environment.sky = "120,35";
    ASSERT_TRUE(make_sky(environment));
    ASSERT_TRUE(environment.panorama && environment.lights());
    const Panorama& around = *environment.panorama;
    const Vec3 up = normalize(Vec3{-0.5, 0.8, 0.1});
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(around.radiance(up)[k], sky_radiance(day, up)[k], 0.01);
    EXPECT_LT(luminance(around.radiance({0, -1, 0})), luminance(around.radiance({0, 1, 0})) * 2);
    // All that reaches level ground: 50 to 100 klx in such a sun.
    const double total = (luminance(around.irradiance({0, 1, 0})) * pi + luminance(expected) * std::sin(35 * degree)) / daylight_unit;
    EXPECT_GT(total, 5e4);
    EXPECT_LT(total, 1e5);
    // A quarter turn counter-clockwise seen from above takes east to north.
    const Light turned = sun_of({{90 * degree, 30 * degree}, 3}, {}, 1, 90 * degree);
    EXPECT_LT(length(normalize(turned.position) - direction_to({0, 30 * degree})), 1e-12);
}

TEST(Sky, IsSaidByAnglesOrByTimeAndPlace) {
    const auto angles = daylight_of("160,40");
    ASSERT_TRUE(angles);
    EXPECT_NEAR(angles->sun.azimuth, 160 * degree, 1e-12);
    EXPECT_EQ(angles->turbidity, 3);
    const auto moment = daylight_of("2024-06-21T12:37:00Z,38.7,-9.1,2.5");
    ASSERT_TRUE(moment);
    EXPECT_NEAR(moment->sun.elevation / degree, 74.7, 0.3);  // about noon at midsummer in Lisbon: 90 - 38.7 + 23.4
    EXPECT_EQ(moment->turbidity, 2.5);
    for (const char* wrong : {"", "1", "1,2,3,4", "1,x", "160,-5", "400,10", "10,95", "10,20,11", "2024-02-30T12:00,38,-9", "2024-06-21T25:00,38,-9", "2024-06-21T12:00,95,0", "2024-06-21T00:00,38.7,-9.1",
                              "10,nan", "10,20,", "2024-06-21T12:00"}) {
        const auto done = daylight_of(wrong);
        ASSERT_FALSE(done) << wrong;
        EXPECT_FALSE(done.error().problems.front().reason.empty());
    }
}

}  // namespace
}  // namespace crescente::scene
