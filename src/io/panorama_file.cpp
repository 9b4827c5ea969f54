#include "io/panorama_file.h"

#include <cmath>
#include <cstring>
#include <new>

#include "io/decoded_picture.h"
#include "io/openimageio.h"
#include "io/text_file.h"
#include "scene/sky.h"

namespace crescente::io {
namespace {

using math::Rgb;
using scene::Pixels;
using scene::SampleType;

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 27;

float linear_of(double v) { return static_cast<float>(v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4)); }

template <class T>
T load(const Pixels& p, std::size_t index) {
    T value;
    std::memcpy(&value, p.samples.data() + index * sizeof(T), sizeof(T));
    return value;
}

float sample(const Pixels& p, std::size_t index) {
    switch (p.type) {
        case SampleType::bits8: return linear_of(load<std::uint8_t>(p, index) / 255.0);
        case SampleType::bits16: return linear_of(load<std::uint16_t>(p, index) / 65535.0);
        case SampleType::float32: break;
    }
    return load<float>(p, index);
}

Expected<ReadPanorama> made_of(const Pixels& p, const std::string& file) {
    const auto wrong = [&](std::string reason, std::string hint = {}) { return failure(ErrorKind::input, {file, {}, std::move(reason), std::move(hint)}); };
    if (p.channels == 2) return wrong("the picture has 2 channels", "what surrounds a scene is told by 1, 3 or 4: grey, RGB, or RGB and alpha");
    constexpr int most_slender = 64;
    if (p.width > most_slender * p.height || p.height > most_slender * p.width) {
        return wrong("the picture of " + std::to_string(p.width) + " x " + std::to_string(p.height) + " pixels cannot surround anything", "equirectangular pictures are twice as wide as high");
    }
    const std::size_t count = static_cast<std::size_t>(p.width) * static_cast<std::size_t>(p.height), channels = static_cast<std::size_t>(p.channels);
    std::vector<Rgb> colors(count);
    std::size_t negative = 0, no_numbers = 0, first = 0;
    for (std::size_t i = 0; i < count; ++i) {
        float rgb[3];
        for (std::size_t k = 0; k < 3; ++k) {
            rgb[k] = sample(p, i * channels + (channels == 1 ? 0 : k));
            if (!std::isfinite(rgb[k]) && no_numbers++ == 0) first = i;
            if (rgb[k] < 0) rgb[k] = 0, ++negative;
        }
        colors[i] = {rgb[0], rgb[1], rgb[2]};
    }
    if (no_numbers > 0) {
        const std::size_t width = static_cast<std::size_t>(p.width);
        return wrong(std::to_string(no_numbers) + " samples of the picture are no finite numbers, the first in column " + std::to_string(first % width) + " of row " + std::to_string(first / width));
    }
    ReadPanorama result;
    if (negative > 0) result.warnings.push_back({file, {}, std::to_string(negative) + " samples of the picture are negative: 0 is taken", {}});
    if (p.width != 2 * p.height) {
        result.warnings.push_back({file, {}, "the picture of " + std::to_string(p.width) + " x " + std::to_string(p.height) + " pixels is taken for all directions",
                                   "equirectangular pictures are twice as wide as high"});
    }
    result.panorama = std::make_shared<const scene::Panorama>(p.width, p.height, std::move(colors));
    return result;
}

}  // namespace

Expected<ReadPanorama> read_panorama(const std::filesystem::path& file) {
    if (!has_openimageio()) return failure(ErrorKind::unsupported, {file.string(), {}, "this build has no OpenImageIO, which reads pictures", {}});
    const auto bytes = read_whole_file(file);
    if (!bytes) return tl::unexpected(bytes.error());
    try {
        DecodedPicture picture;
        decode_pictures({&*bytes, 1}, most_pixels, [&](std::size_t, DecodedPicture decoded) { picture = std::move(decoded); });
        if (!picture.error.empty()) return failure(ErrorKind::input, {file.string(), {}, "the picture " + picture.error, {}});
        return made_of(picture.pixels, file.string());
    } catch (const std::bad_alloc&) {
        return failure(ErrorKind::resource, {file.string(), {}, "not enough memory for the picture", {}});
    }
}

Expected<Problems> load_panorama(scene::Environment& environment, const std::filesystem::path& folder) {
    environment.panorama = nullptr;
    if (!environment.sky.empty()) {
        if (!environment.image.empty()) return failure(ErrorKind::input, {{}, {}, "a sky and a picture cannot be together", {}});
        return make_sky(environment).map([] { return Problems{}; });
    }
    if (environment.image.empty()) return Problems{};
    const std::filesystem::path named = folder / environment.image;
    auto read = read_panorama(named);
    if (!read) return tl::unexpected(std::move(read.error()));
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(named, error);
    if (!error) environment.image = whole.lexically_normal().string();
    environment.panorama = std::move(read->panorama);
    return std::move(read->warnings);
}

void load_panorama(scene::Environment& environment, const Json& json, const Place& place, ProblemList& problems) {
    if (environment.image.find('\0') != std::string::npos) return problems.add(json, place, "must be the path of a file");
    const auto warnings = load_panorama(environment, std::filesystem::path(problems.file()).parent_path());
    if (warnings) return problems.warn(*warnings);
    for (const Problem& problem : warnings.error().problems) problems.add(json, place, problem.text());
}

}  // namespace crescente::io
