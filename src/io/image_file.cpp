#include "io/image_file.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <new>
#include <span>
#include <vector>

#include "base/atomic_file.h"
#include "base/spelling.h"
#include "io/display_samples.h"
#include "io/openimageio.h"
#include "io/png_file.h"

namespace crescente::io {
namespace {

using scene::Image;
using scene::Layer;

struct PictureFormat {
    std::string extension;
    const char* encoder;  // OpenImageIO's name; null: libpng
    const char* compression;
    bool linear;      // keeps the light itself
    bool deep;        // may have 16 bits
    bool all_layers;
    bool alpha;       // keeps an alpha channel
};

const std::vector<PictureFormat>& picture_formats() {
    static const std::vector<PictureFormat> table{
        {".png", nullptr, nullptr, false, true, false, true},  {".jpg", "jpeg", "jpeg:95", false, false, false, false},
        {".jpeg", "jpeg", "jpeg:95", false, false, false, false}, {".tif", "tiff", "zip", false, true, false, true},
        {".tiff", "tiff", "zip", false, true, false, true},    {".hdr", "hdr", nullptr, true, false, false, false},
        {".exr", "openexr", "zip", true, false, true, true},
    };
    return table;
}

Expected<PictureFormat> format_of(const std::filesystem::path& file) {
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return std::tolower(c); });
    std::vector<std::string> known;
    for (const auto& format : picture_formats()) {
        if (format.extension == extension) return format;
        known.push_back(format.extension);
    }
    const std::string reason = extension.empty() ? "the name has no extension that says the picture's format"
                                                 : "'" + extension + "' is no picture format that can be written";
    return failure(ErrorKind::usage, {file.string(), {}, reason, spelling_hint(extension, known)});
}

bool has_alpha(const Image& image) { return image.layers.front().channels.size() == 4; }

tl::unexpected<Error> no_alpha(const std::filesystem::path& file, const PictureFormat& format) {
    return failure(ErrorKind::usage, {file.string(), {}, format.extension + " keeps no alpha channel, which a transparent background asks for", ".png, .tif and .exr do"});
}

Expected<void> check(const Image& image) {
    const auto wrong = [](std::string reason) { return failure(ErrorKind::internal, {{}, {}, std::move(reason), {}}); };
    if (image.width < 1 || image.height < 1 || image.layers.empty()) return wrong("the picture is empty");
    for (const Layer& layer : image.layers) {
        if (layer.channels.empty() || layer.values.size() != std::size_t(image.width) * std::size_t(image.height) * layer.channels.size()) {
            return wrong("layer '" + layer.name + "' does not fit the picture's size");
        }
    }
    return {};
}

// All layers as channels of one picture: the colours bare ("R"), the others with their layer's name ("normal.X").
struct Interleaved {
    std::vector<std::string> names;
    std::vector<float> values;
};

Interleaved interleave(const Image& image) {
    Interleaved all;
    std::size_t channels = 0;
    for (const Layer& layer : image.layers) channels += layer.channels.size();
    const std::size_t pixels = std::size_t(image.width) * std::size_t(image.height);
    all.values.resize(pixels * channels);
    for (const Layer& layer : image.layers) {
        const std::size_t first = all.names.size(), own = layer.channels.size();
        for (const auto& channel : layer.channels) all.names.push_back(&layer == &image.layers.front() ? channel : layer.name + "." + channel);
        for (std::size_t p = 0; p < pixels; ++p) {
            std::copy_n(&layer.values[p * own], own, &all.values[p * channels + first]);
        }
    }
    return all;
}

Expected<std::string> encode_by_module(const Image& image, const PictureFormat& format, const ImageOptions& options, const void* pixels,
                                       int bits, const std::vector<std::string>& channels) {
    std::vector<const char*> names, keys, values;
    for (const auto& name : channels) names.push_back(name.c_str());
    for (const auto& [key, value] : options.metadata) {
        keys.push_back(key.c_str());
        values.push_back(value.c_str());
    }
    CrescenteEncodeRequest request{};
    request.format = format.encoder;
    request.width = image.width;
    request.height = image.height;
    request.channels = static_cast<int>(channels.size());
    request.channel_names = names.data();
    request.sample_bits = bits;
    request.pixels = pixels;
    request.color_space = format.linear ? "Linear" : "sRGB";
    request.compression = format.compression;
    request.attribute_count = static_cast<int>(keys.size());
    request.attribute_names = keys.data();
    request.attribute_values = values.data();
    return encode_with_openimageio(request);
}

template <class Sample>
Expected<std::string> encode_display(const Image& image, const PictureFormat& format, const ImageOptions& options) {
    const Layer& layer = image.layers.front();
    const auto samples = display_samples<Sample>(layer.values, layer.channels.size(), format.encoder ? AlphaIs::multiplied : AlphaIs::straight, options.tonemap, options.exposure);
    const bool alpha = has_alpha(image);
    if (!format.encoder) return encode_png(image.width, image.height, alpha ? 4 : 3, std::span<const Sample>(samples), options.metadata);
    std::vector<std::string> channels{"R", "G", "B"};
    if (alpha) channels.push_back("A");
    return encode_by_module(image, format, options, samples.data(), int(8 * sizeof(Sample)), channels);
}

Expected<std::string> encode(const Image& image, const PictureFormat& format, const ImageOptions& options) {
    if (format.all_layers) {
        const Interleaved all = interleave(image);
        return encode_by_module(image, format, options, all.values.data(), 32, all.names);
    }
    if (format.linear) {
        std::vector<float> made;
        return encode_by_module(image, format, options, colors_of(image.layers.front().values, image.layers.front().channels.size(), made).data(), 32, {"R", "G", "B"});
    }
    if (options.bits == 16 && format.deep) return encode_display<std::uint16_t>(image, format, options);
    return encode_display<std::uint8_t>(image, format, options);
}

}  // namespace

Expected<void> can_write(const std::filesystem::path& file, bool alpha) {
    const auto format = format_of(file);
    if (!format) return tl::unexpected(format.error());
    if (alpha && !format->alpha) return no_alpha(file, *format);
    if (format->encoder && !has_openimageio()) {
        return failure(ErrorKind::unsupported, {file.string(), {}, "this build has no OpenImageIO, which writes " + format->extension,
                                                "PNG needs no OpenImageIO"});
    }
    return can_write_file(file);
}

Expected<void> write_image(const Image& image, const std::filesystem::path& file, const ImageOptions& options) {
    const auto format = format_of(file);
    if (!format) return tl::unexpected(format.error());
    if (options.bits != 8 && options.bits != 16) {
        return failure(ErrorKind::usage, {file.string(), {}, std::to_string(options.bits) + " bits cannot be written", "8 or 16"});
    }
    try {
        if (auto whole = check(image); !whole) return whole;
        if (has_alpha(image) && !format->alpha) return no_alpha(file, *format);
        auto bytes = encode(image, *format, options);
        if (bytes) return write_atomically(file, *bytes);
        for (Problem& problem : bytes.error().problems) problem.file = file.string();
        return tl::unexpected(std::move(bytes.error()));
    } catch (const std::bad_alloc&) {
        return failure(ErrorKind::resource, {file.string(), {}, "not enough memory to encode the picture", {}});
    }
}

}  // namespace crescente::io
