// What to work on next. Pure logic: it sees how far each tile is and how much memory there is, and traces nothing.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace crescente::render {

struct TileState {
    int stage = 0;          // stages that its kept trees have completed
    int shown_stage = 0;    // stages that its picture has completed: more, if the trees were dropped
    std::uint64_t bytes = 0;
};

struct Work {
    std::uint32_t tile;
    int until;  // stage to reach
};

struct Plan {
    int stages = 0;           // of a finished tile
    bool even = true;         // every tile of the lowest stage advances by one stage, so that the whole picture grows evenly; else, after
                              // the first stage, tiles go to the end
    std::size_t batch = 0;    // most tiles a round, so that memory can be looked at between rounds; 0: all
};

// The next round of work: tiles independent of each other. Tiles whose trees were dropped come last, and are grown anew to the end
// in one go. Empty: all is done.
std::vector<Work> next_work(std::span<const TileState> tiles, const Plan& plan);

// Which tiles to drop so that the kept bytes fit under the ceiling: first those that are finished (their states change the picture no
// more), then those that are least far, the later ones first. `floor` is what a dropped tile still takes.
std::vector<std::uint32_t> tiles_to_drop(std::span<const TileState> tiles, int stages, std::uint64_t ceiling, std::uint64_t floor);

}  // namespace crescente::render
