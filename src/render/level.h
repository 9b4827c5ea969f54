// The levels of realism, one pair of files each, and the table that the scheduler walks through. Adding a level: its files, and one line
// in `levels` (and its name in scene::Level).
#pragma once

#include <span>

#include "render/growth.h"

namespace crescente::render {

// One step of growth. A level may take several.
struct Stage {
    scene::Level level;
    double parameter;  // the level's own: grid step, threshold of influence, depth of splitting
    double cost;       // rough share of a picture's time, for the progress bar
};

// The first stage of a level; if it has none, their number.
int first_stage(std::span<const scene::Level> level_of_stage, scene::Level level);

struct LevelKind {
    scene::Level level;
    const char* name;
    std::vector<Stage> (*stages)(const scene::Settings&);
    // Works on a tile whose earlier stages are complete, until the stage is complete (true) or the deadline passed (false). Called
    // again it goes on where it stopped; what it leaves is the same however often it was stopped.
    bool (*advance)(Growth&, const Stage&, const Deadline&);
};

std::span<const LevelKind> levels();

// Of all levels that the settings ask for, in their order.
std::vector<Stage> stages_of(const scene::Settings& settings);

}  // namespace crescente::render
