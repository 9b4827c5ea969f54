// Whether a tile that comes from a file can be gone on with. Its bytes may be hostile: whatever is let through must neither crash the engine nor keep it
// busy for ever, though what it shows may be wrong.
#pragma once

#include <span>
#include <string>

#include "render/level.h"

namespace crescente::render {

// What is wrong with a tile that tile_of made, else empty. `stages` are those of the settings that it grew by.
std::string tile_problem(const Tile& tile, const World& world, std::span<const Stage> stages);

}  // namespace crescente::render
