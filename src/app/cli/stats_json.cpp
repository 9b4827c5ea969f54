#include "app/cli/stats_json.h"

namespace crescente::app {

nlohmann::ordered_json rays_json(const render::RayCounts& rays) {
    return {{"camera", rays.camera}, {"reflected", rays.reflected}, {"refracted", rays.refracted},
            {"shadow", rays.shadow}, {"path", rays.path}, {"total", rays.total()}};
}

nlohmann::ordered_json stats_json(const render::Stats& stats) {
    nlohmann::ordered_json levels = nlohmann::ordered_json::array();
    for (const auto& level : stats.levels) {
        levels.push_back({{"name", level.name}, {"time", level.seconds}, {"rays", rays_json(level.rays)}});
    }
    return {
        {"threads", stats.threads},
        {"rays", rays_json(stats.rays)},
        {"nodes", stats.nodes},
        {"bytes_per_pixel", stats.bytes_per_pixel},
        {"levels", std::move(levels)},
        {"tests",
         {{"box", stats.tests.box_tests},
          {"shape", stats.tests.shape_tests},
          {"shadow_cache_hits", stats.tests.shadow_cache_hits},
          {"kept_rays", stats.tests.kept_rays},
          {"shortcut_rays", stats.tests.shortcut_rays},
          {"shortcut_wrong", stats.tests.shortcut_wrong}}},
        {"memory",
         {{"forest", stats.forest_bytes},
          {"peak_forest", stats.peak_forest_bytes},
          {"accelerator", stats.accelerator_bytes},
          {"dropped_tiles", stats.dropped_tiles}}},
    };
}

}  // namespace crescente::app
