// The mean of a picture, for materials whose look lives in a texture that is not applied.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace crescente::io {

struct ImageMean {
    std::array<double, 3> color;  // as colour: sRGB turned linear before averaging, weighted by alpha
    std::array<double, 3> data;   // as plain numbers, 0..1
    double alpha;                 // mean of the fourth channel; 1 where there is none
    double covered;               // share of pixels with alpha >= cutoff
};

// Of the bytes of a PNG or JPEG file. Nothing if they are not one of these, damaged, of more than `most_pixels` pixels, or if this build
// cannot decode pictures. Takes the pixels decoded from `most_pixels`, which so bounds a whole file's pictures.
std::optional<ImageMean> mean_of_image(std::string_view bytes, double alpha_cutoff, std::size_t& most_pixels);

}  // namespace crescente::io
