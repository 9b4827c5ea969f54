// The option --sky: daylight by the sun's place, or by a moment and a place on the earth.
#pragma once

#include <string>

#include "base/error.h"
#include "scene/sky.h"

namespace crescente::app {

// "AZIMUTH,ELEVATION" or "2024-06-21T14:30,LATITUDE,LONGITUDE" (universal time), in degrees, either with ",TURBIDITY" after it. Errors (usage): anything else, numbers out of range, a sun below the
// horizon.
Expected<scene::Daylight> parse_sky(const std::string& option, const std::string& text);

}  // namespace crescente::app
