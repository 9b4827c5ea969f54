// Counters and times as JSON (docs/cli.md lists the fields).
#pragma once

#include <nlohmann/json.hpp>

#include "render/session.h"

namespace crescente::app {

nlohmann::ordered_json rays_json(const render::RayCounts& rays);

// What Session counts: rays, tests, nodes, memory, levels, threads.
nlohmann::ordered_json stats_json(const render::Stats& stats);

}  // namespace crescente::app
