#include "scene/tonemap.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace crescente::scene {
namespace {

using math::Rgb;

constexpr float brightest = 1e8f;  // far beyond where every curve is white; keeps infinity out of the arithmetic

float sane(float v) { return v > 0 ? std::min(v, brightest) : 0.0f; }  // NaN compares false

float gain(double exposure) { return static_cast<float>(std::exp2(std::clamp(exposure, -64.0, 64.0))); }

// Khronos PBR Neutral, as its specification states it (section "Formula").
Rgb neutral(Rgb c) {
    constexpr float fresnel = 0.04f;  // of a dielectric of index 1.5
    constexpr float start_compression = 0.8f - fresnel;
    constexpr float desaturation = 0.15f;
    const float least = std::min(c.r, std::min(c.g, c.b));
    const float offset = least < 2 * fresnel ? least - least * least / (4 * fresnel) : fresnel;
    c = c - math::gray(offset);
    const float peak = max_component(c);
    if (peak < start_compression) return c;
    constexpr float d = 1.0f - start_compression;
    const float new_peak = 1.0f - d * d / (peak + d - start_compression);
    const float whiteness = 1.0f - 1.0f / (desaturation * (peak - new_peak) + 1.0f);
    return mix(c * (new_peak / peak), math::gray(new_peak), whiteness);
}

Rgb mapped(Rgb linear, Tonemap tonemap, float factor) {
    const Rgb c{sane(linear.r * factor), sane(linear.g * factor), sane(linear.b * factor)};
    return tonemap == Tonemap::neutral ? neutral(c) : c;
}

template <int bits>
int quantize(float encoded) {
    return static_cast<int>(encoded * float((1 << bits) - 1) + 0.5f);
}

// srgb_encode and rounding to n bits by table, exact: the encoding is monotonic, so each code starts at one float. A table over
// the leading bits of the float gives the code at the start of its interval; a few comparisons finish.
template <int bits>
class SrgbTable {
public:
    SrgbTable() {
        constexpr int codes = 1 << bits;
        first_.resize(codes + 1);
        std::uint32_t low = 0;
        const std::uint32_t one = std::bit_cast<std::uint32_t>(1.0f);
        const auto reaches = [](std::uint32_t b, int code) { return quantize<bits>(srgb_encode(std::bit_cast<float>(b))) >= code; };
        for (int code = 1; code < codes; ++code) {  // smallest float with this code, by bisection over its bits
            std::uint32_t high = one;
            const auto guess = std::bit_cast<std::uint32_t>(srgb_decode((float(code) - 0.5f) / float(codes - 1)));
            if (guess > low + 16 && guess + 16 < one && !reaches(guess - 16, code) && reaches(guess + 16, code)) {
                low = guess - 16;
                high = guess + 16;
            }
            while (low < high) {
                const std::uint32_t middle = low + (high - low) / 2;
                if (reaches(middle, code)) high = middle;
                else low = middle + 1;
            }
            first_[code] = std::bit_cast<float>(low);
        }
        first_[codes] = std::numeric_limits<float>::infinity();
        start_.resize(((one - lowest) >> shift) + 1);
        int code = 0;
        for (std::size_t i = 0; i < start_.size(); ++i) {
            const float x = std::bit_cast<float>(lowest + (static_cast<std::uint32_t>(i) << shift));
            while (x >= first_[code + 1]) ++code;
            start_[i] = static_cast<Code>(code);
        }
    }

    int operator()(float x) const {
        x = std::clamp(x, 0.0f, 1.0f);
        const std::uint32_t b = std::max(std::bit_cast<std::uint32_t>(x), lowest);
        int code = start_[(b - lowest) >> shift];
        if constexpr (bits == 8) code += x >= first_[code + 1];  // an interval holds at most one step: no branch
        else
            while (x >= first_[code + 1]) ++code;
        return code;
    }

private:
    using Code = std::conditional_t<bits == 8, std::uint8_t, std::uint16_t>;
    static constexpr int shift = bits == 8 ? 16 : 8;
    // Where the table begins: everything below has code 0.
    static constexpr std::uint32_t lowest = std::bit_cast<std::uint32_t>(bits == 8 ? 0x1p-13f : 0x1p-21f);
    std::vector<float> first_;  // by code: the smallest float that has it
    std::vector<Code> start_;   // by leading bits: the code of the interval's start
};

template <int bits>
const SrgbTable<bits>& srgb_table() {
    static const SrgbTable<bits> table;
    return table;
}

template <int bits, class Out>
void display_image_as(std::span<const float> linear, Tonemap tonemap, double exposure, std::span<Out> out) {
    const auto& table = srgb_table<bits>();
    const float factor = gain(exposure);
    for (std::size_t i = 0; i + 2 < linear.size() && i + 2 < out.size(); i += 3) {
        const Rgb c = mapped({linear[i], linear[i + 1], linear[i + 2]}, tonemap, factor);
        out[i] = static_cast<Out>(table(c.r));
        out[i + 1] = static_cast<Out>(table(c.g));
        out[i + 2] = static_cast<Out>(table(c.b));
    }
}

}  // namespace

float srgb_encode(float linear) {
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    const double x = linear;
    return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

float srgb_decode(float encoded) {
    if (!(encoded > 0)) return 0;
    if (encoded >= 1) return 1;
    const double x = encoded;
    return static_cast<float>(x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4));
}

Rgb display(Rgb linear, Tonemap tonemap, double exposure) {
    const Rgb c = mapped(linear, tonemap, gain(exposure));
    return {srgb_encode(c.r), srgb_encode(c.g), srgb_encode(c.b)};
}

void display_image(std::span<const float> linear, Tonemap tonemap, double exposure, std::span<std::uint8_t> out) {
    display_image_as<8>(linear, tonemap, exposure, out);
}

void display_image(std::span<const float> linear, Tonemap tonemap, double exposure, std::span<std::uint16_t> out) {
    display_image_as<16>(linear, tonemap, exposure, out);
}

double automatic_exposure(std::span<const float> linear, std::size_t channels) {
    constexpr double middle_grey = 0.18, darkest = 1e-4;  // below, a pixel is no more than dark
    constexpr double burnt = 0.05;                        // share of pixels that may be
    double sum = 0, weights = 0;
    std::vector<float> covering;  // luminance of pixels that cover more than half
    for (std::size_t i = 0; i + channels <= linear.size(); i += channels) {
        const float luminance = math::luminance({linear[i], linear[i + 1], linear[i + 2]}), alpha = channels == 4 ? linear[i + 3] : 1;
        if (!(luminance > 0) || !std::isfinite(luminance) || !(alpha > 0)) continue;
        sum += alpha * std::log2(std::max(darkest, double(luminance) / alpha));
        weights += alpha;
        if (alpha > 0.5f) covering.push_back(luminance / alpha);
    }
    if (!(weights > 0)) return 0;
    double stops = std::log2(middle_grey) - sum / weights;
    if (!covering.empty()) {
        const auto bright = covering.begin() + static_cast<std::ptrdiff_t>(static_cast<double>(covering.size() - 1) * (1 - burnt));
        std::nth_element(covering.begin(), bright, covering.end());
        stops = std::min(stops, -std::log2(std::max(darkest, double{*bright})));
    }
    return std::clamp(std::round(stops * 100) / 100, -32.0, 32.0);
}

}  // namespace crescente::scene
