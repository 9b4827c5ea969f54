// A scene made ready for tracing: instances at their places, materials as lobes, lights, camera rays, and the accelerator.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "accel/accelerator.h"
#include "base/error.h"
#include "render/camera_rays.h"
#include "render/emitters.h"
#include "render/environment.h"
#include "render/lens.h"
#include "render/light.h"
#include "render/lobes.h"
#include "render/medium.h"
#include "render/moments.h"
#include "render/textured_material.h"
#include "scene/scene.h"

namespace crescente::render {

struct World {
    World(scene::Scene of, const CameraRays& seen_by) : scene(std::move(of)), camera(seen_by) {}

    scene::Scene scene;  // the shapes that the instances point into; must not move its shapes
    std::vector<accel::Instance> instances;
    std::vector<std::uint32_t> node_of_instance;  // index of the scene's node
    std::vector<std::uint64_t> identity;          // by instance: scene::Appearance::identity
    std::vector<Bounds> boxes;                    // by instance, in world space
    std::vector<Bounds> shape_boxes;              // by instance, in the shape's space
    std::vector<std::uint32_t> first_slot;        // by instance: where its materials begin in `slots`
    std::vector<std::uint32_t> slots;             // index into lobes
    std::vector<std::uint8_t> one_sided;          // beside slots: what the instances point into
    std::vector<Lobes> lobes;                     // one for each material of the scene, without its textures (surface_lobes.h), and a default one at the end
    std::vector<Lobes> blurred_lobes;             // the same for light that diffuse surfaces scattered before; empty: no other
    std::vector<Light> lights;                    // as points and directions; those of levels that do not sample stand in for what is sampled
    std::vector<Light> luminous;                  // those with extent, as they are
    Environment environment;
    CameraRays camera;                            // a pinhole, when the shutter opens: then all else is where it is said to be, too
    std::optional<Lens> lens;                     // through which the levels that sample look; none: they look through the pinhole, too
    std::unique_ptr<const Moments> moments;       // if the lens sees objects move
    std::unique_ptr<accel::Accelerator> accelerator;
    bool filters_light = false;  // some instance is not opaque
    bool absorbs = false;        // some instance is a medium with an attenuation
    std::vector<Medium> camera_media;
    Emitters emitters;           // what has extent, for the levels that sample it; none below them
    std::vector<std::shared_ptr<const TexturedMaterial>> textured;  // beside lobes; null: without textures; empty: no material has any
    std::vector<std::shared_ptr<const TexturedMaterial>> blurred_textured;  // as blurred_lobes
    bool bends_normals = false;                                     // some have relief

    const TexturedMaterial* textured_material(std::uint32_t material) const { return textured.empty() ? nullptr : textured[material].get(); }

    // Index into lobes of what a hit's surface is made of.
    std::uint32_t material(std::uint32_t instance, std::uint32_t slot) const {
        const auto own = slots_of(instance);
        return own[std::min<std::size_t>(slot, own.size() - 1)];
    }
    // By the slots of its shape, the last for all beyond: what an instance is made of. Never empty.
    std::span<const std::uint32_t> slots_of(std::uint32_t instance) const {
        const std::size_t first = first_slot[instance], end = instance + 1 < first_slot.size() ? first_slot[instance + 1] : slots.size();
        return {slots.data() + first, end - first};
    }
};

// Prepares the shapes for tracing. Errors: no camera, an accelerator that cannot be built. The scene must be valid.
Expected<std::unique_ptr<World>> world_of(scene::Scene scene);

// The same for a scene whose shapes are prepared, without the accelerator.
// `before`: of a scene that is much the same; what is costly to derive is taken over from there.
std::unique_ptr<World> world_without_accelerator(scene::Scene scene, const World* before = nullptr);

// An accelerator of the kind that the settings ask for. It may take over what one before knew of shapes, but those that were `reshaped` since. Error: it
// cannot be built.
Expected<std::unique_ptr<accel::Accelerator>> make_accelerator(std::span<const accel::Instance> instances, const scene::Settings& settings,
                                                               const accel::Accelerator* before, std::span<const geometry::Shape* const> reshaped);

// Whether the settings ask for the same accelerator.
bool same_accelerator(const scene::Settings& a, const scene::Settings& b);

// Builds the accelerator of a world after an edit that reshaped these shapes, or, if it would be the same, takes that of the world before, which is then of no more use. Error: it
// cannot be built; the world before keeps its own.
Expected<void> give_accelerator(World& world, World& before, bool same, std::span<const geometry::Shape* const> reshaped);

}  // namespace crescente::render
