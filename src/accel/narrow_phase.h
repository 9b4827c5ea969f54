// The narrow phase that all accelerators share: a world ray against a part of an instance, in double, in the shape's own space.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/kinds.h"
#include "math/transform.h"

namespace crescente::accel {

using geometry::Ray;
using namespace math;

inline constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

// A shape at its place in the world.
struct Instance {
    const geometry::Shape* shape = nullptr;
    Affine to_world, to_local;
    bool identity = true;     // to_world changes nothing
    bool translation = true;  // to_world moves only
    double stretch = 1;       // bound on the length of what to_world makes of a unit vector
    bool opaque = true;       // false: light passes, filtered; each crossing is reported to shadow rays

    Instance() = default;
    Instance(const geometry::Shape& s, const Affine& place, bool is_opaque)
        : shape(&s),
          to_world(place),
          to_local(inverse(place)),
          identity(place == Affine{}),
          translation(place == Affine::translation(place.origin)),
          stretch(std::max({length(place.x), length(place.y), length(place.z)}) * 1.7320508075688773),
          opaque(is_opaque) {
        if (translation) to_local = Affine::translation(-place.origin);
    }
};

struct Hit {
    double t = std::numeric_limits<double>::infinity();
    std::uint32_t instance = none;  // none: nothing was hit
    std::uint32_t primitive = 0;

    bool found() const { return instance != none; }
};

// The order of hits along a ray: by distance, ties by identity. It decides what is nearest, so that no traversal order or
// hierarchy ever does.
constexpr bool before(const Hit& a, const Hit& b) {
    if (a.t != b.t) return a.t < b.t;
    if (a.instance != b.instance) return a.instance < b.instance;
    return a.primitive < b.primitive;
}

// A shadow ray's passage through something that is not opaque.
struct Crossing {
    std::uint32_t ray = 0;  // index in the batch
    Hit hit;
};

// The ray in the shape's space, with the same parameter t.
inline Ray to_local(const Instance& instance, const Ray& ray) {
    Ray local = ray;
    if (instance.translation) {
        local.origin = ray.origin + instance.to_local.origin;
        return local;
    }
    local.origin = instance.to_local.point(ray.origin);
    local.direction = instance.to_local.vector(ray.direction);
    return local;
}

// The part that a primitive of a hit belongs to.
inline std::uint32_t part_of(const Instance& instance, std::uint32_t primitive) {
    return geometry::parts(*instance.shape) == 1 ? 0 : primitive;
}

// Tries one part with a ray already in the shape's space; `hit` becomes the earlier of itself and the new hit.
inline void nearest_in_part(const Instance& instance, std::uint32_t index, std::uint32_t part, const Ray& local, Hit& hit) {
    Ray ray = local;
    ray.t_max = std::min(ray.t_max, hit.t);
    if (const auto found = geometry::intersect(*instance.shape, part, ray)) {
        const Hit candidate{found->t, index, found->primitive};
        if (before(candidate, hit)) hit = candidate;
    }
}

// Appends every crossing of the part within the ray's range.
inline void all_in_part(const Instance& instance, std::uint32_t index, std::uint32_t part, const Ray& local, std::uint32_t ray_index,
                        std::vector<Crossing>& crossings) {
    Ray ray = local;
    while (const auto found = geometry::intersect(*instance.shape, part, ray)) {
        crossings.push_back({ray_index, {found->t, index, found->primitive}});
        ray.t_min = found->t;
    }
}

}  // namespace crescente::accel
