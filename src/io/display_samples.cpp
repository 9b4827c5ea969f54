#include "io/display_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/tonemap.h"

namespace crescente::io {
namespace {

// Straight alpha is for what adds light without covering anything, a reflection on ground that is not seen: it gets as much alpha as it is
// bright, so that over black it is what it was.
template <class Sample>
std::vector<Sample> with_alpha(std::span<const float> values, bool multiplied, scene::Tonemap tonemap, double exposure) {
    const std::size_t pixels = values.size() / 4;
    const auto gain = static_cast<float>(std::exp2(exposure));
    std::vector<float> colors(3 * pixels), alphas(pixels);
    for (std::size_t p = 0; p < pixels; ++p) {
        const float* v = &values[4 * p];
        const float brightest = std::max({v[0], v[1], v[2], 0.0f}) * gain;
        alphas[p] = std::clamp(std::max(v[3], std::min(1.0f, brightest)), 0.0f, 1.0f);
        for (std::size_t k = 0; k < 3; ++k) colors[3 * p + k] = alphas[p] > 0 ? v[k] / alphas[p] : 0.0f;
    }
    std::vector<Sample> shown(3 * pixels), samples(4 * pixels);
    scene::display_image(colors, tonemap, exposure, std::span<Sample>(shown));
    constexpr float largest = std::numeric_limits<Sample>::max();
    for (std::size_t p = 0; p < pixels; ++p) {
        for (std::size_t k = 0; k < 3; ++k) {
            samples[4 * p + k] = multiplied ? static_cast<Sample>(static_cast<float>(shown[3 * p + k]) * alphas[p] + 0.5f) : shown[3 * p + k];
        }
        samples[4 * p + 3] = static_cast<Sample>(alphas[p] * largest + 0.5f);
    }
    return samples;
}

}  // namespace

std::span<const float> colors_of(std::span<const float> values, std::size_t channels, std::vector<float>& made) {
    if (channels == 3) return values;
    made.resize(values.size() / channels * 3);
    for (std::size_t pixel = 0; pixel < made.size() / 3; ++pixel) {
        for (std::size_t c = 0; c < 3; ++c) made[3 * pixel + c] = values[pixel * channels + std::min(c, channels - 1)];
    }
    return made;
}

template <class Sample>
std::vector<Sample> display_samples(std::span<const float> values, std::size_t channels, AlphaIs alpha, scene::Tonemap tonemap, double exposure) {
    if (channels == 4) return with_alpha<Sample>(values, alpha == AlphaIs::multiplied, tonemap, exposure);
    std::vector<float> made;
    const std::span<const float> colors = colors_of(values, channels, made);
    std::vector<Sample> samples(colors.size());
    scene::display_image(colors, tonemap, exposure, std::span<Sample>(samples));
    return samples;
}

template std::vector<std::uint8_t> display_samples(std::span<const float>, std::size_t, AlphaIs, scene::Tonemap, double);
template std::vector<std::uint16_t> display_samples(std::span<const float>, std::size_t, AlphaIs, scene::Tonemap, double);

}  // namespace crescente::io
