// What a fuzz target does with a scene that its reader let through: whatever validate() accepts, the engine must be able to draw.
#pragma once

#include <string_view>
#include <vector>

#include "io/formats.h"
#include "render/session.h"
#include "scene/studio.h"
#include "scene/validate.h"

namespace crescente::fuzz {

// Breaks off the run where something that must hold does not.
inline void require(bool holds) {
    if (!holds) __builtin_trap();
}

// Places that a walk down the hierarchy visits, hidden ones left out; they multiply where groups are shared. The scene must be valid.
inline double places(const scene::Scene& scene) {
    std::vector<double> known(scene.nodes.size(), -1);
    double all = 0;
    for (const scene::NodeId root : scene.roots) {
        std::vector<std::uint32_t> open{root.value};
        while (!open.empty()) {
            const std::uint32_t at = open.back();
            double sum = 1;
            bool complete = true;
            for (const scene::NodeId child : scene.nodes[at].children) {
                if (!scene.nodes[at].visible) break;
                if (known[child.value] < 0) open.push_back(child.value), complete = false;
                else sum += known[child.value];
            }
            if (!complete) continue;
            known[at] = sum;
            open.pop_back();
        }
        all += known[root.value];
    }
    return all;
}

// So few places, parts and lights that a small picture is a matter of milliseconds.
inline bool is_small(const scene::Scene& scene) {
    constexpr double most_places = 200, most_parts = 5000, most_lights = 8;
    double parts = 0;
    for (const auto& shape : scene.shapes) parts += geometry::parts(shape.shape);
    const double shown = places(scene);
    return shown <= most_places && parts * shown <= most_parts && static_cast<double>(scene.lights.size()) <= most_lights;
}

// Draws a valid, small scene in a small picture, to the end or for a second.
inline void draw(scene::Scene scene) {
    if (!scene.camera || (scene.lights.empty() && !scene.environment)) {
        if (!scene::can_be_framed(scene::bounds(scene))) return;  // the program refuses it
        scene::add_studio(scene);
        require(scene.camera.has_value());
        require(scene::validate(scene, "studio").empty());
    }
    auto& settings = scene.settings;
    settings.width = 16, settings.height = 12;
    settings.level = scene::Level::edges;
    settings.depth = std::min(settings.depth, 3);
    settings.supersampling = std::min(settings.supersampling, 1);
    settings.threads = 1;
    auto session = render::Session::open(std::move(scene));
    if (!session) {
        require(!session.error().problems.empty());
        return;
    }
    const auto progress = session->advance(render::Deadline::in(std::chrono::seconds(1)));
    require(!progress.done || progress.first_picture);
    require(session->picture().width == 16);
    session->describe(8, 6);
}

// An error must say what is wrong; a scene must be judged, and drawn if it is valid.
inline void exercise(Expected<io::Loaded> loaded) {
    if (!loaded) return require(!loaded.error().problems.empty());
    if (scene::validate(loaded->scene, "fuzz").empty() && is_small(loaded->scene)) draw(std::move(loaded->scene));
}

}  // namespace crescente::fuzz
