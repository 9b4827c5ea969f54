#include "app/cli/sky_option.h"

#include <cmath>
#include <cstdio>
#include <optional>

#include "app/cli/quantities.h"

namespace crescente::app {
namespace {

constexpr double degree = math::pi / 180;

int days_in(int year, int month) {
    constexpr int days[] = {31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
    return days[month - 1] + (month == 2 && year % 4 == 0);  // right for the years that are let through
}

// "2024-06-21T14:30", with seconds and a Z if one likes.
std::optional<scene::Moment> moment_of(const std::string& text) {
    scene::Moment m;
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

}  // namespace

Expected<scene::Daylight> parse_sky(const std::string& option, const std::string& text) {
    const auto wrong = [&](std::string reason, std::string hint) { return failure(ErrorKind::usage, {"", option, std::move(reason), std::move(hint)}); };
    constexpr const char* forms = "write azimuth,elevation or 2024-06-21T14:30,latitude,longitude, in degrees and universal time (1950 to 2050), and a turbidity after it if you like";
    const bool by_time = text.find('T') != std::string::npos;
    std::string numbers_text = text;
    std::optional<scene::Moment> moment;
    if (by_time) {
        const auto comma = text.find(',');
        moment = moment_of(text.substr(0, comma));
        if (!moment || comma == std::string::npos) return wrong("'" + text + "' says no date, time and place", forms);
        numbers_text = text.substr(comma + 1);
    }
    const auto numbers = parse_numbers(option, numbers_text);
    if (!numbers || numbers->size() < 2 || numbers->size() > 3) return wrong("'" + text + "' says no place of the sun", forms);
    const double first = (*numbers)[0], second = (*numbers)[1];
    scene::Daylight daylight;
    if (numbers->size() == 3) daylight.turbidity = (*numbers)[2];
    if (!(daylight.turbidity >= 2 && daylight.turbidity <= 10)) return wrong("the turbidity must be from 2 (very clear) to 10 (haze)", "");
    if (by_time) {
        if (std::abs(first) > 90 || std::abs(second) > 180) return wrong("a latitude is from -90 to 90, a longitude from -180 to 180", "");
        daylight.sun = scene::sun_position(*moment, first * degree, second * degree);
    } else {
        if (std::abs(first) > 360 || std::abs(second) > 90) return wrong("an azimuth is from -360 to 360, an elevation up to 90", "");
        daylight.sun = {first * degree, second * degree};
    }
    if (!(daylight.sun.elevation > 0)) {
        char height[64];
        std::snprintf(height, sizeof height, "the sun stands at %.1f degrees, below the horizon", daylight.sun.elevation / degree);
        return wrong(height, "");
    }
    return daylight;
}

}  // namespace crescente::app
