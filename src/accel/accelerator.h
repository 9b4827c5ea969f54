// The face of an accelerator: batches of rays in, hits out. All accelerators give the same hits to the bit, since all use the narrow phase of
// narrow_phase.h and its order of hits; they differ in what they need not try.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "accel/narrow_phase.h"
#include "base/error.h"

namespace crescente::accel {

// Counted work. box_tests stay 0 where a library traverses the boxes.
struct TestCounts {
    std::uint64_t box_tests = 0, shape_tests = 0;

    TestCounts& operator+=(const TestCounts& other) {
        box_tests += other.box_tests;
        shape_tests += other.shape_tests;
        return *this;
    }
};

// Whether neighbouring rays of a batch run alike (camera rays, shadow rays to one light), so that packets pay.
enum class Coherence { coherent, incoherent };

// Crossings ray after ray, those of each in the order of `before`.
inline void sort_by_ray(std::vector<Crossing>& crossings) {
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.ray != b.ray ? a.ray < b.ray : before(a.hit, b.hit); });
}

class Accelerator {
public:
    virtual ~Accelerator() = default;

    // For each ray (direction of unit length) the first hit in the order of `before` with t_min < t <= t_max. hits[i] is written
    // for every i: with found() false if there is none.
    virtual void nearest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, TestCounts& counts) const = 0;

    // For each ray: occluders[i] is any hit on an opaque instance within the range, found() false if there is none. For
    // rays without an occluder, every crossing of what is not opaque is appended to `crossings`, in no particular order; for rays with
    // one, some may be.
    virtual void shadow(std::span<const Ray> rays, std::span<Hit> occluders, std::vector<Crossing>& crossings, Coherence coherence,
                        TestCounts& counts) const = 0;

    // Memory of the structure, without the shapes themselves.
    virtual std::size_t bytes() const = 0;
};

// Instances must outlive the accelerator and keep their places. Parts with empty bounds are never hit; shapes may be unbounded.
struct KayKajiyaOptions {
    bool octant_rejection = true;
    bool priority_queue = true;
};
std::unique_ptr<Accelerator> make_linear(std::span<const Instance> instances);
std::unique_ptr<Accelerator> make_kay_kajiya(std::span<const Instance> instances, const KayKajiyaOptions& options);
// Built on all cores. What is the same wherever a shape stands is taken from the accelerator `before`, if that is of this kind, unless the shape is among
// those `reshaped` since; it is shared. All shapes that it knew must still be where they were. Error: resource, if Embree cannot get the memory.
Expected<std::unique_ptr<Accelerator>> make_embree(std::span<const Instance> instances, const Accelerator* before = nullptr,
                                                   std::span<const geometry::Shape* const> reshaped = {});

}  // namespace crescente::accel
