#include "render/light_seen.h"

#include "render/catcher.h"
#include "render/environment.h"

namespace crescente::render {
namespace {

using geometry::Ray;

// Light of the lights with extent that a ray from an instance (no_instance: the camera) passes; the camera does not see all of them.
Rgb lights_on(const World& world, const Ray& ray, std::uint32_t sender) {
    Rgb sum;
    world.emitters.lights_on(ray, ray.origin, sender, [&](const Emitted& light) {
        if (light.visible || sender != no_instance) sum += light.radiance * world.emitters.scale(light.group);
    });
    return sum;
}

// The instance whose surface sent the ray that ended at a node. What goes straight through a surface was sent before it.
std::uint32_t sender_of(const World& world, const Tile& tile, std::uint32_t node) {
    while (goes_straight(world, tile, node)) node = tile.nodes[node].parent;
    const std::uint32_t parent = tile.nodes[node].parent;
    return parent == no_node ? no_instance : tile.nodes[parent].instance;
}

}  // namespace

bool goes_straight(const World& world, const Tile& tile, std::uint32_t node) {
    const std::uint32_t parent = tile.nodes[node].parent;
    if (parent == no_node) return false;
    if (tile.nodes[parent].refracted == node) return world.lobes[tile.nodes[parent].material].ior == 1;
    const auto straight = tile.straight.find(parent);
    return straight != tile.straight.end() && straight->second == node;
}

void light_sky(const World& world, Tile& tile, std::uint32_t i, LatticePoint point) {
    Node& node = tile.nodes[i];
    const bool root = node.parent == no_node;
    bool by_camera = root;
    if (world.environment.source().transparent && !root) {
        std::uint32_t first = i;
        while (goes_straight(world, tile, first)) first = tile.nodes[first].parent;
        by_camera = tile.nodes[first].parent == no_node;
    }
    const bool apart = by_camera && world.environment.source().transparent;
    node.clear = apart ? all_clear : 0;
    tile.keeps_clear = tile.keeps_clear || apart;
    node.local = {};
    if (!root && catches(world, tile, node.parent) && !goes_straight(world, tile, i)) return;  // it mirrors objects alone
    if (world.emitters.groups() > 0) {
        node.local = lights_on(world, root ? camera_ray(world, point) : Ray{tile.nodes[node.parent].position, node.position}, sender_of(world, tile, i));
    }
    if (apart) return;
    node.local += root && world.environment.backdrop() ? backdrop_radiance(world.environment, 1 - point.y * pixels_per_step / world.camera.height())
                                                       : environment_radiance(world.environment, node.position);
}

Rgb lights_before(const World& world, const Tile& tile, std::uint32_t i) {
    if (world.emitters.groups() == 0) return {};
    const Node& node = tile.nodes[i];
    const bool root = node.parent == no_node;
    if (!root && catches(world, tile, node.parent) && !goes_straight(world, tile, i)) return {};
    Ray ray;
    ray.origin = root ? world.camera.origin_towards(node.position) : tile.nodes[node.parent].position;
    const Vec3 way = node.position - ray.origin;
    ray.t_max = length(way);
    ray.direction = way / ray.t_max;
    return lights_on(world, ray, sender_of(world, tile, i));
}

}  // namespace crescente::render
