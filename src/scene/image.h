// Pictures in memory: named layers over one grid of pixels.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace crescente::scene {

// One layer: channels of float, row by row from the top left, channels interleaved.
struct Layer {
    std::string name;                   // "color", "depth", "position", "normal", "albedo", "object", "material", "influence",
                                        // "level" (that a pixel has reached; -1: a preview after an edit), "samples"
    std::vector<std::string> channels;  // "R", "G", "B", "Z", "X", ...
    std::vector<float> values;          // width x height x channels
};

struct Image {
    int width = 0, height = 0;
    std::vector<Layer> layers;  // the first is "color": linear RGB, Rec. 709, before exposure and tone mapping; maybe with "A", which is multiplied in
};

}  // namespace crescente::scene
