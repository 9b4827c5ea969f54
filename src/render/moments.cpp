#include "render/moments.h"

#include <algorithm>
#include <new>

#include "parallel/pool.h"
#include "render/world.h"
#include "scene/hierarchy.h"

namespace crescente::render {
namespace {

// Enough for steps that nobody sees in blur of a hundred pixels; fewer where there are very many objects, of which each moment has its own list.
std::size_t moments_for(std::size_t instances) {
    constexpr std::size_t most = 64, least = 8, in_all = std::size_t{1} << 18;
    return std::clamp(in_all / std::max<std::size_t>(instances, 1), least, most);
}

std::vector<std::uint32_t> moving_instances(const World& world) {
    std::vector<std::uint32_t> moving;
    std::uint32_t i = 0;
    scene::walk_appearances(world.scene, world.scene.camera->shutter_open, [&](const scene::Appearance& at) {
        if (at.motion != 0) moving.push_back(i);
        ++i;
    });
    return moving;
}

// All of a world but its accelerator, and of its scene but what was derived from it. Every member is named, so that a new one cannot be forgotten here.
std::unique_ptr<World> copy_of(const World& world) {
    const auto& [scene, instances, node_of_instance, identity, boxes, shape_boxes, first_slot, slots, one_sided, lobes, blurred_lobes, lights, luminous, environment, camera, lens,
                 moments, accelerator, filters_light, absorbs, camera_media, emitters, textured, blurred_textured, bends_normals] = world;
    scene::Scene bare;
    bare.materials = scene.materials, bare.camera = scene.camera, bare.settings = scene.settings, bare.unit = scene.unit;
    auto copy = std::make_unique<World>(std::move(bare), camera);
    copy->instances = instances, copy->node_of_instance = node_of_instance, copy->identity = identity, copy->boxes = boxes, copy->shape_boxes = shape_boxes;
    copy->first_slot = first_slot, copy->slots = slots, copy->one_sided = one_sided, copy->lobes = lobes, copy->blurred_lobes = blurred_lobes;
    copy->lights = lights, copy->luminous = luminous, copy->environment = environment, copy->lens = lens, copy->filters_light = filters_light, copy->absorbs = absorbs;
    copy->camera_media = camera_media, copy->emitters = emitters, copy->textured = textured, copy->blurred_textured = blurred_textured;
    copy->bends_normals = bends_normals;
    return copy;  // its instances look at the sides of the original's slots, which stay where they are
}

accel::Some accelerator_of(std::span<const accel::Instance> instances, std::shared_ptr<const std::vector<std::uint32_t>> places, const World& world) {
    if (instances.empty()) return {};
    auto made = make_accelerator(instances, world.scene.settings, world.accelerator.get(), {});
    if (!made) throw std::bad_alloc();
    return {std::move(*made), std::move(places)};
}

}  // namespace

Moments::Moments(const World& world) : moving_(moving_instances(world)), worlds_(moments_for(world.instances.size())), moving_instances_(worlds_.size()), made_(worlds_.size()) {}

Moments::~Moments() = default;

const World& Moments::at(const World& world, int moment) const {
    const auto k = static_cast<std::size_t>(moment);
    if (const World* made = made_[k].load(std::memory_order_acquire)) return *made;
    const std::lock_guard lock(mutex_);
    if (worlds_[k]) return *worlds_[k];
    parallel::alone([&] {
        auto now = copy_of(world);
        std::vector<accel::Instance>& moving = moving_instances_[k];
        moving.clear();
        std::uint32_t i = 0;
        scene::walk_appearances(world.scene, world.lens->time(share(moment)), [&](const scene::Appearance& at) {
            if (at.motion != 0) {
                accel::Instance& instance = now->instances[i];
                const auto sides = instance.one_sided;
                instance = accel::Instance(*instance.shape, at.to_world, instance.opaque);
                instance.one_sided = sides;
                now->boxes[i] = transform(at.to_world, now->shape_boxes[i]);
                moving.push_back(instance);
            }
            ++i;
        });
        if (!still_.places) {
            auto places = std::make_shared<std::vector<std::uint32_t>>();
            still_instances_.clear();
            auto next = moving_.begin();
            for (std::uint32_t s = 0; s < world.instances.size(); ++s) {
                if (next != moving_.end() && *next == s) ++next;
                else places->push_back(s), still_instances_.push_back(world.instances[s]);
            }
            still_ = accelerator_of(still_instances_, places, world);
            still_.places = places;
        }
        now->accelerator = accel::make_joined(still_, accelerator_of(moving, std::make_shared<const std::vector<std::uint32_t>>(moving_), world));
        now->emitters = Emitters(*now);
        worlds_[k] = std::move(now);
    });
    made_[k].store(worlds_[k].get(), std::memory_order_release);
    return *worlds_[k];
}

std::size_t Moments::bytes() const {
    const std::lock_guard lock(mutex_);
    std::size_t sum = still_.accelerator ? still_.accelerator->bytes() : 0;
    for (const auto& world : worlds_) {
        if (!world) continue;
        const std::size_t shared = still_.accelerator ? still_.accelerator->bytes() : 0;
        sum += world->accelerator->bytes() - shared + world->instances.size() * (sizeof(accel::Instance) + sizeof(Bounds));
    }
    return sum;
}

}  // namespace crescente::render
