#include "app/server/color_map.h"

#include <algorithm>
#include <cmath>

namespace crescente::app {
namespace {

// viridis at 0, 0.1, ..., 1.
constexpr std::array<float, 3> stops[] = {{0.267004f, 0.004874f, 0.329415f}, {0.282623f, 0.140926f, 0.457517f}, {0.253935f, 0.265254f, 0.529983f}, {0.206756f, 0.371758f, 0.553117f},
                                          {0.163625f, 0.471133f, 0.558148f}, {0.127568f, 0.566949f, 0.550556f}, {0.134692f, 0.658636f, 0.517649f}, {0.266941f, 0.748751f, 0.440573f},
                                          {0.477504f, 0.821444f, 0.318195f}, {0.741388f, 0.873449f, 0.149561f}, {0.993248f, 0.906157f, 0.143936f}};

float share_of(float value, ShownLayer layer, const scene::Settings& settings) {
    if (layer == ShownLayer::samples) return std::log2(1 + std::max(value, 0.0f)) / std::log2(1 + static_cast<float>(settings.samples));
    if (layer == ShownLayer::level) return (value + 1) / (static_cast<float>(settings.level) + 1);
    return value;
}

}  // namespace

std::array<float, 3> viridis(float share) {
    constexpr int last = static_cast<int>(std::size(stops)) - 1;
    const float at = (share > 0 ? std::min(share, 1.0f) : 0.0f) * last;
    const int below = std::min(static_cast<int>(at), last - 1);
    const float t = at - static_cast<float>(below);
    std::array<float, 3> color{};
    for (std::size_t k = 0; k < 3; ++k) color[k] = stops[below][k] * (1 - t) + stops[below + 1][k] * t;
    return color;
}

scene::Image through_color_map(const scene::Image& picture, ShownLayer layer, const scene::Settings& settings) {
    const auto name = layer_names()[static_cast<std::size_t>(layer)];
    const std::size_t pixels = static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height);
    scene::Image map{picture.width, picture.height, {{"color", {"R", "G", "B"}, std::vector<float>(3 * pixels)}}};
    const auto found = std::find_if(picture.layers.begin(), picture.layers.end(), [&](const scene::Layer& l) { return l.name == name; });
    if (found == picture.layers.end()) return map;
    const std::size_t channels = found->channels.size();
    for (std::size_t p = 0; p < pixels; ++p) {
        const float* values = &found->values[p * channels];
        const auto color = viridis(share_of(*std::max_element(values, values + channels), layer, settings));
        std::copy(color.begin(), color.end(), &map.layers[0].values[3 * p]);
    }
    return map;
}

}  // namespace crescente::app
