#include "render/level_reflections.h"

#include <algorithm>

namespace crescente::render {

// Rays are grown in bands of influence, all tiles of a band before the next, so that the picture first gets what shows most.
std::vector<Stage> reflections_stages(const scene::Settings& settings) {
    std::vector<Stage> stages;
    for (const double band : {0.25, 1.0 / 32}) {
        if (band > settings.threshold) stages.push_back({scene::Level::reflections, band, 0.5});
    }
    stages.push_back({scene::Level::reflections, settings.threshold, 0.3});
    return stages;
}

bool advance_reflections(Growth& growth, const Stage& stage, const Deadline& deadline) {
    Tile& tile = growth.tile();
    // The first band begins with the camera's own hits; the others find that all nodes sent their rays.
    const bool first_band = stage.parameter == reflections_stages(growth.settings()).front().parameter;
    std::vector<std::uint32_t> chunk;
    tile.cursor = first_band ? std::max<std::size_t>(tile.cursor, tile.all_spawned) : tile.nodes.size();
    while (tile.cursor < tile.nodes.size()) {
        for (; tile.cursor < tile.nodes.size() && chunk.size() < chunk_size; ++tile.cursor) {
            const Node& node = tile.nodes[tile.cursor];
            if (!node.spawned && !node.left_scene()) chunk.push_back(static_cast<std::uint32_t>(tile.cursor));
        }
        growth.spawn(chunk, tile.pending);
        chunk.clear();
    }
    return growth.grow_above(tile.pending, stage.parameter, deadline);
}

}  // namespace crescente::render
