// Daylight: a clear sky and the sun, by the sun's place or by date, time and place on the earth.
#pragma once

#include <memory>
#include <string>

#include "base/error.h"
#include "scene/environment.h"
#include "scene/light.h"

namespace crescente::scene {

// Where the sun stands. Radians; azimuth from north by east. North is -z, east +x, up +y.
struct SunPosition {
    double azimuth = 0, elevation = 0;
};

// A moment, in universal time (UTC), of the Gregorian calendar.
struct Moment {
    int year = 2000, month = 1, day = 1;
    double hour = 12;  // 0 to 24, with fractions
};

// Latitude north and longitude east, radians. To about 0.01 degrees from 1950 to 2050, without refraction (Michalsky 1988, "The Astronomical Almanac's
// Algorithm for Approximate Solar Position").
SunPosition sun_position(const Moment& moment, double latitude, double longitude);

// Unit.
math::Vec3 direction_to(const SunPosition& sun);

struct Daylight {
    SunPosition sun;
    double turbidity = 3;  // how hazy the air is: 2 (very clear) to 10 (haze)
};

// Radiance in units of 1 / 30000 of a candela and square metre, which gives a white wall in full sun about 1.
inline constexpr double daylight_unit = 3e-5;

// Radiance of the clear sky in a direction (unit) at or above the horizon; black if the sun is below the horizon (Preetham, Shirley and Smits 1999, "A
// Practical Analytic Model for Daylight", appendix A.2).
math::Rgb sky_radiance(const Daylight& daylight, math::Vec3 direction);

// Irradiance of what faces the sun, by the sun alone: what the air lets through at the wavelengths of the three primaries (the same, appendix A.1: air molecules and
// aerosols; air mass by Kasten and Young 1989).
math::Rgb sun_irradiance(const Daylight& daylight);

// "AZIMUTH,ELEVATION" or "2024-06-21T14:30,LATITUDE,LONGITUDE" (universal time), in degrees, either with ",TURBIDITY" after it. Errors (input): anything else,
// numbers out of range, a sun below the horizon.
Expected<Daylight> daylight_of(const std::string& text);

// The sky above a grey ground, on which nothing casts a shadow.
std::shared_ptr<const Panorama> panorama_of(const Daylight& daylight);

// Gives an environment that says a sky its panorama. Errors: as daylight_of.
Expected<void> make_sky(Environment& environment);

// The sun as a distant sphere that the camera does not see, 0.53 degrees wide. `center` and `radius` of what is to be lit, metres; the sky is turned by `rotation` about +y, radians.
Light sun_of(const Daylight& daylight, math::Vec3 center, double radius, double rotation);

}  // namespace crescente::scene
