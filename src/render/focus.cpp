#include "render/focus.h"

#include <utility>

#include "render/world.h"

namespace crescente::render {

Expected<std::optional<double>> distance_in_the_middle(scene::Scene& scene) {
    auto world = world_of(std::move(scene));
    if (!world) return tl::unexpected(std::move(world.error()));
    const World& w = **world;
    const geometry::Ray ray = w.camera.through(w.scene.settings.width / 2.0, w.scene.settings.height / 2.0);
    accel::Hit hit;
    accel::TestCounts counts;
    w.accelerator->nearest({&ray, 1}, {&hit, 1}, accel::Coherence::coherent, counts);
    const double along = dot(ray.direction, w.camera.forward());
    scene = std::move((*world)->scene);
    return hit.found() ? std::optional(hit.t * along) : std::nullopt;
}

}  // namespace crescente::render
