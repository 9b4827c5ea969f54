#include "render/medium.h"

#include <algorithm>

#include "render/surface_lobes.h"

namespace crescente::render {
namespace {

Rgb exp_of_minus(Rgb depth) { return {std::exp(-depth.r), std::exp(-depth.g), std::exp(-depth.b)}; }

std::vector<Medium>::iterator find(std::vector<Medium>& media, std::uint32_t instance) {
    return std::find_if(media.begin(), media.end(), [instance](const Medium& m) { return m.instance == instance; });
}

// False if the place is outside of the instance's box.
bool may_hold(const accel::Instance& instance, Vec3 place) {
    const math::Bounds box = geometry::bounds(*instance.shape);
    const Vec3 local = instance.to_local.point(place);
    return !box.bounded() || max(box.lower, min(local, box.upper)) == local;
}

// The bodies that the ray which ended at the node was in: each by the last crossing on the path from the camera, else by where the camera is,
// else by the side of the hit.
std::vector<Medium> media_of_ray(const World& world, const Tile& tile, std::uint32_t end) {
    std::vector<Medium> known;  // with black ones: bodies that the ray was not in
    const auto add = [&](std::uint32_t instance, Rgb attenuation) {
        if (find(known, instance) == known.end()) known.push_back({instance, attenuation});
    };
    for (const Node* node = &tile.nodes[end]; node->parent != no_node;) {
        const Node& left = tile.nodes[node->parent];
        const Rgb attenuation = world.lobes[left.material].attenuation;
        if (!is_black(attenuation)) add(left.instance, left.inside != node->crossed ? attenuation : Rgb{});
        node = &left;
    }
    for (const Medium& m : world.camera_media) add(m.instance, m.attenuation);
    const Node& node = tile.nodes[end];
    if (!node.left_scene() && node.inside) add(node.instance, world.lobes[node.material].attenuation);
    std::erase_if(known, [](const Medium& m) { return is_black(m.attenuation); });
    return known;
}

// `media`: what the ray starts in. path(): length of the way from the camera to where it starts.
template <class Path>
Rgb passage(const World& world, std::vector<Medium> media, std::span<const accel::Crossing> crossings, const geometry::Ray& ray, Path&& path, bool straight_only) {
    constexpr double same = 1e-12;
    Rgb filter{1, 1, 1}, depth;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
        // Faces that a body has twice, or that overlap in it, are met at one distance, but crossed once: as by a seeing ray, which goes on
        // clear of both. (At an edge that faces share a ray meets one of them anyway: geometry/ray_view.h.)
        const accel::Hit& hit = crossings[i].hit;
        if (i > 0 && crossings[i - 1].hit.instance == hit.instance && hit.t - crossings[i - 1].hit.t <= same * hit.t) continue;
        const accel::Instance& instance = world.instances[hit.instance];
        const std::uint32_t material = world.material(hit.instance, geometry::slot(*instance.shape, hit.primitive));
        TexturedLobes scratch;
        const Lobes& lobes = world.textured_material(material) ? lobes_at(world, material, texture_point(world, ray, hit, path()), scratch) : world.lobes[material];
        filter *= straight_only && lobes.refracts() && lobes.ior != 1 ? lobes.straight : lobes.shadow_filter;
        if (!world.absorbs) continue;
        const geometry::Ray local = accel::to_local(instance, ray);
        const bool leaves = dot(geometry::surface(*instance.shape, hit.primitive, local.at(hit.t)).normal, local.direction) > 0;
        if (const auto medium = find(media, hit.instance); medium != media.end()) {
            depth += medium->attenuation * static_cast<float>(hit.t - medium->since);
            media.erase(medium);
        } else if (leaves) {
            depth += lobes.attenuation * static_cast<float>(hit.t);
        }
        if (!leaves && !is_black(lobes.attenuation)) media.push_back({hit.instance, lobes.attenuation, hit.t});
    }
    if (std::isfinite(ray.t_max)) {
        for (const Medium& m : media) depth += m.attenuation * static_cast<float>(ray.t_max - m.since);
    }
    return filter * exp_of_minus(depth);
}

}  // namespace

std::vector<Medium> media_around_camera(const World& world) {
    std::vector<Medium> media;
    if (!world.absorbs || world.scene.camera->projection == scene::Projection::orthographic) return media;
    geometry::Ray ray;
    ray.origin = world.camera.position();
    for (std::uint32_t i = 0; i < world.instances.size(); ++i) {
        const accel::Instance& instance = world.instances[i];
        if (instance.opaque || !may_hold(instance, ray.origin)) continue;
        accel::Hit hit;
        // One crossing tells, whichever way it is; of surfaces without an end some ways do not meet any.
        for (const Vec3 way : {world.camera.forward(), Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
            ray.direction = way;
            const geometry::Ray local = accel::to_local(instance, ray);
            for (std::uint32_t part = 0; part < geometry::parts(*instance.shape); ++part) accel::nearest_in_part(instance, i, part, local, hit);
            if (!hit.found()) continue;
            const geometry::SurfacePoint surface = geometry::surface(*instance.shape, hit.primitive, local.at(hit.t));
            const Rgb attenuation = world.lobes[world.material(i, surface.slot)].attenuation;
            if (!is_black(attenuation) && dot(surface.normal, local.direction) > 0) media.push_back({i, attenuation});
            break;
        }
    }
    return media;
}

Rgb transmittance(const World& world, const Tile& tile, std::uint32_t node, double length) {
    Rgb depth;
    for (const Medium& m : media_of_ray(world, tile, node)) depth += m.attenuation * static_cast<float>(length);
    return exp_of_minus(depth);
}

Rgb passage(const World& world, const Tile& tile, std::uint32_t node, std::span<const accel::Crossing> crossings, const geometry::Ray& ray) {
    return passage(world, world.absorbs ? media_of_ray(world, tile, node) : std::vector<Medium>{}, crossings, ray,
                   [&] { return path_length(world, tile, node); }, false);
}

Rgb passage(const World& world, std::span<const accel::Crossing> crossings, const geometry::Ray& ray, double path, bool straight_only) {
    return passage(world, std::vector<Medium>{}, crossings, ray, [path] { return path; }, straight_only);
}

}  // namespace crescente::render
