// The columns of a tile as bytes, and back. docs/forest.md has the layout.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "render/forest.h"

namespace crescente::render {

// All that the tile holds but its place, what its nodes say themselves, and previews: what is shown is what its trees say. It must know all edits. Appended to
// `bytes`.
void append_tile(Tile& tile, std::string& bytes);

// The tile again, at the place of `place`. Nothing if the bytes are not whole. They may be hostile: no more is allocated than they hold, and keys of maps are
// within the tile; but whether it makes sense is for render/tile_check.h to say.
std::optional<Tile> tile_of(std::string_view bytes, const Tile& place);

}  // namespace crescente::render
