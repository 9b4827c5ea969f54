#include "io/panorama_file.h"

#include <cmath>
#include <cstring>
#include <new>

#include "base/byte_archive.h"
#include "io/isolated.h"
#include "io/openimageio.h"
#include "io/text_file.h"

namespace crescente::io {
namespace {

using math::Rgb;
using scene::Pixels;
using scene::SampleType;

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 27;

// As it comes from the other process: decoded, or why not.
struct Decoded {
    std::string error;
    Pixels pixels;
};

template <class Archive>
void decoded(Archive& a, Decoded& d) {
    value(a, d.error);
    value(a, d.pixels.width), value(a, d.pixels.height), value(a, d.pixels.channels), value(a, d.pixels.type);
    array(a, d.pixels.samples);
}

std::size_t sample_bytes(SampleType type) { return type == SampleType::bits8 ? 1 : type == SampleType::bits16 ? 2 : 4; }

bool is_whole(const Pixels& p) {
    if (p.width < 1 || p.height < 1 || p.channels < 1 || p.channels > 4 || p.type > SampleType::float32) return false;
    const std::uint64_t pixels = static_cast<std::uint64_t>(p.width) * static_cast<std::uint64_t>(p.height);
    return pixels <= most_pixels && p.samples.size() == pixels * static_cast<std::uint64_t>(p.channels) * sample_bytes(p.type);
}

Decoded decode(const std::string& bytes) {
    IsolationLimits limits;
    limits.memory = std::size_t{12} << 30;  // sixteen bytes for each of the most pixels, several times
    const auto answer = run_isolated([&](const TellProgress&) {
        Decoded one;
        auto pixels = decode_with_openimageio(bytes, most_pixels);
        if (pixels) one.pixels = std::move(*pixels);
        else one.error = pixels.error().problems.front().reason;
        ByteWriter writer;
        decoded(writer, one);
        return std::move(writer.bytes);
    }, limits);
    Decoded result;
    if (!answer) {
        result.error = answer.error() == IsolationFailure::unavailable ? "cannot be decoded: no process could be made for it"
                       : answer.error() == IsolationFailure::too_long  ? "is damaged: decoding it did not come to an end"
                                                                       : "is damaged: OpenImageIO failed on it";
        return result;
    }
    ByteReader reader{*answer};
    decoded(reader, result);
    if (result.error.empty() && (!reader.whole || !is_whole(result.pixels))) result.error = "could not be decoded: the answer is not whole";
    return result;
}

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
        const Decoded picture = decode(*bytes);
        if (!picture.error.empty()) return failure(ErrorKind::input, {file.string(), {}, "the picture " + picture.error, {}});
        return made_of(picture.pixels, file.string());
    } catch (const std::bad_alloc&) {
        return failure(ErrorKind::resource, {file.string(), {}, "not enough memory for the picture", {}});
    }
}

Expected<Problems> load_panorama(scene::Environment& environment, const std::filesystem::path& folder) {
    environment.panorama = nullptr;
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

Problems load_panorama(scene::Environment& environment, const Json& json, const Place& place, ProblemList& problems) {
    if (environment.image.find('\0') != std::string::npos) {
        problems.add(json, place, "must be the path of a file");
        return {};
    }
    auto warnings = load_panorama(environment, std::filesystem::path(problems.file()).parent_path());
    if (warnings) return std::move(*warnings);
    for (const Problem& problem : warnings.error().problems) problems.add(json, place, problem.text());
    return {};
}

}  // namespace crescente::io
