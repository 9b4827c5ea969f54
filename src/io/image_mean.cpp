#include "io/image_mean.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#ifdef CRESCENTE_WITH_TINYGLTF
#include <tiny_gltf.h>
#endif

namespace crescente::io {
#ifdef CRESCENTE_WITH_TINYGLTF
namespace {

// Number of pixels that the header promises, to be known before anything is allocated; 0: neither PNG nor JPEG.
std::size_t promised_pixels(std::string_view bytes) {
    const auto number = [&](std::size_t at, int size) {
        std::size_t value = 0;
        for (int i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + static_cast<std::size_t>(i)]);
        return value;
    };
    if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return bytes.size() < 24 ? 0 : number(16, 4) * number(20, 4);
    if (!bytes.starts_with("\xff\xd8\xff")) return 0;
    for (std::size_t at = 2; at + 9 < bytes.size();) {  // ITU T.81, B.1.1: markers with their lengths up to the frame header
        if (number(at, 1) != 0xff) return 0;
        const std::size_t marker = number(at + 1, 1);
        if (marker == 0xff) {
            ++at;  // fill byte
            continue;
        }
        const bool frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (frame) return number(at + 5, 2) * number(at + 7, 2);
        at += 2 + number(at + 2, 2);
    }
    return 0;
}

// IEC 61966-2-1.
double to_linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

}  // namespace

std::optional<ImageMean> mean_of_image(std::string_view bytes, double alpha_cutoff, std::size_t& most_pixels) {
    const std::size_t promised = promised_pixels(bytes);
    if (promised == 0 || promised > most_pixels || bytes.size() > std::numeric_limits<int>::max()) return std::nullopt;
    most_pixels -= promised;
    tinygltf::Image image;
    std::string errors, warnings;
    if (!tinygltf::LoadImageData(&image, 0, &errors, &warnings, 0, 0, reinterpret_cast<const unsigned char*>(bytes.data()),
                                 static_cast<int>(bytes.size()), nullptr)) {
        return std::nullopt;
    }
    const std::size_t step = image.bits == 16 ? 2 : 1, pixels = image.image.size() / (4 * step);
    if (image.component != 4 || pixels == 0) return std::nullopt;

    // Sums for each of the 256 values (of the upper byte), so that the curve is evaluated 256 times only.
    std::array<std::array<double, 256>, 3> weighted{};
    std::array<std::array<std::uint64_t, 256>, 4> seen{};
    for (std::size_t i = 0; i < pixels; ++i) {
        const unsigned char* pixel = &image.image[i * 4 * step] + (step - 1);  // little-endian: the upper byte is the second
        const unsigned char alpha = pixel[3 * step];
        for (std::size_t c = 0; c < 3; ++c) {
            weighted[c][pixel[c * step]] += alpha;
            ++seen[c][pixel[c * step]];
        }
        ++seen[3][alpha];
    }
    ImageMean mean{{0, 0, 0}, {0, 0, 0}, 0, 0};
    double alpha_sum = 0;
    for (std::size_t v = 0; v < 256; ++v) {
        const double value = static_cast<double>(v) / 255, linear = to_linear(value);
        for (std::size_t c = 0; c < 3; ++c) {
            mean.color[c] += linear * weighted[c][v];
            mean.data[c] += value * static_cast<double>(seen[c][v]);
        }
        alpha_sum += static_cast<double>(v) * static_cast<double>(seen[3][v]);
        mean.alpha += value * static_cast<double>(seen[3][v]);
        if (value >= alpha_cutoff) mean.covered += static_cast<double>(seen[3][v]);
    }
    const double n = static_cast<double>(pixels);
    for (std::size_t c = 0; c < 3; ++c) {
        mean.color[c] = alpha_sum > 0 ? mean.color[c] / alpha_sum : 0;
        mean.data[c] /= n;
    }
    mean.alpha /= n;
    mean.covered /= n;
    return mean;
}
#else
std::optional<ImageMean> mean_of_image(std::string_view, double, std::size_t&) { return std::nullopt; }
#endif

}  // namespace crescente::io
