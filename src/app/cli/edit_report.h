// What a script of edits cost, as a table for people and as JSON for programs.
#pragma once

#include <nlohmann/json.hpp>

#include "app/cli/edit_player.h"

namespace crescente::app {

// A render from nothing, for comparison.
struct FreshRender {
    render::RayCounts rays;
    double seconds = 0;  // acceleration structure and rendering
};

// The head of the table, with the fresh render; a row; the sums below. `tiles`: of the whole picture.
std::string report_head(const scene::Settings& settings, std::size_t tiles, int threads, const FreshRender& fresh);
std::string report_row(const PlayedEdit& edit, std::size_t tiles, const FreshRender& fresh);
std::string report_sums(const std::vector<PlayedEdit>& edits, const FreshRender& fresh);

nlohmann::ordered_json fresh_json(const FreshRender& fresh);
nlohmann::ordered_json edits_json(const std::vector<PlayedEdit>& edits, const FreshRender& fresh);
nlohmann::ordered_json sums_json(const std::vector<PlayedEdit>& edits);

}  // namespace crescente::app
