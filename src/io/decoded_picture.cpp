#include "io/decoded_picture.h"

#include <algorithm>

#include "base/byte_archive.h"
#include "io/isolated.h"
#include "io/openimageio.h"

namespace crescente::io {
namespace {

using scene::Pixels;
using scene::SampleType;

template <class Archive>
void decoded(Archive& a, DecodedPicture& d) {
    value(a, d.error);
    value(a, d.pixels.width), value(a, d.pixels.height), value(a, d.pixels.channels), value(a, d.pixels.type);
    array(a, d.pixels.samples);
}

bool is_whole(const Pixels& p, std::uint64_t most_pixels) {
    if (p.width < 1 || p.height < 1 || p.channels < 1 || p.channels > 4 || p.type > SampleType::float32) return false;
    const std::uint64_t pixels = static_cast<std::uint64_t>(p.width) * static_cast<std::uint64_t>(p.height);
    return pixels <= most_pixels && p.samples.size() == pixels * static_cast<std::uint64_t>(p.channels) * sample_bytes(p.type);
}

DecodedPicture failed(std::string why) {
    DecodedPicture none;
    none.error = std::move(why);
    return none;
}

}  // namespace

std::size_t sample_bytes(SampleType type) { return type == SampleType::bits8 ? 1 : type == SampleType::bits16 ? 2 : 4; }

void decode_pictures(std::span<const std::string> encoded, std::uint64_t most_pixels, const std::function<void(std::size_t, DecodedPicture)>& take) {
    std::size_t first = 0;
    while (first < encoded.size()) {
        std::size_t begun = first;
        IsolationLimits limits;
        limits.memory = std::size_t{12} << 30;  // sixteen bytes for each of the most pixels, several times
        IsolationWatch watch;
        watch.progress = [&](double, std::string_view) { ++begun; };
        constexpr std::size_t bunch_bytes = std::size_t{1} << 28;  // decoded, about, before another process begins
        const auto answer = run_isolated([&](const TellProgress& tell) {
            ByteWriter writer;
            for (std::size_t i = first; i < encoded.size() && (i == first || writer.bytes.size() < bunch_bytes); ++i) {
                tell(0, "");
                DecodedPicture one;
                auto pixels = decode_with_openimageio(encoded[i], most_pixels);
                if (pixels) one.pixels = std::move(*pixels);
                else one.error = pixels.error().problems.front().reason;
                decoded(writer, one);
            }
            return std::move(writer.bytes);
        }, limits, watch);
        if (!answer) {
            // What was decoded before it is lost with the process, and decoded again.
            const std::size_t culprit = std::max(begun, first + 1) - 1;
            if (answer.error() == IsolationFailure::unavailable) {
                for (std::size_t i = first; i < encoded.size(); ++i) take(i, failed("no process could be made to decode it"));
                return;
            }
            decode_pictures(encoded.subspan(first, culprit - first), most_pixels, [&](std::size_t i, DecodedPicture one) { take(first + i, std::move(one)); });
            take(culprit, failed(answer.error() == IsolationFailure::too_long ? "is damaged: decoding it did not come to an end" : "is damaged: OpenImageIO failed on it"));
            first = culprit + 1;
            continue;
        }
        ByteReader reader{*answer};
        const std::size_t before = first;
        while (reader.whole && !reader.bytes.empty() && first < encoded.size()) {
            DecodedPicture one;
            decoded(reader, one);
            if (!reader.whole || (one.error.empty() && !is_whole(one.pixels, most_pixels))) one.error = "could not be decoded: the answer is not whole";
            take(first++, std::move(one));
        }
        if (first == before) take(first++, failed("could not be decoded: there was no answer"));
    }
}

}  // namespace crescente::io
