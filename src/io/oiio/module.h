// The face of the OpenImageIO module: plain C, so that the program can load it late (docs/decisions/0003-openimageio-loaded-late.md).
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

struct CrescenteEncodeRequest {
    std::uint32_t version;             // must be crescente_oiio_version
    const char* format;                // OpenImageIO's name: "jpeg", "tiff", "hdr", "openexr"
    int width, height, channels;
    const char* const* channel_names;  // as many as channels
    int sample_bits;                   // of `pixels`: 8 or 16 unsigned, 32 float; interleaved, row by row from the top
    const void* pixels;
    const char* color_space;           // OpenImageIO's name: "sRGB" or "Linear"
    const char* compression;           // "jpeg:95", "zip", ...; may be null
    int attribute_count;
    const char* const* attribute_names;
    const char* const* attribute_values;
    void* user;
    void (*take)(void* user, const char* bytes, std::size_t size);  // called once with the whole file
    void (*fail)(void* user, const char* reason);                   // or once with what went wrong
};

struct CrescenteDecodeRequest {
    std::uint32_t version;  // must be crescente_oiio_version
    const char* bytes;      // the whole file, of any format that OpenImageIO knows
    std::size_t size;
    std::uint64_t most_pixels;  // more are refused before they are decoded
    void* user;
    // Called once: sample_bits as above; interleaved, row by row from the top, alpha not multiplied in.
    void (*take)(void* user, int width, int height, int channels, int sample_bits, const void* pixels);
    void (*fail)(void* user, const char* reason);  // or once with what went wrong
};

// The symbols of the module. They return 1 after take, 0 after fail.
int crescente_oiio_encode(const CrescenteEncodeRequest* request);
int crescente_oiio_decode(const CrescenteDecodeRequest* request);
}

inline constexpr std::uint32_t crescente_oiio_version = 2;
