#include "render/level.h"

#include <algorithm>

#include "render/level_edges.h"
#include "render/level_reflections.h"
#include "render/level_sampled.h"
#include "render/level_shadows.h"
#include "render/level_visible.h"

namespace crescente::render {

std::span<const LevelKind> levels() {
    static constexpr LevelKind table[] = {
        {scene::Level::visible, "visible", visible_stages, advance_visible},
        {scene::Level::shadows, "shadows", shadows_stages, advance_shadows},
        {scene::Level::reflections, "reflections", reflections_stages, advance_reflections},
        {scene::Level::edges, "edges", edges_stages, advance_edges},
        {scene::Level::soft, "soft", soft_stages, advance_sampled},
        {scene::Level::indirect, "indirect", indirect_stages, advance_sampled},
    };
    return table;
}

int first_stage(std::span<const scene::Level> level_of_stage, scene::Level level) {
    return static_cast<int>(std::find(level_of_stage.begin(), level_of_stage.end(), level) - level_of_stage.begin());
}

std::vector<Stage> stages_of(const scene::Settings& settings) {
    std::vector<Stage> all;
    for (const LevelKind& kind : levels()) {
        if (kind.level > settings.level) break;
        const std::vector<Stage> stages = kind.stages(settings);
        all.insert(all.end(), stages.begin(), stages.end());
    }
    return all;
}

}  // namespace crescente::render
