#include "render/level_reflections.h"

#include <numeric>

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
    if (tile.todo.empty()) {  // the first band begins with the camera's own hits
        tile.todo.resize(tile.nodes.size());
        std::iota(tile.todo.begin(), tile.todo.end(), 0u);
        for (std::size_t i = 0; i < tile.todo.size(); i += chunk_size) {
            growth.spawn(std::span(tile.todo).subspan(i, std::min(chunk_size, tile.todo.size() - i)), tile.pending);
        }
        tile.todo.resize(1);  // marks that it was done
    }
    return growth.grow_above(tile.pending, stage.parameter, deadline);
}

}  // namespace crescente::render
