// What a picture decoder gives.
#pragma once

#include <cstdint>
#include <vector>

namespace crescente::scene {

enum class SampleType : std::uint8_t { bits8, bits16, float32 };

// Rows from the top, samples interleaved; as many bytes as width x height x channels x bytes of a sample.
struct Pixels {
    int width = 0, height = 0;
    int channels = 0;  // 1: grey, 2: grey and alpha, 3: RGB, 4: RGB and alpha, which is not multiplied in
    SampleType type = SampleType::bits8;
    std::vector<std::uint8_t> samples;
};

}  // namespace crescente::scene
