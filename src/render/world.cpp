#include "render/world.h"

#include <algorithm>

#include "render/scene_lights.h"
#include "scene/hierarchy.h"

namespace crescente::render {
namespace {

// Such that it throws no sharp light on others, but as much (regularisation of paths; Kaplanyan and Dachsbacher 2013).
scene::Material blurred(scene::Material material) {
    constexpr double least_roughness = 0.55;
    auto* m = std::get_if<scene::PhysicalMaterial>(&material.model);
    if (!m || m->transmission * (1 - m->metallic) > 0) return material;
    m->roughness = std::max(m->roughness, least_roughness), m->clearcoat_roughness = std::max(m->clearcoat_roughness, least_roughness);
    std::erase_if(material.textures, [](const scene::TextureBinding& b) { return b.target == "roughness" || b.target == "clearcoat_roughness"; });
    return material;
}

// What is asked of a material as a whole is asked of the glass that it is where its texture says that it is no metal.
scene::Material as_a_whole(scene::Material material) {
    auto* m = std::get_if<scene::PhysicalMaterial>(&material.model);
    const auto textures_metal = [](const scene::TextureBinding& b) { return b.target == "metallic"; };
    if (m && m->transmission > 0 && std::any_of(material.textures.begin(), material.textures.end(), textures_metal)) m->metallic = 0;
    return material;
}

// All but the accelerator. `before`: of a scene that is much the same, or null.
void derive(World& world, const World* before) {
    const scene::Scene& s = world.scene;
    std::vector<scene::Material> whole;
    for (const scene::Material& material : s.materials) whole.push_back(as_a_whole(material));
    world.lobes = compile(whole);
    world.lobes.push_back(compile(scene::Material{}));
    const auto default_material = static_cast<std::uint32_t>(world.lobes.size() - 1);
    for (std::size_t i = 0; i < s.materials.size(); ++i) {
        if (!TexturedMaterial::varies(s.materials[i])) continue;
        world.textured.resize(world.lobes.size());
        world.textured[i] = std::make_shared<const TexturedMaterial>(s.materials[i]);
        world.bends_normals = world.bends_normals || world.textured[i]->has_relief();
    }

    std::uint64_t motion = 0;
    scene::walk_appearances(s, s.camera->shutter_open, [&](const scene::Appearance& at) {
        world.first_slot.push_back(static_cast<std::uint32_t>(world.slots.size()));
        bool opaque = true;
        for (const scene::MaterialId id : *at.materials) {
            world.slots.push_back(id.valid() ? id.value : default_material);
            const Lobes& lobes = world.lobes[world.slots.back()];
            const TexturedMaterial* textured = world.textured_material(world.slots.back());
            opaque = opaque && lobes.opaque() && !(textured && textured->may_open());
            world.absorbs = world.absorbs || !is_black(lobes.attenuation);
        }
        if (at.materials->empty()) world.slots.push_back(default_material);
        world.filters_light = world.filters_light || !opaque;
        const geometry::Shape& shape = s.shapes[s.nodes[at.node].shape.value].shape;
        world.instances.emplace_back(shape, at.to_world, opaque);
        world.node_of_instance.push_back(at.node);
        world.identity.push_back(at.identity);
        if (at.motion != 0) motion = mix_bits(motion ^ mix_bits(at.identity ^ at.motion)) | 1;
        world.shape_boxes.push_back(geometry::bounds(shape));
        world.boxes.push_back(transform(at.to_world, world.shape_boxes.back()));
    });
    for (const std::uint32_t slot : world.slots) world.one_sided.push_back(world.lobes[slot].one_sided);
    for (std::uint32_t i = 0; i < world.instances.size(); ++i) {
        const std::span sides(world.one_sided.data() + world.first_slot[i], world.slots_of(i).size());
        if (std::any_of(sides.begin(), sides.end(), [](std::uint8_t one) { return one != 0; })) world.instances[i].one_sided = sides;
    }
    if (s.environment) world.environment = Environment(*s.environment);
    make_lights(world);
    world.lens = lens_of(world, motion);
    if (world.lens && world.lens->objects != 0) world.moments = std::make_unique<Moments>(world);
    world.camera_media = media_around_camera(world);
    if (s.settings.level > scene::Level::edges && !s.settings.caustics) {
        world.blurred_lobes = world.lobes;
        world.blurred_textured = world.textured;
        for (std::size_t i = 0; i < s.materials.size(); ++i) {
            const scene::Material soft = blurred(whole[i]);
            if (soft.model != whole[i].model) world.blurred_lobes[i] = compile(soft);
            if (world.textured_material(static_cast<std::uint32_t>(i))) world.blurred_textured[i] = std::make_shared<const TexturedMaterial>(soft);
        }
    }
    if (s.settings.level > scene::Level::edges) world.emitters = Emitters(world, before ? &before->emitters : nullptr);
}

}  // namespace

Expected<std::unique_ptr<World>> world_of(scene::Scene scene) {
    if (!scene.camera) return failure(ErrorKind::input, {"", "/camera", "the scene has no camera", ""});
    for (scene::NamedShape& shape : scene.shapes) geometry::prepare(shape.shape);
    auto world = world_without_accelerator(std::move(scene));
    auto accelerator = make_accelerator(world->instances, world->scene.settings, nullptr, {});
    if (!accelerator) return tl::unexpected(accelerator.error());
    world->accelerator = std::move(*accelerator);
    return world;
}

std::unique_ptr<World> world_without_accelerator(scene::Scene scene, const World* before) {
    const CameraRays camera(scene::camera_at(*scene.camera, scene.camera->shutter_open), scene.settings.width, scene.settings.height);
    auto world = std::make_unique<World>(std::move(scene), camera);
    derive(*world, before);
    return world;
}

Expected<std::unique_ptr<accel::Accelerator>> make_accelerator(std::span<const accel::Instance> instances, const scene::Settings& settings,
                                                               const accel::Accelerator* before, std::span<const geometry::Shape* const> reshaped) {
    switch (settings.accelerator) {
        case scene::AcceleratorKind::linear: return accel::make_linear(instances);
        case scene::AcceleratorKind::kay_kajiya:
            return accel::make_kay_kajiya(instances, {settings.octant_rejection, settings.priority_queue});
        case scene::AcceleratorKind::embree: break;
    }
    return accel::make_embree(instances, before, reshaped);
}

bool same_accelerator(const scene::Settings& a, const scene::Settings& b) {
    return a.accelerator == b.accelerator && a.octant_rejection == b.octant_rejection && a.priority_queue == b.priority_queue;
}

Expected<void> give_accelerator(World& world, World& before, bool same, std::span<const geometry::Shape* const> reshaped) {
    if (same) {
        // It looks at the instances in their old place.
        std::copy(world.instances.begin(), world.instances.end(), before.instances.begin());
        std::swap(world.instances, before.instances);
        world.accelerator = std::move(before.accelerator);
        return {};
    }
    auto accelerator = make_accelerator(world.instances, world.scene.settings, before.accelerator.get(), reshaped);
    if (!accelerator) return tl::unexpected(accelerator.error());
    world.accelerator = std::move(*accelerator);
    return {};
}

}  // namespace crescente::render
