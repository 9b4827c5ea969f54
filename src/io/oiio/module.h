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

// The single symbol of the module. Returns 1 after take, 0 after fail.
int crescente_oiio_encode(const CrescenteEncodeRequest* request);
}

inline constexpr std::uint32_t crescente_oiio_version = 1;
