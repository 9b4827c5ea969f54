// Boxes in a hierarchy, opened in the order in which the ray meets them (Kay, Kajiya 1986, "Ray Tracing Complex Scenes"). One hierarchy holds all
// (instance, part) pairs with their boxes in the world.
#include <algorithm>

#include "accel/accelerator.h"
#include "accel/box_hierarchy.h"
#include "accel/box_ray.h"
#include "accel/parts.h"

namespace crescente::accel {

namespace {

// Beyond this, areas of boxes overflow; such parts are tried for every ray, like unbounded ones.
constexpr double largest_box = 1e100;

Vec3 absolute_product(const Affine& a, Vec3 v) { return abs(a.x) * v.x + abs(a.y) * v.y + abs(a.z) * v.z; }

// How far from a part's box in the world a hit of its narrow phase may lie, in double. Both phases round, and an instance's two transforms are
// inverses of each other up to rounding only; its condition multiplies both.
class Slack {
public:
    // local: the largest coordinate of the instance's boxes in the shape's space.
    void include(const Instance& instance, double local) {
        const Affine& there = instance.to_world;
        const Affine& back = instance.to_local;
        const Vec3 ones{1, 1, 1};
        const Affine round_trip = there * back;
        const Vec3 residual = abs(round_trip.x - Vec3{1, 0, 0}) + abs(round_trip.y - Vec3{0, 1, 0}) + abs(round_trip.z - Vec3{0, 0, 1});
        const Vec3 condition = absolute_product(there, absolute_product(back, ones));
        relative_ = std::max(relative_, rounding * max_component(condition) + max_component(residual));
        absolute_ = std::max(absolute_, max_component(abs(round_trip.origin)));
        extent_ = std::max(extent_, max_component(absolute_product(there, ones * local) + abs(there.origin)));
    }

    // For rays from this origin, in the units of the world.
    double of(Vec3 origin) const { return relative_ * (max_component(abs(origin)) + extent_) + absolute_; }

private:
    // Of a shape's own test, relative to the distances from the ray's origin and the shape's.
    static constexpr double rounding = 0x1p-40;

    double relative_ = rounding, absolute_ = 0, extent_ = 0;
};

// What one batch reuses from ray to ray.
struct Scratch {
    struct Entry {
        double t;
        std::uint32_t node;
    };
    std::vector<Entry> queue;
    std::vector<std::uint32_t> stack;
    TestCounts counts;
};

class KayKajiya final : public Accelerator {
public:
    KayKajiya(std::span<const Instance> instances, const KayKajiyaOptions& options) : instances_(instances), options_(options) {
        std::vector<PartRef> refs;
        std::vector<Bounds> boxes;
        std::vector<double> largest(instances.size(), 0.0);
        for_each_part(instances, [&](PartRef ref, const Bounds& local) {
            const Bounds box = transform(instances[ref.instance].to_world, local);
            if (box.largest_coordinate() < largest_box && local.largest_coordinate() < largest_box) {
                refs.push_back(ref);
                boxes.push_back(box);
                largest[ref.instance] = std::max(largest[ref.instance], local.largest_coordinate());
            } else {
                unbounded_.push_back(ref);
            }
        });
        for (const PartRef ref : refs) {
            if (largest[ref.instance] < 0) continue;
            slack_.include(instances[ref.instance], largest[ref.instance]);
            largest[ref.instance] = -1;
        }
        BoxHierarchy hierarchy = build_box_hierarchy(boxes);
        nodes_ = std::move(hierarchy.nodes);
        parts_.reserve(refs.size());
        for (const std::uint32_t i : hierarchy.order) parts_.push_back(refs[i]);
    }

    void nearest(std::span<const Ray> rays, std::span<Hit> hits, Coherence, TestCounts& counts) const override {
        Scratch scratch;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            LocalRay local(instances_, rays[i]);
            Hit hit;
            search(rays[i], scratch, [&](PartRef ref, BoxRay& ray) {
                nearest_in_part(instances_[ref.instance], ref.instance, ref.part, local.in(ref.instance), hit);
                if (hit.t < ray.t_end()) ray.end_at(hit.t);
                return true;
            });
            hits[i] = hit;
        }
        counts += scratch.counts;
    }

    void shadow(std::span<const Ray> rays, std::span<Hit> occluders, std::vector<Crossing>& crossings, Coherence,
                TestCounts& counts) const override {
        Scratch scratch;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            LocalRay local(instances_, rays[i]);
            Hit occluder;
            search(rays[i], scratch, [&](PartRef ref, BoxRay&) {
                const Instance& instance = instances_[ref.instance];
                if (!instance.opaque) {
                    all_in_part(instance, ref.instance, ref.part, local.in(ref.instance), static_cast<std::uint32_t>(i), crossings);
                    return true;
                }
                nearest_in_part(instance, ref.instance, ref.part, local.in(ref.instance), occluder, Sense::light);
                return !occluder.found();
            });
            occluders[i] = occluder;
        }
        counts += scratch.counts;
    }

    std::size_t bytes() const override {
        return sizeof *this + nodes_.capacity() * sizeof(BoxNode) + (parts_.capacity() + unbounded_.capacity()) * sizeof(PartRef);
    }

private:
    // Calls visit(PartRef, BoxRay&) for the parts whose boxes the ray meets, until it returns false. It may shorten the ray.
    template <class Visit>
    void search(const Ray& world, Scratch& scratch, Visit&& visit) const {
        BoxRay ray(world, slack_.of(world.origin));
        for (const PartRef ref : unbounded_) {
            ++scratch.counts.shape_tests;
            if (!visit(ref, ray)) return;
        }
        if (nodes_.empty()) return;
        if (options_.priority_queue) {
            nearest_first(ray, scratch, visit);
        } else {
            depth_first(ray, scratch, visit);
        }
    }

    // Where the ray enters a node's box, or BoxRay::missed.
    double entry(const BoxRay& ray, const BoxNode& node, TestCounts& counts) const {
        if (options_.octant_rejection && ray.rejects(node.box)) return BoxRay::missed;
        ++counts.box_tests;
        return ray.entry(node.box);
    }

    template <class Visit>
    bool open_leaf(const BoxNode& leaf, BoxRay& ray, TestCounts& counts, Visit& visit) const {
        for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
            ++counts.shape_tests;
            if (!visit(parts_[i], ray)) return false;
        }
        return true;
    }

    // A priority queue of boxes by the distance where the ray enters them; once the first of them begins beyond the nearest hit, it is final.
    // A box that begins at the very distance of the hit is still opened: it may hold a hit that ties and comes first by identity.
    template <class Visit>
    void nearest_first(BoxRay& ray, Scratch& scratch, Visit& visit) const {
        auto& queue = scratch.queue;
        const auto later = [](const Scratch::Entry& a, const Scratch::Entry& b) { return a.t > b.t; };
        const auto put = [&](std::uint32_t node) {
            const double t = entry(ray, nodes_[node], scratch.counts);
            if (t == BoxRay::missed) return;
            queue.push_back({t, node});
            std::push_heap(queue.begin(), queue.end(), later);
        };
        queue.clear();
        put(0);
        while (!queue.empty() && queue.front().t <= ray.t_end()) {
            const BoxNode& node = nodes_[queue.front().node];
            std::pop_heap(queue.begin(), queue.end(), later);
            queue.pop_back();
            if (node.leaf()) {
                if (!open_leaf(node, ray, scratch.counts, visit)) return;
            } else {
                put(node.first);
                put(node.first + 1);
            }
        }
    }

    // In the order in which the hierarchy is stored.
    template <class Visit>
    void depth_first(BoxRay& ray, Scratch& scratch, Visit& visit) const {
        auto& stack = scratch.stack;
        stack.assign(1, 0);
        while (!stack.empty()) {
            const BoxNode& node = nodes_[stack.back()];
            stack.pop_back();
            if (entry(ray, node, scratch.counts) == BoxRay::missed) continue;
            if (node.leaf()) {
                if (!open_leaf(node, ray, scratch.counts, visit)) return;
            } else {
                stack.push_back(node.first + 1);
                stack.push_back(node.first);
            }
        }
    }

    std::span<const Instance> instances_;
    KayKajiyaOptions options_;
    Slack slack_;
    std::vector<BoxNode> nodes_;
    std::vector<PartRef> parts_;      // in the order of the hierarchy's leaves
    std::vector<PartRef> unbounded_;  // tried for every ray
};

}  // namespace

std::unique_ptr<Accelerator> make_kay_kajiya(std::span<const Instance> instances, const KayKajiyaOptions& options) {
    return std::make_unique<KayKajiya>(instances, options);
}

}  // namespace crescente::accel
