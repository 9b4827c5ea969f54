#include "picture_rays.h"

#include <cmath>

namespace crescente::bench {
namespace {

using accel::Hit;
using math::Vec3;

// Numbers that depend on the place in the sequence only (SplitMix64; Steele, Lea, Flood 2014), from 0 to 1.
double random_number(std::uint64_t& state) {
    std::uint64_t z = state += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

PictureRays::PictureRays(const render::World& world, int width, int height, const Vec3* light) {
    for (int tile = 0; tile < width / 4 * (height / 4); ++tile) {
        for (int i = 0; i < 16; ++i) {
            const int x = tile % (width / 4) * 4 + i % 4, y = tile / (width / 4) * 4 + i / 4;
            camera.rays.push_back(world.camera.through(x + 0.5, y + 0.5));
        }
    }
    std::vector<Hit> hits(camera.rays.size());
    accel::TestCounts counts;
    world.accelerator->nearest(camera.rays, hits, accel::Coherence::coherent, counts);
    std::uint64_t state = 1;
    for (std::size_t i = 0; i < hits.size(); ++i) {
        if (!hits[i].found()) continue;
        const accel::Instance& instance = world.instances[hits[i].instance];
        const Vec3 at = camera.rays[i].at(hits[i].t), in = camera.rays[i].direction;
        const auto surface = geometry::surface(*instance.shape, hits[i].primitive, instance.to_local.point(at));
        const Vec3 outward = normalize(instance.to_local.transposed(surface.normal));
        const Vec3 normal = dot(in, outward) > 0 ? -outward : outward;
        const double offset = 1e-4 * length(at - camera.rays[i].origin);
        const Vec3 start = at + normal * offset;
        reflected.rays.push_back({start, normalize(in - normal * (2 * dot(in, normal)))});
        const double rise = std::sqrt(random_number(state)), turn = 2 * math::pi * random_number(state), out = std::sqrt(1 - rise * rise);
        const Vec3 side = math::perpendicular(normal);
        bounce.rays.push_back({start, normalize(normal * rise + (side * std::cos(turn) + cross(normal, side) * std::sin(turn)) * out)});
        if (!light) continue;
        const Vec3 to_light = *light - start;
        if (dot(to_light, normal) > 0) shadow.rays.push_back({start, normalize(to_light), 0, length(to_light)});
    }
}

std::size_t trace(const accel::Accelerator& accelerator, const Rays& rays, bool shadows) {
    std::vector<Hit> hits(PictureRays::batch);
    std::vector<accel::Crossing> crossings;
    std::size_t found = 0;
    for (std::size_t first = 0; first < rays.rays.size(); first += PictureRays::batch) {
        const auto some = std::span(rays.rays).subspan(first, std::min(PictureRays::batch, rays.rays.size() - first));
        const auto into = std::span(hits).first(some.size());
        accel::TestCounts counts;
        if (shadows) accelerator.shadow(some, into, crossings, rays.coherence, counts);
        else accelerator.nearest(some, into, rays.coherence, counts);
        for (const Hit& hit : into) found += hit.found();
    }
    return found;
}

}  // namespace crescente::bench
