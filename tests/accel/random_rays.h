// Rays that are hard for accelerators.
#pragma once

#include "accel/random_scenes.h"

namespace crescente::accel::testing {

inline Ray ray_through(Vec3 origin, Vec3 direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    return ray;
}

inline Vec3 near_scene(const TestScene& scene, Random& random) {
    if (random.chance(0.3)) {  // at a target, seen from a distance of the target's own neighbourhood
        const Vec3 target = scene.targets[random.below(scene.targets.size())];
        return target + random.in_cube(scene.radius * std::pow(10.0, random.uniform(-6, 0)));
    }
    return scene.center + random.in_cube(2 * scene.radius);
}

inline Ray random_ray(const TestScene& scene, Random& random) {
    const Vec3 origin = near_scene(scene, random);
    const Vec3 target = scene.targets[random.below(scene.targets.size())];
    const Vec3 other = scene.targets[random.below(scene.targets.size())];
    switch (random.below(8)) {
        case 0:  // anywhere
            return ray_through(origin, random.direction());
        case 1:  // through a vertex, an edge or a corner
            if (target == origin) return ray_through(origin, random.direction());
            return ray_through(origin, normalize(target - origin));
        case 2: {  // parallel to an axis, through a target exactly; with zeros of both signs
            const int axis = static_cast<int>(random.below(3));
            Vec3 direction{random.chance(0.5) ? 0.0 : -0.0, random.chance(0.5) ? 0.0 : -0.0, random.chance(0.5) ? 0.0 : -0.0};
            direction[axis] = random.chance(0.5) ? 1 : -1;
            Vec3 from = target;
            from[axis] -= direction[axis] * scene.radius * random.uniform(-0.5, 4);
            return ray_through(from, direction);
        }
        case 3: {  // parallel to a coordinate plane, through a target
            Vec3 direction = random.direction();
            direction[static_cast<int>(random.below(3))] = 0;
            direction = normalize(direction);
            return ray_through(target - direction * (scene.radius * random.uniform(-0.5, 4)), direction);
        }
        case 4: {  // from one target to another: within faces, along edges, across corners
            if (target == other) return ray_through(origin, random.direction());
            const Vec3 direction = normalize(other - target);
            return ray_through(target - direction * (random.chance(0.3) ? 0 : scene.radius * random.uniform(0, 2)), direction);
        }
        case 5: {  // from a thousand scene sizes away, at a target
            const Vec3 direction = random.direction();
            return ray_through(target - direction * (1000 * scene.radius), direction);
        }
        case 6: {  // from far away, past a target closely
            const Vec3 direction = random.direction();
            const Vec3 aside = random.in_cube(scene.radius * std::pow(10.0, random.uniform(-12, -1)));
            return ray_through(target + aside - direction * (scene.radius * std::pow(10.0, random.uniform(-3, 3))), direction);
        }
        default: {  // almost parallel to an axis
            Vec3 direction = random.in_cube(std::pow(10.0, random.uniform(-18, -4)));
            direction[static_cast<int>(random.below(3))] = random.chance(0.5) ? 1 : -1;
            direction = normalize(direction);
            return ray_through(target - direction * (scene.radius * random.uniform(0, 3)), direction);
        }
    }
}

// Also rays that end at a hit, begin at one, or start on a surface, and rays with a random range.
inline std::vector<Ray> random_rays(const TestScene& scene, std::size_t count, std::uint64_t seed, const Accelerator& oracle) {
    Random random(seed);
    std::vector<Ray> rays;
    while (rays.size() < count) {
        Ray ray = random_ray(scene, random);
        if (random.chance(0.3)) {
            Hit hit;
            TestCounts counts;
            oracle.nearest({&ray, 1}, {&hit, 1}, Coherence::incoherent, counts);
            if (hit.found()) {
                switch (random.below(4)) {
                    case 0: ray.t_max = hit.t; break;
                    case 1: ray.t_min = hit.t; break;
                    case 2: ray.t_max = std::nextafter(hit.t, 0.0); break;
                    default: ray = ray_through(ray.at(hit.t), random.direction()); break;
                }
            } else {
                ray.t_min = random.uniform(0, scene.radius);
                ray.t_max = ray.t_min + random.uniform(0, 2 * scene.radius);
            }
        }
        rays.push_back(ray);
    }
    return rays;
}

}  // namespace crescente::accel::testing
