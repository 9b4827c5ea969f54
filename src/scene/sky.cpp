#include "scene/sky.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>

namespace crescente::scene {
namespace {

using math::Rgb;
using math::Vec3;
using math::pi;

constexpr double degree = pi / 180;
constexpr double ground_albedo = 0.2;

double within_turn(double angle, double turn) { return angle - turn * std::floor(angle / turn); }

// Days from noon of 1 January 2000 (the Julian date less 2451545).
double days_from_2000(const Moment& m) {
    const int a = (14 - m.month) / 12, y = m.year + 4800 - a, month = m.month + 12 * a - 3;
    const int julian_day = m.day + (153 * month + 2) / 5 + 365 * y + y / 4 - y / 100 + y / 400 - 32045;
    return julian_day - 2451545 + (m.hour - 12) / 24;
}

// How brightness, or a coordinate of colour, goes over the sky (Perez, Seals and Michalsky 1993).
struct Perez {
    double a, b, c, d, e;
    double at(double cos_zenith, double cos_sun) const {
        const double angle = std::acos(std::clamp(cos_sun, -1.0, 1.0));
        return (1 + a * std::exp(b / std::max(cos_zenith, 0.01))) * (1 + c * std::exp(d * angle) + e * cos_sun * cos_sun);
    }
};

// Luminance in kcd/m2, and CIE x and y.
struct SkyModel {
    std::array<Perez, 3> over;
    std::array<double, 3> zenith;

    SkyModel(double t, double cos_sun) {
        over = {{{0.1787 * t - 1.4630, -0.3554 * t + 0.4275, -0.0227 * t + 5.3251, 0.1206 * t - 2.5771, -0.0670 * t + 0.3703},
                 {-0.0193 * t - 0.2592, -0.0665 * t + 0.0008, -0.0004 * t + 0.2125, -0.0641 * t - 0.8989, -0.0033 * t + 0.0452},
                 {-0.0167 * t - 0.2608, -0.0950 * t + 0.0092, -0.0079 * t + 0.2102, -0.0441 * t - 1.6537, -0.0109 * t + 0.0529}}};
        const double s = std::acos(std::clamp(cos_sun, 0.0, 1.0)), s2 = s * s, s3 = s2 * s;
        zenith = {(4.0453 * t - 4.9710) * std::tan((4.0 / 9 - t / 120) * (pi - 2 * s)) - 0.2155 * t + 2.4192,
                  t * t * (0.00166 * s3 - 0.00375 * s2 + 0.00209 * s) + t * (-0.02903 * s3 + 0.06377 * s2 - 0.03202 * s + 0.00394) +
                      (0.11693 * s3 - 0.21196 * s2 + 0.06052 * s + 0.25886),
                  t * t * (0.00275 * s3 - 0.00610 * s2 + 0.00317 * s) + t * (-0.04214 * s3 + 0.08970 * s2 - 0.04153 * s + 0.00516) +
                      (0.15346 * s3 - 0.26756 * s2 + 0.06670 * s + 0.26688)};
        for (std::size_t i = 0; i < 3; ++i) zenith[i] /= over[i].at(1, cos_sun);
    }

    Rgb radiance(double cos_zenith, double cos_angle) const {
        std::array<double, 3> v;
        for (std::size_t i = 0; i < 3; ++i) v[i] = zenith[i] * over[i].at(cos_zenith, cos_angle);
        const double luminance = std::max(0.0, v[0]) * 1000 * daylight_unit, x = v[1], y = std::max(v[2], 1e-3);
        const double cie_x = luminance * x / y, cie_z = luminance * (1 - x - y) / y;
        const auto light = [](double c) { return static_cast<float>(std::max(0.0, c)); };  // to Rec. 709
        return {light(3.2406 * cie_x - 1.5372 * luminance - 0.4986 * cie_z), light(-0.9689 * cie_x + 1.8758 * luminance + 0.0415 * cie_z),
                light(0.0557 * cie_x - 0.2040 * luminance + 1.0570 * cie_z)};
    }
};

int days_in(int year, int month) {
    constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    return days[month - 1] + (month == 2 && year % 4 == 0);  // right for the years that are let through
}

// "2024-06-21T14:30", with seconds and a Z if one likes.
std::optional<Moment> moment_of(const std::string& text) {
    Moment m;
    int hours = 0, minutes = 0, seconds = 0, end = 0;
    if (std::sscanf(text.c_str(), "%4d-%2d-%2dT%2d:%2d%n", &m.year, &m.month, &m.day, &hours, &minutes, &end) != 5) return std::nullopt;
    std::string rest = text.substr(static_cast<std::size_t>(end));
    if (!rest.empty() && rest.front() == ':') {
        int more = 0;
        if (std::sscanf(rest.c_str(), ":%2d%n", &seconds, &more) != 1) return std::nullopt;
        rest.erase(0, static_cast<std::size_t>(more));
    }
    if (!rest.empty() && rest != "Z") return std::nullopt;
    const bool date = m.year >= 1950 && m.year <= 2050 && m.month >= 1 && m.month <= 12 && m.day >= 1 && m.day <= days_in(m.year, m.month);
    if (!date || hours < 0 || hours > 23 || minutes < 0 || minutes > 59 || seconds < 0 || seconds > 59) return std::nullopt;
    m.hour = hours + minutes / 60.0 + seconds / 3600.0;
    return m;
}

// Numbers between commas; nothing if there is anything else.
std::optional<std::vector<double>> numbers_of(std::string_view text) {
    std::vector<double> numbers;
    while (true) {
        const auto comma = text.find(',');
        const std::string_view one = text.substr(0, comma);
        double value = 0;
        const auto [end, error] = std::from_chars(one.data(), one.data() + one.size(), value);
        if (error != std::errc{} || end != one.data() + one.size() || !std::isfinite(value)) return std::nullopt;
        numbers.push_back(value);
        if (comma == std::string_view::npos) return numbers;
        text.remove_prefix(comma + 1);
    }
}

}  // namespace

SunPosition sun_position(const Moment& moment, double latitude, double longitude) {
    const double n = days_from_2000(moment);
    const double mean_longitude = within_turn(280.460 + 0.9856474 * n, 360), anomaly = within_turn(357.528 + 0.9856003 * n, 360) * degree;
    const double ecliptic = (mean_longitude + 1.915 * std::sin(anomaly) + 0.020 * std::sin(2 * anomaly)) * degree, obliquity = (23.439 - 4e-7 * n) * degree;
    const double ascension = std::atan2(std::cos(obliquity) * std::sin(ecliptic), std::cos(ecliptic));
    const double declination = std::asin(std::sin(obliquity) * std::sin(ecliptic));
    const double sidereal = within_turn(6.697375 + 0.0657098242 * n + moment.hour, 24) * 15 * degree + longitude;  // local
    const double hour_angle = sidereal - ascension;
    // East, north and up of the direction to the sun.
    const double east = -std::cos(declination) * std::sin(hour_angle);
    const double north = std::sin(declination) * std::cos(latitude) - std::cos(declination) * std::sin(latitude) * std::cos(hour_angle);
    const double up = std::sin(declination) * std::sin(latitude) + std::cos(declination) * std::cos(latitude) * std::cos(hour_angle);
    return {within_turn(std::atan2(east, north), 2 * pi), std::asin(std::clamp(up, -1.0, 1.0))};
}

Vec3 direction_to(const SunPosition& sun) {
    const double level = std::cos(sun.elevation);
    return {level * std::sin(sun.azimuth), std::sin(sun.elevation), -level * std::cos(sun.azimuth)};
}

Rgb sky_radiance(const Daylight& daylight, Vec3 direction) {
    const Vec3 to_sun = direction_to(daylight.sun);
    return to_sun.y > 0 ? SkyModel(daylight.turbidity, to_sun.y).radiance(direction.y, dot(direction, to_sun)) : Rgb{};
}

Rgb sun_irradiance(const Daylight& daylight) {
    constexpr double outside = 128000;  // lux above the air
    if (!(daylight.sun.elevation > 0)) return {};
    const double height = daylight.sun.elevation / degree;
    const double mass = 1 / (std::sin(daylight.sun.elevation) + 0.50572 * std::pow(height + 6.07995, -1.6364));
    const double haze = 0.04608365822050 * daylight.turbidity - 0.04586025928522;
    const auto passes = [&](double micrometres) {
        return static_cast<float>(outside * daylight_unit * std::exp(-mass * (0.008735 * std::pow(micrometres, -4.08) + haze * std::pow(micrometres, -1.3))));
    };
    return {passes(0.612), passes(0.549), passes(0.465)};
}

Expected<Daylight> daylight_of(const std::string& text) {
    const auto wrong = [&](std::string reason, std::string hint = {}) { return failure(ErrorKind::input, {"", "", std::move(reason), std::move(hint)}); };
    constexpr const char* forms = "write azimuth,elevation or 2024-06-21T14:30,latitude,longitude, in degrees and universal time (1950 to 2050), and a turbidity after it if you like";
    const std::string shown = "'" + text.substr(0, 100) + "'";
    std::string_view numbers_text = text;
    std::optional<Moment> moment;
    if (text.find('T') != std::string::npos) {
        const auto comma = text.find(',');
        moment = moment_of(text.substr(0, comma));
        if (!moment || comma == std::string::npos) return wrong(shown + " says no date, time and place", forms);
        numbers_text.remove_prefix(comma + 1);
    }
    const auto numbers = numbers_of(numbers_text);
    if (!numbers || numbers->size() < 2 || numbers->size() > 3) return wrong(shown + " says no place of the sun", forms);
    const double first = (*numbers)[0], second = (*numbers)[1];
    Daylight daylight;
    if (numbers->size() == 3) daylight.turbidity = (*numbers)[2];
    if (!(daylight.turbidity >= 2 && daylight.turbidity <= 10)) return wrong("the turbidity must be from 2 (very clear) to 10 (haze)");
    if (moment) {
        if (std::abs(first) > 90 || std::abs(second) > 180) return wrong("a latitude is from -90 to 90, a longitude from -180 to 180");
        daylight.sun = sun_position(*moment, first * degree, second * degree);
    } else {
        if (std::abs(first) > 360 || std::abs(second) > 90) return wrong("an azimuth is from -360 to 360, an elevation up to 90");
        daylight.sun = {first * degree, second * degree};
    }
    if (!(daylight.sun.elevation > 0)) {
        char height[64];
        std::snprintf(height, sizeof height, "the sun stands at %.1f degrees, below the horizon", daylight.sun.elevation / degree);
        return wrong(height);
    }
    return daylight;
}

std::shared_ptr<const Panorama> panorama_of(const Daylight& daylight) {
    constexpr int width = 512, height = 256;
    const Vec3 to_sun = direction_to(daylight.sun);
    const SkyModel model(daylight.turbidity, to_sun.y);
    std::vector<Rgb> pixels;
    double level[3] = {0, 0, 0};  // irradiance of the ground by the sky
    for (int row = 0; row < height / 2; ++row) {
        const double up = std::cos(pi * (row + 0.5) / height), flat = std::sqrt(1 - up * up);
        const double angle = (std::cos(pi * row / height) - std::cos(pi * (row + 1) / height)) * 2 * pi / width;
        for (int column = 0; column < width; ++column) {
            const double turn = 2 * pi * ((column + 0.5) / width - 0.5);
            const Rgb p = model.radiance(up, dot(Vec3{flat * std::cos(turn), up, flat * std::sin(turn)}, to_sun));
            pixels.push_back(p);
            for (int k = 0; k < 3; ++k) level[k] += static_cast<double>(p[k]) * up * angle;
        }
    }
    const Rgb sun = sun_irradiance(daylight) * static_cast<float>(to_sun.y);
    const Rgb ground = (Rgb{static_cast<float>(level[0]), static_cast<float>(level[1]), static_cast<float>(level[2])} + sun) * static_cast<float>(ground_albedo / pi);
    pixels.resize(std::size_t{width} * height, ground);
    return std::make_shared<const Panorama>(width, height, std::move(pixels));
}

Expected<void> make_sky(Environment& environment) {
    if (environment.sky.empty()) return {};
    const auto daylight = daylight_of(environment.sky);
    if (!daylight) return tl::unexpected(daylight.error());
    environment.panorama = panorama_of(*daylight);
    return {};
}

Light sun_of(const Daylight& daylight, Vec3 center, double radius, double rotation) {
    constexpr double distances = 1e4;  // in radii: over the model the direction changes by less than the sun's own width
    const double distance = distances * radius, turn_cos = std::cos(rotation), turn_sin = std::sin(rotation);
    const Vec3 d = direction_to(daylight.sun);
    const Rgb irradiance = sun_irradiance(daylight);
    const float strongest = max_component(irradiance);
    Light sun;
    sun.name = "sun";
    sun.kind = LightKind::sphere;
    sun.position = center + Vec3{d.x * turn_cos + d.z * turn_sin, d.y, d.z * turn_cos - d.x * turn_sin} * distance;
    sun.radius = distance * std::sin(0.53 / 2 * degree);
    sun.intensity = strongest * distance * distance;
    if (strongest > 0) sun.color = irradiance * (1 / strongest);
    sun.visible = false;
    return sun;
}

}  // namespace crescente::scene
