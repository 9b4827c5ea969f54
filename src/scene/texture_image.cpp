#include "scene/texture_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/checksum.h"

namespace crescente::scene {
namespace {

std::size_t sample_bytes(SampleType type) { return type == SampleType::bits8 ? 1 : type == SampleType::bits16 ? 2 : 4; }

// IEC 61966-2-1.
float linear_of(double v) { return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)); }

const std::array<float, 256>& linear_of_bytes() {
    static const std::array<float, 256> table = [] {
        std::array<float, 256> values;
        for (std::size_t i = 0; i < values.size(); ++i) values[i] = linear_of(static_cast<double>(i) / 255);
        return values;
    }();
    return table;
}

template <class T>
T load(const std::vector<std::uint8_t>& samples, std::size_t index) {
    T value;
    std::memcpy(&value, samples.data() + index * sizeof(T), sizeof(T));
    return value;
}
template <class T>
void store(std::vector<std::uint8_t>& samples, std::size_t index, T value) {
    std::memcpy(samples.data() + index * sizeof(T), &value, sizeof(T));
}

std::uint16_t sixteen_bits(float v) { return static_cast<std::uint16_t>(std::clamp(v, 0.0f, 1.0f) * 65535.0f + 0.5f); }

// What texel i of a coarse row of `to` covers of a fine one of `from`: first texel and weights, 2 or 3 of them, of sum 1.
struct Cover {
    int first, count;
    float weight[3];
};
Cover cover(int i, int from, int to) {
    const double a = static_cast<double>(i) * from / to, b = static_cast<double>(i + 1) * from / to;
    Cover c{static_cast<int>(a), 0, {}};
    for (int k = c.first; k < from && k < b && c.count < 3; ++k) {
        c.weight[c.count++] = static_cast<float>((std::min<double>(b, k + 1) - std::max<double>(a, k)) / (b - a));
    }
    return c;
}

}  // namespace

TextureImage::TextureImage(ImageSource source, Pixels pixels, bool srgb, int coarser_by) : source_(std::move(source)), channels_(pixels.channels) {
    Level level{pixels.width, pixels.height, Coding::linear8, std::move(pixels.samples)};
    switch (pixels.type) {
        case SampleType::bits8: level.coding = srgb ? Coding::srgb8 : Coding::linear8; break;
        case SampleType::float32: level.coding = Coding::float32; break;
        case SampleType::bits16:
            level.coding = Coding::linear16;
            for (std::size_t i = 0; srgb && i < level.samples.size() / 2; ++i) {
                const bool is_alpha = channels_ % 2 == 0 && static_cast<int>(i % static_cast<std::size_t>(channels_)) == channels_ - 1;
                if (!is_alpha) store(level.samples, i, sixteen_bits(linear_of(load<std::uint16_t>(level.samples, i) / 65535.0)));
            }
            break;
    }
    for (int i = 0; i < coarser_by && (level.width > 1 || level.height > 1); ++i) level = coarser(level);
    levels_.push_back(std::move(level));
    while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(coarser(levels_.back()));
    const Level& finest = levels_.front();
    const std::int64_t form[] = {finest.width, finest.height, channels_, static_cast<std::int64_t>(finest.coding)};
    content_ = checksum({reinterpret_cast<const char*>(form), sizeof form});
    content_ = checksum({reinterpret_cast<const char*>(finest.samples.data()), finest.samples.size()}, content_);
}

template <TextureImage::Coding coding>
float TextureImage::sample(const Level& level, std::size_t index, bool is_alpha) {
    if constexpr (coding == Coding::linear16) return static_cast<float>(load<std::uint16_t>(level.samples, index)) / 65535.0f;
    else if constexpr (coding == Coding::float32) return load<float>(level.samples, index);
    else if (coding == Coding::linear8 || is_alpha) return static_cast<float>(level.samples[index]) / 255.0f;
    else return linear_of_bytes()[level.samples[index]];
}

float TextureImage::sample(const Level& level, std::size_t index, bool is_alpha) {
    switch (level.coding) {
        case Coding::srgb8: return sample<Coding::srgb8>(level, index, is_alpha);
        case Coding::linear8: return sample<Coding::linear8>(level, index, is_alpha);
        case Coding::linear16: return sample<Coding::linear16>(level, index, is_alpha);
        case Coding::float32: return sample<Coding::float32>(level, index, is_alpha);
    }
    return 0;
}

// Each texel the mean of what it covers, also where the size is odd.
TextureImage::Level TextureImage::coarser(const Level& fine) const {
    const bool floats = fine.coding == Coding::float32;
    Level level{std::max(1, fine.width / 2), std::max(1, fine.height / 2), floats ? Coding::float32 : Coding::linear16, {}};
    const auto n = static_cast<std::size_t>(channels_);
    level.samples.resize(static_cast<std::size_t>(level.width) * static_cast<std::size_t>(level.height) * n * (floats ? 4 : 2));
    for (int y = 0; y < level.height; ++y) {
        const Cover rows = cover(y, fine.height, level.height);
        for (int x = 0; x < level.width; ++x) {
            const Cover columns = cover(x, fine.width, level.width);
            for (std::size_t c = 0; c < n; ++c) {
                const bool is_alpha = n % 2 == 0 && c == n - 1;
                float sum = 0;
                for (int j = 0; j < rows.count; ++j) {
                    const std::size_t row = static_cast<std::size_t>(rows.first + j) * static_cast<std::size_t>(fine.width);
                    float part = 0;
                    for (int i = 0; i < columns.count; ++i) part += columns.weight[i] * sample(fine, (row + static_cast<std::size_t>(columns.first + i)) * n + c, is_alpha);
                    sum += rows.weight[j] * part;
                }
                const std::size_t at = (static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x)) * n + c;
                if (floats) store(level.samples, at, sum);
                else store(level.samples, at, sixteen_bits(sum));
            }
        }
    }
    return level;
}

template <class Take>
auto TextureImage::with_texels(const Level& level, Take&& take) const {
    const auto n = static_cast<std::size_t>(channels_);
    const auto by = [&]<Coding coding>() {
        return take([&](std::size_t at) {
            Rgba value;
            value.r = sample<coding>(level, at, false);
            if (n < 3) value.g = value.b = value.r;
            else value.g = sample<coding>(level, at + 1, false), value.b = sample<coding>(level, at + 2, false);
            if (n % 2 == 0) value.a = sample<coding>(level, at + n - 1, true);
            return value;
        });
    };
    switch (level.coding) {
        case Coding::srgb8: return by.template operator()<Coding::srgb8>();
        case Coding::linear8: return by.template operator()<Coding::linear8>();
        case Coding::linear16: return by.template operator()<Coding::linear16>();
        case Coding::float32: break;
    }
    return by.template operator()<Coding::float32>();
}

Rgba TextureImage::texel(int level_index, int x, int y) const {
    const Level& level = levels_[static_cast<std::size_t>(level_index)];
    const std::size_t at = static_cast<std::size_t>(y) * static_cast<std::size_t>(level.width) + static_cast<std::size_t>(x);
    return with_texels(level, [&](auto&& texel_at) { return texel_at(at * static_cast<std::size_t>(channels_)); });
}

std::array<Rgba, 4> TextureImage::texels(int level_index, int x0, int x1, int y0, int y1) const {
    const Level& level = levels_[static_cast<std::size_t>(level_index)];
    const auto n = static_cast<std::size_t>(channels_), width = static_cast<std::size_t>(level.width);
    const std::size_t left = static_cast<std::size_t>(x0) * n, right = static_cast<std::size_t>(x1) * n, upper = static_cast<std::size_t>(y0) * width * n, lower = static_cast<std::size_t>(y1) * width * n;
    return with_texels(level, [&](auto&& texel_at) { return std::array{texel_at(upper + left), texel_at(upper + right), texel_at(lower + left), texel_at(lower + right)}; });
}

std::size_t TextureImage::bytes() const {
    std::size_t total = 0;
    for (const Level& level : levels_) total += level.samples.size();
    return total;
}

std::size_t pyramid_bytes(int width, int height, int channels, SampleType type) {
    const std::size_t samples = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels);
    const std::size_t coarse = type == SampleType::float32 ? 4 : 2;
    return samples * sample_bytes(type) + samples * coarse / 3;
}

}  // namespace crescente::scene
