#include "render/surface_lobes.h"

#include "math/octahedral.h"

namespace crescente::render {
namespace {

Vec3 seen_from(const World& world, const Tile& tile, const Node& node) {
    return node.parent != no_node ? tile.nodes[node.parent].position : world.camera.viewer_of(node.position);
}

}  // namespace

double path_length(const World& world, const Tile& tile, std::uint32_t node) {
    double sum = 0;
    for (std::uint32_t i = node; i != no_node; i = tile.nodes[i].parent) sum += length(tile.nodes[i].position - seen_from(world, tile, tile.nodes[i]));
    return sum;
}

TexturePoint texture_point(const World& world, const Tile& tile, std::uint32_t i) {
    const Node& node = tile.nodes[i];
    return {&world.instances[node.instance], &world.shape_boxes[node.instance], node.primitive, node.position, decode_direction(node.geometric_normal),
            normalize(seen_from(world, tile, node) - node.position), world.camera.pixel_width(path_length(world, tile, i)), node.inside};
}

TexturePoint texture_point(const World& world, const geometry::Ray& ray, const accel::Hit& hit, double path) {
    const accel::Instance& instance = world.instances[hit.instance];
    const geometry::SurfacePoint surface = geometry::surface(*instance.shape, hit.primitive, accel::to_local(instance, ray).at(hit.t));
    const Vec3 normal = normalize(instance.to_local.transposed(surface.normal));
    const bool inside = dot(normal, ray.direction) > 0;
    return {&instance, &world.shape_boxes[hit.instance], hit.primitive, instance.to_world.point(surface.position), inside ? -normal : normal, -ray.direction,
            world.camera.pixel_width(path + hit.t), inside};
}

const Lobes& lobes_of(const World& world, const Tile& tile, std::uint32_t node, TexturedLobes& scratch) {
    const std::uint32_t material = tile.nodes[node].material;
    if (!world.textured_material(material)) return world.lobes[material];
    return lobes_at(world, material, texture_point(world, tile, node), scratch);
}

void bend_normal(const World& world, Tile& tile, std::uint32_t i) {
    Node& node = tile.nodes[i];
    const TexturedMaterial* textured = world.textured_material(node.material);
    if (!textured || !textured->has_relief()) return;
    const Vec3 n = textured->normal_at(texture_point(world, tile, i), {node.normal[0], node.normal[1], node.normal[2]});
    node.normal = {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)};
}

}  // namespace crescente::render
