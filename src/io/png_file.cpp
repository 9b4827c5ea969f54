#include "io/png_file.h"

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <vector>

#include <png.h>
#include <zlib.h>

namespace crescente::io {
namespace {

constexpr std::size_t longest_key = 79;

// What libpng's C code reports back through its pointers.
struct Sink {
    std::string bytes;
    std::string error;
    bool out_of_memory = false;
};

void take(png_structp png, png_bytep data, std::size_t size) {
    auto* sink = static_cast<Sink*>(png_get_io_ptr(png));
    try {
        sink->bytes.append(reinterpret_cast<const char*>(data), size);
    } catch (const std::exception&) {
        sink->out_of_memory = true;
    }
    if (sink->out_of_memory) png_error(png, "out of memory");
}

void fail(png_structp png, png_const_charp message) {
    static_cast<Sink*>(png_get_error_ptr(png))->error = message;
    png_longjmp(png, 1);
}

void ignore(png_structp, png_const_charp) {}

bool is_ascii(const std::string& text) {
    return std::all_of(text.begin(), text.end(), [](unsigned char c) { return c < 128; });
}

// The text chunks point into these strings.
std::vector<png_text> text_chunks(std::map<std::string, std::string>& texts, std::vector<std::string>& keys) {
    std::vector<png_text> chunks;
    keys.reserve(texts.size());
    for (auto& [key, text] : texts) {
        if (key.empty()) continue;
        keys.push_back(key.substr(0, longest_key));
        png_text chunk{};
        chunk.compression = is_ascii(text) ? PNG_TEXT_COMPRESSION_NONE : PNG_ITXT_COMPRESSION_NONE;
        chunk.key = keys.back().data();
        chunk.text = text.data();
        chunk.text_length = text.size();
        chunks.push_back(chunk);
    }
    return chunks;
}

// libpng leaves by longjmp: everything with a destructor belongs to the caller.
bool encode(Sink& sink, int width, int height, int channels, int bits, const void* pixels, const std::vector<png_text>& texts) {
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &sink, fail, ignore);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    if (!info) {
        png_destroy_write_struct(&png, nullptr);
        sink.out_of_memory = true;
        return false;
    }
    if (setjmp(png_jmpbuf(png))) {
        png_destroy_write_struct(&png, &info);
        return false;
    }
    png_set_write_fn(png, &sink, take, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits, channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    if (!texts.empty()) png_set_text(png, info, texts.data(), static_cast<int>(texts.size()));
    // Rendered pictures are smooth: differences to the row above, in runs. Measured on 1024 x 1024: 17 ms and 0.37 MB; all
    // filters at level 3 47 ms for 0.35 MB, no filter 12 ms but fails on gradients along a row.
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_UP);
    png_set_compression_level(png, 1);
    png_set_compression_strategy(png, Z_RLE);
    png_set_compression_buffer_size(png, 1 << 18);
    png_write_info(png, info);
    if (bits == 16 && std::endian::native == std::endian::little) png_set_swap(png);
    const std::size_t stride = std::size_t(width) * std::size_t(channels) * std::size_t(bits / 8);
    for (int y = 0; y < height; ++y) png_write_row(png, static_cast<png_const_bytep>(pixels) + stride * std::size_t(y));
    png_write_end(png, nullptr);
    png_destroy_write_struct(&png, &info);
    return true;
}

template <class Sample>
Expected<std::string> encode_samples(int width, int height, int channels, std::span<const Sample> samples, std::map<std::string, std::string> metadata) {
    if (width < 1 || height < 1 || (channels != 3 && channels != 4) || samples.size() < std::size_t(width) * std::size_t(height) * std::size_t(channels)) {
        return failure(ErrorKind::internal, {{}, {}, "the picture has fewer samples than its size says", {}});
    }
    Sink sink;
    std::vector<std::string> keys;
    const auto texts = text_chunks(metadata, keys);
    if (encode(sink, width, height, channels, int(8 * sizeof(Sample)), samples.data(), texts)) return std::move(sink.bytes);
    return failure(ErrorKind::resource, {{}, {}, "PNG: " + (sink.out_of_memory ? "out of memory" : sink.error), {}});
}

}  // namespace

Expected<std::string> encode_png(int width, int height, int channels, std::span<const std::uint8_t> samples, const std::map<std::string, std::string>& metadata) {
    return encode_samples(width, height, channels, samples, metadata);
}

Expected<std::string> encode_png(int width, int height, int channels, std::span<const std::uint16_t> samples, const std::map<std::string, std::string>& metadata) {
    return encode_samples(width, height, channels, samples, metadata);
}

}  // namespace crescente::io
