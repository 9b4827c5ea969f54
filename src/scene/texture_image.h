// A picture that textures show, decoded, with its mip pyramid (Williams 1983, "Pyramidal Parametrics").
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "scene/pixels.h"

namespace crescente::scene {

struct Rgba {
    float r = 0, g = 0, b = 0, a = 1;
    bool operator==(const Rgba&) const = default;
};

// Where a picture is found. It is read and written with its scene as one or the other.
struct ImageSource {
    std::string file;   // path; empty: embedded
    std::string bytes;  // the whole encoded file, where it is embedded
    std::string place{};  // where in the scene's file it is mentioned, for problems
    bool operator==(const ImageSource& other) const { return file == other.file && bytes == other.bytes; }
};

// Values are linear, whatever the file holds. Level 0 takes as much memory as the file's samples, the others are kept in 16 bits (floats stay floats): for
// 8 bits in all 1.7 times the samples. Immutable: shared by all materials, worlds and threads.
class TextureImage {
public:
    // Not decoded yet: no levels.
    explicit TextureImage(ImageSource source) : source_(std::move(source)) {}
    // srgb: samples of 8 and 16 bits are by the sRGB curve (IEC 61966-2-1), but for alpha. The pixels must be whole and finite. `coarser`: so many times the size is halved.
    TextureImage(ImageSource source, Pixels pixels, bool srgb, int coarser = 0);

    const ImageSource& source() const { return source_; }
    bool decoded() const { return !levels_.empty(); }
    int level_count() const { return static_cast<int>(levels_.size()); }
    int width(int level = 0) const { return levels_[static_cast<std::size_t>(level)].width; }
    int height(int level = 0) const { return levels_[static_cast<std::size_t>(level)].height; }
    int channels() const { return channels_; }
    std::size_t bytes() const;             // of the levels
    std::uint64_t content() const { return content_; }  // checksum of what it shows

    // x and y within the level. Grey is all three colours; without alpha it is 1.
    Rgba texel(int level, int x, int y) const;
    // Those of columns x0 and x1 in row y0, then in row y1.
    std::array<Rgba, 4> texels(int level, int x0, int x1, int y0, int y1) const;

private:
    enum class Coding : std::uint8_t { srgb8, linear8, linear16, float32 };
    struct Level {
        int width, height;
        Coding coding;
        std::vector<std::uint8_t> samples;
    };
    template <Coding coding>
    static float sample(const Level& level, std::size_t index, bool is_alpha);
    static float sample(const Level& level, std::size_t index, bool is_alpha);
    // What take(texel_at) returns, where texel_at(index of its first sample) is a texel of the level: one look at the coding is enough for all of them.
    template <class Take>
    auto with_texels(const Level& level, Take&& take) const;
    Level coarser(const Level& fine) const;

    ImageSource source_;
    std::vector<Level> levels_;
    int channels_ = 0;
    std::uint64_t content_ = 0;
};

// Bytes that the levels of such a picture will take, all together.
std::size_t pyramid_bytes(int width, int height, int channels, SampleType type);

}  // namespace crescente::scene
