#include "render/world.h"

namespace crescente::render {
namespace {

Expected<std::unique_ptr<accel::Accelerator>> make_accelerator(std::span<const accel::Instance> instances, const scene::Settings& settings) {
    switch (settings.accelerator) {
        case scene::AcceleratorKind::linear: return accel::make_linear(instances);
        case scene::AcceleratorKind::kay_kajiya:
            return accel::make_kay_kajiya(instances, {settings.octant_rejection, settings.priority_queue});
        case scene::AcceleratorKind::embree: break;
    }
    return accel::make_embree(instances);
}

}  // namespace

Expected<std::unique_ptr<World>> world_of(scene::Scene scene) {
    if (!scene.camera) return failure(ErrorKind::input, {"", "/camera", "the scene has no camera", ""});
    const CameraRays camera(*scene.camera, scene.settings.width, scene.settings.height);
    auto world = std::make_unique<World>(World{std::move(scene), {}, {}, {}, {}, {}, {}, {}, {}, camera, nullptr, false, false, {}});
    for (scene::NamedShape& shape : world->scene.shapes) geometry::prepare(shape.shape);
    const scene::Scene& s = world->scene;
    for (const scene::Material& material : s.materials) world->lobes.push_back(compile(material));
    world->lobes.push_back(compile(scene::Material{}));
    const auto default_material = static_cast<std::uint32_t>(world->lobes.size() - 1);

    scene::for_each_appearance(s, [&](std::uint32_t node, const Affine& to_world, const std::vector<scene::MaterialId>& materials) {
        world->first_slot.push_back(static_cast<std::uint32_t>(world->slots.size()));
        bool opaque = true;
        for (const scene::MaterialId id : materials) {
            world->slots.push_back(id.valid() ? id.value : default_material);
            const Lobes& lobes = world->lobes[world->slots.back()];
            opaque = opaque && lobes.opaque();
            world->absorbs = world->absorbs || !is_black(lobes.attenuation);
        }
        if (materials.empty()) world->slots.push_back(default_material);
        world->filters_light = world->filters_light || !opaque;
        world->instances.emplace_back(s.shapes[s.nodes[node].shape.value].shape, to_world, opaque);
        world->node_of_instance.push_back(node);
    });
    for (const std::uint32_t slot : world->slots) world->one_sided.push_back(world->lobes[slot].one_sided);
    for (std::uint32_t i = 0; i < world->instances.size(); ++i) {
        const std::size_t end = i + 1 < world->instances.size() ? world->first_slot[i + 1] : world->slots.size();
        const std::span sides(world->one_sided.data() + world->first_slot[i], end - world->first_slot[i]);
        if (std::any_of(sides.begin(), sides.end(), [](std::uint8_t one) { return one != 0; })) world->instances[i].one_sided = sides;
    }
    for (const scene::Light& light : s.lights) world->lights.emplace_back(light);
    if (s.environment) world->environment = *s.environment;

    world->camera_media = media_around_camera(*world);

    auto accelerator = make_accelerator(world->instances, s.settings);
    if (!accelerator) return tl::unexpected(accelerator.error());
    world->accelerator = std::move(*accelerator);
    return world;
}

}  // namespace crescente::render
