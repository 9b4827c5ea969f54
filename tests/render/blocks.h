// Pictures compared by the means of square blocks, in which noise is less than in pixels.
#pragma once

#include "render/scenes.h"

namespace crescente::render::testing {

struct BlockDifference {
    double mean = 0;      // luminance of the first picture
    double bias = 0;      // of the second one's mean from that
    double absolute = 0;  // mean over blocks
};
inline BlockDifference block_difference(const scene::Image& a, const scene::Image& b, int block) {
    BlockDifference d;
    const int across = a.width / block, down = a.height / block;
    for (int k = 0; k < across * down; ++k) {
        Rgb x, y;
        for (int i = 0; i < block * block; ++i) {
            const int column = k % across * block + i % block, row = k / across * block + i / block;
            x += pixel(a, column, row), y += pixel(b, column, row);
        }
        const double share = 1.0 / (across * down * block * block), difference = luminance(y) - luminance(x);
        d.mean += luminance(x) * share, d.bias += difference * share, d.absolute += std::abs(difference) * share;
    }
    return d;
}

}  // namespace crescente::render::testing
