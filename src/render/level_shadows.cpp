#include "render/level_shadows.h"

#include <numeric>

namespace crescente::render {

std::vector<Stage> shadows_stages(const scene::Settings&) { return {{scene::Level::shadows, 0, 1}}; }

bool advance_shadows(Growth& growth, const Stage&, const Deadline& deadline) {
    Tile& tile = growth.tile();
    std::vector<std::uint32_t> chunk;
    while (tile.cursor < tile.nodes.size()) {
        chunk.resize(std::min(chunk_size, tile.nodes.size() - tile.cursor));
        std::iota(chunk.begin(), chunk.end(), static_cast<std::uint32_t>(tile.cursor));
        growth.light(chunk, true, accel::Coherence::coherent);
        tile.cursor += chunk.size();
        if (deadline.passed()) return false;
    }
    tile.lit = true;
    return true;
}

}  // namespace crescente::render
