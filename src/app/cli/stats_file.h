// Counters and times as JSON (docs/cli.md lists the fields).
#pragma once

#include <filesystem>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "render/session.h"

namespace crescente::app {

// Wall time of the parts of a run, seconds; cpu: of all threads.
struct RunTimes {
    double load = 0, render = 0, write = 0, total = 0, cpu = 0;
};

// What Session counts: rays, tests, nodes, memory, levels, threads.
nlohmann::ordered_json stats_json(const render::Stats& stats);

// Finds out before rendering whether the file can be written. Leaves no trace.
Expected<void> can_write_text(const std::filesystem::path& file);

// Written beside and renamed: whatever happens, `file` is the old one or the whole new one.
Expected<void> write_text(const std::filesystem::path& file, const std::string& text);

}  // namespace crescente::app
