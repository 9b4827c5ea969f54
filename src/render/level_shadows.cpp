#include "render/level_shadows.h"

#include <algorithm>

namespace crescente::render {

std::vector<Stage> shadows_stages(const scene::Settings&) { return {{scene::Level::shadows, 0, 1}}; }

bool advance_shadows(Growth& growth, const Stage&, const Deadline& deadline) {
    Tile& tile = growth.tile();
    tile.cursor = std::max<std::size_t>(tile.cursor, tile.all_lit);
    std::vector<std::uint32_t> chunk;
    while (true) {
        for (; tile.cursor < tile.nodes.size() && chunk.size() < chunk_size; ++tile.cursor) {
            if (!tile.nodes[tile.cursor].shadowed) chunk.push_back(static_cast<std::uint32_t>(tile.cursor));
        }
        if (chunk.empty()) break;
        growth.light(chunk, true, accel::Coherence::coherent);
        chunk.clear();
        if (deadline.passed()) return false;
    }
    tile.lit = true;
    return true;
}

}  // namespace crescente::render
