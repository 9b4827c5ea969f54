#include "render/light_links.h"

#include <algorithm>

namespace crescente::render {
namespace {

enum Mark : std::uint8_t { named_only = 1, named_except = 2 };

Receivers receivers_of(const scene::Light& light, const scene::Scene& scene) {
    const auto is_in = [](const std::string& name, const std::vector<std::string>& names) { return std::find(names.begin(), names.end(), name) != names.end(); };
    std::vector<std::uint8_t> marks;
    for (const scene::Node& node : scene.nodes) {
        marks.push_back(static_cast<std::uint8_t>((is_in(node.name, light.only) ? named_only : 0) | (is_in(node.name, light.except) ? named_except : 0)));
    }
    auto receivers = std::make_shared<std::vector<std::uint8_t>>();
    scene::walk_appearances(scene, 0, [&](const scene::Appearance& at) {
        receivers->push_back((light.only.empty() || at.marks & named_only) && !(at.marks & named_except));
    }, marks);
    return receivers;
}

}  // namespace

std::vector<Receivers> receivers_of_lights(const scene::Scene& scene) {
    std::vector<Receivers> all;
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        const scene::Light& light = scene.lights[i];
        Receivers own;
        if (!light.only.empty() || !light.except.empty()) {
            const auto same = std::find_if(scene.lights.begin(), scene.lights.begin() + static_cast<std::ptrdiff_t>(i),
                                           [&](const scene::Light& other) { return other.only == light.only && other.except == light.except; });
            own = same - scene.lights.begin() < static_cast<std::ptrdiff_t>(i) ? all[static_cast<std::size_t>(same - scene.lights.begin())] : receivers_of(light, scene);
        }
        all.push_back(std::move(own));
    }
    return all;
}

}  // namespace crescente::render
