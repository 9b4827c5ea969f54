#include "io/texture_files.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <set>

#include "base/checksum.h"
#include "io/decoded_picture.h"
#include "io/openimageio.h"
#include "io/text_file.h"

namespace crescente::io {
namespace {

using scene::Pixels;
using scene::SampleType;
using scene::TextureImage;
using ImagePointer = std::shared_ptr<const TextureImage>;

constexpr std::uint64_t most_pixels = std::uint64_t{1} << 28;

// KTX 2 (Khronos), section 3.1. glTF's KHR_texture_basisu has its pictures in it.
constexpr std::string_view ktx2_identifier{"\xabKTX 20\xbb\r\n\x1a\n", 12};

bool shows_color(const scene::Material& material, const scene::TextureBinding& binding) {
    switch (binding.texture.color_space) {
        case scene::ColorSpace::srgb: return true;
        case scene::ColorSpace::linear: return false;
        case scene::ColorSpace::automatic: break;
    }
    const FieldInfo* field = scene::textured_field(material, binding.target);
    return field && field->type == FieldType::color;
}

// Samples that are no numbers become 0; how many.
std::size_t make_finite(Pixels& pixels) {
    if (pixels.type != SampleType::float32) return 0;
    std::size_t wrong = 0;
    for (std::size_t at = 0; at < pixels.samples.size(); at += sizeof(float)) {
        float value;
        std::memcpy(&value, &pixels.samples[at], sizeof value);
        if (std::isfinite(value)) continue;
        value = 0;
        std::memcpy(&pixels.samples[at], &value, sizeof value);
        ++wrong;
    }
    return wrong;
}

Pixels missing_pattern() {
    constexpr int size = 64, cell = 8;
    Pixels pixels{size, size, 3, SampleType::bits8, {}};
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const bool bright = (x / cell + y / cell) % 2 == 0;
            for (const int v : {255, 0, 255}) pixels.samples.push_back(static_cast<std::uint8_t>(bright ? v : 0));
        }
    }
    return pixels;
}

// One picture in one colour space, and the textures that show it.
struct Wanted {
    const TextureImage* image = nullptr;
    bool srgb = false;
    std::vector<ImagePointer*> shown_by;
};

// The pictures to be decoded, in the order of their first mention. Same file or same bytes: same picture.
std::vector<Wanted> wanted_images(std::span<scene::Material> materials) {
    std::vector<Wanted> wanted;
    std::map<std::tuple<std::string, std::uint64_t, std::size_t, bool>, std::size_t> known;
    std::map<const TextureImage*, std::uint64_t> hashes;
    for (scene::Material& material : materials) {
        for (scene::TextureBinding& binding : material.textures) {
            ImagePointer& image = binding.texture.image;
            if (!image || image->decoded()) continue;
            const scene::ImageSource& source = image->source();
            const auto [hash, is_new] = hashes.try_emplace(image.get());
            if (is_new) hash->second = checksum(source.bytes);
            const bool srgb = shows_color(material, binding);
            const auto [at, first] = known.try_emplace({source.file, hash->second, source.bytes.size(), srgb}, wanted.size());
            if (first) wanted.push_back({image.get(), srgb, {}});
            wanted[at->second].shown_by.push_back(&image);
        }
    }
    return wanted;
}

void leave_out_images(std::span<scene::Material> materials) {
    for (scene::Material& material : materials) {
        std::erase_if(material.textures, [](const scene::TextureBinding& b) { return b.texture.image && !b.texture.image->decoded(); });
    }
}

}  // namespace

Expected<Problems> load_textures(std::span<scene::Material> materials, const std::string& scene_file, const TextureOptions& options) {
    Problems warnings, problems;
    const std::vector<Wanted> wanted = wanted_images(materials);
    if (wanted.empty()) return warnings;
    if (!has_openimageio()) {
        leave_out_images(materials);
        warnings.push_back({scene_file, {}, std::to_string(wanted.size()) + " pictures of textures are left out: this build has no OpenImageIO", {}});
        return warnings;
    }
    std::size_t used = 0;
    std::set<const TextureImage*> there;  // each once, however many textures show it
    for (const scene::Material& material : materials) {
        for (const scene::TextureBinding& binding : material.textures) {
            if (binding.texture.image && there.insert(binding.texture.image.get()).second) used += binding.texture.image->bytes();
        }
    }
    const auto place_of = [&](const scene::ImageSource& source) {
        return source.file.empty() ? std::pair{scene_file, source.place} : std::pair{source.file, std::string{}};
    };
    const auto place_picture = [&](const Wanted& one, DecodedPicture result) {
        const scene::ImageSource& source = one.image->source();
        const auto [file, place] = place_of(source);
        Pixels pixels = std::move(result.pixels);
        if (!result.error.empty()) {
            Problem problem{file, place, "the picture of a texture " + result.error, {}};
            if (!source.file.empty() && !source.place.empty()) problem.hint = "named in " + scene_file + " at " + source.place;
            if (!options.pattern) {
                problems.push_back(std::move(problem));
                return;
            }
            problem.reason += ": a pattern stands in";
            warnings.push_back(std::move(problem));
            pixels = missing_pattern();
        }
        if (const std::size_t wrong = make_finite(pixels)) {
            warnings.push_back({file, place, std::to_string(wrong) + " samples of the picture of a texture are no finite numbers: 0 is taken", {}});
        }
        int coarser = 0;
        const auto bytes_when = [&](int halved) { return pyramid_bytes(std::max(1, pixels.width >> halved), std::max(1, pixels.height >> halved), pixels.channels, pixels.type) * (halved > 0 ? 2 : 1); };
        while (used + bytes_when(coarser) > options.memory && (pixels.width >> coarser > 1 || pixels.height >> coarser > 1)) ++coarser;
        if (coarser > 0) {
            warnings.push_back({file, place, "the picture of a texture is shown at 1/" + std::to_string(1 << coarser) + " of its size: all pictures together may take " +
                                                 std::to_string(options.memory >> 20) + " MB", {}});
        }
        auto image = std::make_shared<const TextureImage>(scene::ImageSource{source}, std::move(pixels), one.srgb, coarser);
        used += image->bytes();
        for (ImagePointer* shown : one.shown_by) *shown = image;
    };

    // Encoded pictures too are in memory a few at a time.
    constexpr std::size_t at_once = 16, encoded_bytes = std::size_t{1} << 28;
    for (std::size_t first = 0; first < wanted.size();) {
        std::vector<std::string> encoded;
        std::vector<std::size_t> which;
        std::size_t next = first, bytes_read = 0;
        for (; next < wanted.size() && next - first < at_once && bytes_read < encoded_bytes; ++next) {
            const scene::ImageSource& source = wanted[next].image->source();
            DecodedPicture unread;
            if (source.file.empty()) {
                encoded.push_back(source.bytes);
            } else if (auto bytes = read_whole_file(source.file)) {
                encoded.push_back(std::move(*bytes));
            } else {
                unread.error = bytes.error().problems.front().reason;
            }
            if (unread.error.empty() && std::string_view(encoded.back()).starts_with(ktx2_identifier)) {
                unread.error = "is in KTX2 (Basis Universal, KHR_texture_basisu), which is not read: convert it to PNG, JPEG or WebP";
                encoded.pop_back();
            }
            if (!unread.error.empty()) {
                place_picture(wanted[next], std::move(unread));
                continue;
            }
            which.push_back(next);
            bytes_read += encoded.back().size();
        }
        decode_pictures(encoded, most_pixels, [&](std::size_t i, DecodedPicture one) { place_picture(wanted[which[i]], std::move(one)); });
        first = next;
    }
    if (!problems.empty()) return tl::unexpected(Error{ErrorKind::input, std::move(problems)});
    return warnings;
}

}  // namespace crescente::io
