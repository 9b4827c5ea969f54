// Every part of every instance is tried, in double: nothing that could be wrong. The oracle for the other accelerators.
#include "accel/accelerator.h"
#include "accel/parts.h"

namespace crescente::accel {

namespace {

class Linear final : public Accelerator {
public:
    explicit Linear(std::span<const Instance> instances) : instances_(instances) {
        for_each_part(instances, [this](PartRef ref, const Bounds&) { parts_.push_back(ref); });
    }

    void nearest(std::span<const Ray> rays, std::span<Hit> hits, Coherence, TestCounts& counts) const override {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            LocalRay ray(instances_, rays[i]);
            hits[i] = {};
            for (const auto [instance, part] : parts_) {
                nearest_in_part(instances_[instance], instance, part, ray.in(instance), hits[i]);
            }
        }
        counts.shape_tests += rays.size() * parts_.size();
    }

    void shadow(std::span<const Ray> rays, std::span<Hit> occluders, std::vector<Crossing>& crossings, Coherence,
                TestCounts& counts) const override {
        for (std::size_t i = 0; i < rays.size(); ++i) {
            LocalRay ray(instances_, rays[i]);
            occluders[i] = {};
            for (const auto [instance, part] : parts_) {
                if (instances_[instance].opaque) {
                    nearest_in_part(instances_[instance], instance, part, ray.in(instance), occluders[i], Sense::light);
                } else {
                    all_in_part(instances_[instance], instance, part, ray.in(instance), static_cast<std::uint32_t>(i), crossings);
                }
            }
        }
        counts.shape_tests += rays.size() * parts_.size();
    }

    std::size_t bytes() const override { return sizeof *this + parts_.capacity() * sizeof(PartRef); }

private:
    std::span<const Instance> instances_;
    std::vector<PartRef> parts_;
};

}  // namespace

std::unique_ptr<Accelerator> make_linear(std::span<const Instance> instances) { return std::make_unique<Linear>(instances); }

}  // namespace crescente::accel
