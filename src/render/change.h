// What an edit changes for the trees that are kept: the difference between two worlds, by what the nodes of a forest depend on.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "render/instance_group.h"
#include "render/world.h"

namespace crescente::render {

// What became of a light. Each contains those before it.
enum class LightChange : std::uint8_t {
    none,
    strength,  // color or highlights: local light, no ray
    reach,     // cone, falloff, range: rays to points that it did not reach
    way,       // its place or direction: all its rays
};

// What became of a material.
struct LobesChange {
    bool light = false;   // what it sends back
    bool rays = false;    // the rays that it sends, or their weights
    bool bends = false;   // where refracted rays go
};
// Of materials by their index in two worlds.
LobesChange change_between(const World& before, std::uint32_t material_before, const World& now, std::uint32_t material_now);

struct Change {
    bool anew = false;           // everything on the way from the camera: trees begin again
    bool same_geometry = true;   // no instance came, went, moved or took another shape

    // Instances. A ray that ended on one that is gone is traced again; one that meets one that came before its end ends there now.
    std::vector<std::uint32_t> instance_now;  // by index before; no_node: gone, or moved, or of another shape
    bool renumbered = false;                  // some instance that stays has another index now
    // As they are now, or were before; null: none. Lights: what may pass or keep light that did not, or did, before: with those that let light through otherwise.
    std::shared_ptr<const InstanceGroup> came, light_went, light_came;

    std::vector<std::uint8_t> reassigned;     // by instance now: it may be of other materials
    bool any_reassigned = false;
    std::vector<LobesChange> lobes;           // by index of lobes now
    bool any_lobes = false;
    bool lobes_only = false;                  // nothing else
    std::uint64_t lobes_bits = 0;             // those that changed, by index modulo 64
    bool all_lit = false;                     // what surrounds the scene lights surfaces otherwise

    std::vector<std::uint32_t> light_before;  // by light now; no_node: it is new
    std::vector<LightChange> lights;          // by light now
    std::size_t lights_before = 0;

    bool resamples = false;  // what samples told of lights with extent and of light between surfaces does not hold
    bool outdates_samples = false;  // only materials changed: samples elsewhere do not hold either, but may be shown until they are taken anew

    bool sky = false;        // what rays see that leave the scene
    bool frontier = false;   // threshold or depth bound
    bool depth = false;      // depth bound
    bool splitting = false;  // which pixels are split, or how often
    bool stages = false;     // the levels' stages are others

    bool touches_trees() const { return any_lobes || touches_more_than_lobes(); }
    bool touches_more_than_lobes() const;
};

// Of the world before only what was derived from its scene is looked at, not the scene, of which `settings_before` are given. `reshaped`: shapes that
// an edit gave another form. The change refers to both worlds.
Change change_between(const World& before, const scene::Settings& settings_before, const World& now, std::span<const geometry::Shape* const> reshaped);

}  // namespace crescente::render
