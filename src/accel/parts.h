// What linear and kay-kajiya share: the list of parts that can be hit at all, and a ray carried into the space of one instance after another.
#pragma once

#include <cstdint>
#include <span>

#include "accel/narrow_phase.h"

namespace crescente::accel {

// A part of an instance, in 8 bytes.
struct PartRef {
    std::uint32_t instance = 0, part = 0;
};

// Calls visit(PartRef, Bounds in the shape's space) for each part that can be hit, in the order of identity. A part without
// extent cannot, nor can an instance that its transform has flattened.
template <class Visit>
void for_each_part(std::span<const Instance> instances, Visit&& visit) {
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        const Affine& inverse = instances[i].to_local;
        if (!is_finite(inverse.x) || !is_finite(inverse.y) || !is_finite(inverse.z) || !is_finite(inverse.origin)) continue;
        const geometry::Shape& shape = *instances[i].shape;
        const std::uint32_t count = geometry::parts(shape);
        for (std::uint32_t part = 0; part < count; ++part) {
            const Bounds box = geometry::part_bounds(shape, part);
            if (!box.empty()) visit(PartRef{i, part}, box);
        }
    }
}

// A world ray in the space of the instance asked for last; asking for the same one again costs nothing.
class LocalRay {
public:
    LocalRay(std::span<const Instance> instances, const Ray& world) : instances_(instances), world_(world) {}

    const Ray& in(std::uint32_t instance) {
        if (instance != instance_) {
            local_ = to_local(instances_[instance], world_);
            instance_ = instance;
        }
        return local_;
    }

private:
    std::span<const Instance> instances_;
    const Ray& world_;
    Ray local_;
    std::uint32_t instance_ = none;
};

}  // namespace crescente::accel
