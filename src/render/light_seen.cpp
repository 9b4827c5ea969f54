#include "render/light_seen.h"

#include <vector>

#include "render/environment.h"

namespace crescente::render {
namespace {

using geometry::Ray;

// Light of the lights with extent that a ray passes; the camera does not see all of them.
Rgb lights_on(const World& world, const Ray& ray, bool by_camera) {
    Rgb sum;
    if (world.emitters.groups() == 0) return sum;
    std::vector<Emitted> met;
    world.emitters.lights_on(ray, ray.origin, met);
    for (const Emitted& light : met) {
        if (light.visible || !by_camera) sum += light.radiance * world.emitters.scale(light.group);
    }
    return sum;
}

}  // namespace

Rgb sky_seen(const World& world, LatticePoint point) {
    const Ray ray = camera_ray(world, point);
    const bool backdrop = world.environment.backdrop();
    return lights_on(world, ray, true) + (backdrop ? backdrop_radiance(world.environment, 1 - point.y / (double(1 << subpixel_bits) * world.camera.height()))
                                                   : environment_radiance(world.environment, ray.direction));
}

Rgb sky_seen(const World& world, const Ray& ray) { return lights_on(world, ray, false) + environment_radiance(world.environment, ray.direction); }

Rgb lights_before(const World& world, const Tile& tile, const Node& node) {
    if (world.emitters.groups() == 0) return {};
    const bool root = node.parent == no_node;
    Ray ray;
    ray.origin = root ? world.camera.origin_towards(node.position) : tile.nodes[node.parent].position;
    const Vec3 way = node.position - ray.origin;
    ray.t_max = length(way);
    ray.direction = way / ray.t_max;
    return lights_on(world, ray, root);
}

}  // namespace crescente::render
