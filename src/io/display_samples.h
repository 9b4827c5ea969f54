// Scene light as the samples of display formats: what PNG, TIFF and JPEG files hold, and what the viewer shows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/settings.h"

namespace crescente::io {

enum class AlphaIs {
    straight,    // apart from the colours, as PNG wants it
    multiplied,  // in them, as TIFF wants it
};

// Rows of pixels of `channels` values each to 8 or 16 bits: RGB, or RGBA where there are four channels (alpha multiplied in). Of one or two channels the last serves for
// the others. `tonemap` must not be automatic; `exposure` in stops.
template <class Sample>
std::vector<Sample> display_samples(std::span<const float> values, std::size_t channels, AlphaIs alpha, scene::Tonemap tonemap, double exposure);

extern template std::vector<std::uint8_t> display_samples(std::span<const float>, std::size_t, AlphaIs, scene::Tonemap, double);
extern template std::vector<std::uint16_t> display_samples(std::span<const float>, std::size_t, AlphaIs, scene::Tonemap, double);

// The first three channels of each pixel: the values themselves, or `made` from them.
std::span<const float> colors_of(std::span<const float> values, std::size_t channels, std::vector<float>& made);

}  // namespace crescente::io
