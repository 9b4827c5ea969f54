// Levels 4 and 5: light that has to be sampled. `soft` gathers at every node what lights with extent and the environment send directly, and what rough lobes
// reflect and refract; `indirect` lets the paths go on, so that surfaces light each other. Both are distributed ray tracing (Cook, Porter and Carpenter 1984) from
// the nodes that the levels before left: camera rays and perfectly smooth chains are not traced again.
#pragma once

#include "render/level.h"

namespace crescente::render {

// Samples are gathered in rounds, each up to a number of samples for every node, so that the whole picture gets better evenly. Where `indirect` is asked for, its
// rounds are those of soft as well.
std::vector<Stage> soft_stages(const scene::Settings& settings);
std::vector<Stage> indirect_stages(const scene::Settings& settings);
bool advance_sampled(Growth& growth, const Stage& stage, const Deadline& deadline);

}  // namespace crescente::render
