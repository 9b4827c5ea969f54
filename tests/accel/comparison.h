// Compares an accelerator with the oracle to the bit. A disagreement is shrunk to the fewest instances that still show it, and told so that it can
// be repeated: the scene's recipe and the ray in hexadecimal.
#pragma once

#include <bit>
#include <functional>
#include <sstream>

#include "accel/joined.h"
#include "accel/random_rays.h"

namespace crescente::accel::testing {

using Factory = std::function<std::unique_ptr<Accelerator>(std::span<const Instance>)>;

inline std::unique_ptr<Accelerator> embree(std::span<const Instance> instances) {
    auto made = make_embree(instances);
    return made ? std::move(*made) : nullptr;
}

// Every third instance in an accelerator of its own.
class InTwoParts final : public Accelerator {
public:
    explicit InTwoParts(std::span<const Instance> instances) {
        std::vector<std::uint32_t> places[2];
        for (std::uint32_t i = 0; i < instances.size(); ++i) {
            instances_[i % 3 == 0].push_back(instances[i]);
            places[i % 3 == 0].push_back(i);
        }
        Some parts[2];
        for (int k = 0; k < 2; ++k) {
            if (!instances_[k].empty()) parts[k] = {make_kay_kajiya(instances_[k], {}), std::make_shared<const std::vector<std::uint32_t>>(places[k])};
        }
        joined_ = make_joined(parts[0], parts[1]);
    }
    void nearest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, TestCounts& counts) const override { joined_->nearest(rays, hits, coherence, counts); }
    void shadow(std::span<const Ray> rays, std::span<Hit> occluders, std::vector<Crossing>& crossings, Coherence coherence, TestCounts& counts) const override {
        joined_->shadow(rays, occluders, crossings, coherence, counts);
    }
    std::size_t bytes() const override { return joined_->bytes(); }

private:
    std::vector<Instance> instances_[2];
    std::unique_ptr<Accelerator> joined_;
};

inline const std::vector<std::pair<std::string, Factory>>& factories() {
    static const auto kay_kajiya = [](bool octant, bool queue) {
        return [=](std::span<const Instance> instances) { return make_kay_kajiya(instances, {octant, queue}); };
    };
    static const std::vector<std::pair<std::string, Factory>> all{
        {"kay-kajiya, octants and queue", kay_kajiya(true, true)},
        {"kay-kajiya, octants", kay_kajiya(true, false)},
        {"kay-kajiya, queue", kay_kajiya(false, true)},
        {"kay-kajiya, neither", kay_kajiya(false, false)},
        {"joined", [](std::span<const Instance> instances) { return std::make_unique<InTwoParts>(instances); }},
        {"embree", [](std::span<const Instance> instances) { return embree(instances); }},
    };
    return all;
}

inline bool same(const Hit& a, const Hit& b) {
    return std::bit_cast<std::uint64_t>(a.t) == std::bit_cast<std::uint64_t>(b.t) && a.instance == b.instance && a.primitive == b.primitive;
}

inline std::vector<Hit> nearest(const Accelerator& accelerator, std::span<const Ray> rays, Coherence coherence = Coherence::incoherent) {
    std::vector<Hit> hits(rays.size());
    TestCounts counts;
    accelerator.nearest(rays, hits, coherence, counts);
    return hits;
}

struct Shadow {
    Hit occluder;
    std::vector<Hit> crossings;  // sorted; complete if there is no occluder
};

inline std::vector<Shadow> shadow(const Accelerator& accelerator, std::span<const Ray> rays, Coherence coherence = Coherence::incoherent) {
    std::vector<Hit> occluders(rays.size());
    std::vector<Crossing> crossings;
    TestCounts counts;
    accelerator.shadow(rays, occluders, crossings, coherence, counts);
    std::vector<Shadow> shadows(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) shadows[i].occluder = occluders[i];
    for (const Crossing& crossing : crossings) shadows.at(crossing.ray).crossings.push_back(crossing.hit);
    for (Shadow& s : shadows) std::sort(s.crossings.begin(), s.crossings.end(), before);
    return shadows;
}

// Any occluder will do, but it must be one.
inline bool is_occluder(const Hit& hit, std::span<const Instance> instances, const Ray& ray) {
    if (hit.instance >= instances.size() || !instances[hit.instance].opaque) return false;
    const Instance& instance = instances[hit.instance];
    for (std::uint32_t part = 0; part < geometry::parts(*instance.shape); ++part) {
        Hit own;
        nearest_in_part(instance, hit.instance, part, to_local(instance, ray), own, Sense::light);
        if (same(own, hit)) return true;
    }
    return false;
}

inline bool same(const Shadow& oracle, const Shadow& other) {
    if (oracle.occluder.found() != other.occluder.found()) return false;
    return oracle.occluder.found() || std::equal(oracle.crossings.begin(), oracle.crossings.end(), other.crossings.begin(), other.crossings.end(),
                                                 [](const Hit& a, const Hit& b) { return same(a, b); });
}

inline std::string text(const Hit& hit) {
    std::ostringstream out;
    if (!hit.found()) return "nothing";
    out << "t " << std::hexfloat << hit.t << std::defaultfloat << " (" << hit.t << ") instance " << hit.instance << " primitive " << hit.primitive;
    return out.str();
}

inline std::string text(const Shadow& s) {
    if (s.occluder.found()) return "occluded: " + text(s.occluder);
    std::string result = std::to_string(s.crossings.size()) + " crossings";
    for (const Hit& hit : s.crossings) result += "; " + text(hit);
    return result;
}

inline std::string text(Vec3 v) {
    std::ostringstream out;
    out << std::hexfloat << "{" << v.x << ", " << v.y << ", " << v.z << "}";
    return out.str();
}

inline std::string text(const Ray& ray) {
    std::ostringstream out;
    out << "origin " << text(ray.origin) << " direction " << text(ray.direction) << std::hexfloat << " t_min " << ray.t_min << " t_max " << ray.t_max;
    return out.str();
}

// The fewest instances that still `disagree`, in their order, by leaving out ever smaller runs (Zeller, Hildebrandt 2002, "Simplifying and Isolating
// Failure-Inducing Input", without the complements).
inline std::vector<Instance> shrink(std::vector<Instance> instances, const std::function<bool(std::span<const Instance>)>& disagree) {
    for (std::size_t run = std::max<std::size_t>(1, instances.size() / 2); run > 0; run /= 2) {
        for (std::size_t first = 0; first < instances.size();) {
            std::vector<Instance> fewer = instances;
            fewer.erase(fewer.begin() + first, fewer.begin() + std::min(first + run, fewer.size()));
            if (!fewer.empty() && disagree(fewer)) {
                instances = std::move(fewer);
            } else {
                first += run;
            }
        }
    }
    return instances;
}

// What went wrong with one ray: `ask` answers for one ray with one accelerator.
template <class Ask>
std::string report(const TestScene& scene, const Factory& make, const Ray& ray, Ask&& ask) {
    const auto disagree = [&](std::span<const Instance> instances) {
        return !same(ask(*make_linear(instances), ray), ask(*make(instances), ray));
    };
    std::ostringstream out;
    out << "  scene " << scene.name << ", seed " << scene.seed << ", center " << text(scene.center) << ", radius " << scene.radius << "\n  ray " << text(ray);
    if (!disagree(scene.instances)) {
        out << "\n  alone, the ray agrees: the answer depends on its companions";
        return out.str();
    }
    const std::vector<Instance> few = shrink(scene.instances, disagree);
    out << "\n  with " << few.size() << " instances: linear " << text(ask(*make_linear(few), ray)) << "\n  other " << text(ask(*make(few), ray));
    for (const Instance& instance : few) {
        const Affine& m = instance.to_world;
        out << "\n  instance of " << geometry::shape_names[instance.shape->index()] << " x " << text(m.x) << " y " << text(m.y) << " z " << text(m.z)
            << " origin " << text(m.origin) << (instance.opaque ? " opaque" : "");
    }
    return out.str();
}

// All disagreements of `make` with the oracle's answers, the first ones in detail; empty if there are none.
template <class Answer, class Ask>
std::string disagreements(const TestScene& scene, const Factory& make, std::span<const Ray> rays, std::span<const Answer> expected,
                          std::span<const Answer> actual, Ask&& ask) {
    constexpr std::size_t detailed = 2;
    std::size_t count = 0;
    std::string result;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (same(expected[i], actual[i])) continue;
        if (++count <= detailed) {
            result += "ray " + std::to_string(i) + ": linear " + text(expected[i]) + "\n  other " + text(actual[i]) + "\n" +
                      report(scene, make, rays[i], ask) + "\n";
        }
    }
    if (count > 0) result += std::to_string(count) + " of " + std::to_string(rays.size()) + " rays disagree";
    return result;
}

}  // namespace crescente::accel::testing
