// What accelerators share: the list of parts that can be hit at all, and a ray carried into the space of one instance after another.
#pragma once

#include <cstdint>
#include <span>

#include "accel/narrow_phase.h"

namespace crescente::accel {

// A part of an instance, in 8 bytes.
struct PartRef {
    std::uint32_t instance = 0, part = 0;
};

// An instance that its transform has flattened has no inverse, and cannot be hit.
inline bool has_inverse(const Instance& instance) {
    const Affine& m = instance.to_local;
    return is_finite(m.x) && is_finite(m.y) && is_finite(m.z) && is_finite(m.origin);
}

// Calls visit(PartRef, Bounds in the shape's space) for each part that can be hit, in the order of identity. A part without
// extent cannot.
template <class Visit>
void for_each_part(std::span<const Instance> instances, Visit&& visit) {
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        if (!has_inverse(instances[i])) continue;
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
