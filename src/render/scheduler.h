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
    bool under_way = false;  // interrupted, or on its way to the end after its trees were dropped: dropping it now would undo what was done
    double distance = 0;     // from where the user looks
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
    std::size_t threads = 1;  // with a batch: most tiles that go to the end in a round, so that only so many are held above the ceiling
};

// The next round of work: tiles independent of each other, those nearest to where the user looks first. After the first picture, tiles at distance 0 are
// worked on before the others. Tiles whose trees were dropped come last, and are grown anew to the end;
// once begun they go on, whatever the rounds and interruptions between. Empty: all is done.
std::vector<Work> next_work(std::span<const TileState> tiles, const Plan& plan);

// Which tiles to drop so that the kept bytes fit under the ceiling: first those that are finished (their states change the picture no
// more), then those that are least far, the later ones first; never one that is under way. `floor` is what a dropped tile still takes.
std::vector<std::uint32_t> tiles_to_drop(std::span<const TileState> tiles, int stages, std::uint64_t ceiling, std::uint64_t floor);

}  // namespace crescente::render
