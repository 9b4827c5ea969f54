#include "render/growth.h"

#include <algorithm>

#include "math/octahedral.h"
#include "render/environment.h"
#include "render/medium.h"

namespace crescente::render {
namespace {

using accel::Coherence;
using accel::Hit;
using geometry::Ray;

Vec3 normal_of(const Node& node) { return {node.normal[0], node.normal[1], node.normal[2]}; }

// A start on the side of `direction` of a surface, clear of it.
Vec3 start(Vec3 position, Vec3 geometric_normal, double offset, Vec3 direction) {
    return position + geometric_normal * (dot(geometric_normal, direction) >= 0 ? offset : -offset);
}

}  // namespace

std::uint32_t Growth::add_roots(std::span<const LatticePoint> points, std::span<const std::array<std::uint32_t, 4>> tried_first) {
    constexpr double scale = 1.0 / (1 << subpixel_bits);
    const auto first = static_cast<std::uint32_t>(tile_.nodes.size());
    rays_.clear();
    for (const LatticePoint& p : points) rays_.push_back(world_.camera.through(p.x * scale, p.y * scale));
    hits_.resize(points.size());
    accel::TestCounts counts;

    const bool trust = settings_.subpixel_shortcut == scene::SubpixelShortcut::trust;
    std::vector<Hit> guesses(tried_first.size());
    for (std::size_t i = 0; i < tried_first.size(); ++i) {
        for (const std::uint32_t root : tried_first[i]) {
            const Node& node = tile_.nodes[root];
            if (node.left_scene()) continue;
            const accel::Instance& instance = world_.instances[node.instance];
            accel::nearest_in_part(instance, node.instance, accel::part_of(instance, node.primitive), accel::to_local(instance, rays_[i]), guesses[i]);
            ++counts.shape_tests;
        }
        if (!guesses[i].found()) continue;
        ++tile_.tests.shortcut_rays;
        rays_[i].t_max = guesses[i].t;  // hits at the same distance are still found: ties go by identity
    }
    world_.accelerator->nearest(rays_, hits_, Coherence::coherent, counts);
    for (std::size_t i = 0; i < guesses.size(); ++i) {
        if (!guesses[i].found()) continue;
        if (hits_[i].instance != guesses[i].instance || hits_[i].primitive != guesses[i].primitive) ++tile_.tests.shortcut_wrong;
        if (trust || accel::before(guesses[i], hits_[i])) hits_[i] = guesses[i];
    }
    tile_.rays.camera += points.size();
    tile_.tests.box_tests += counts.box_tests;
    tile_.tests.shape_tests += counts.shape_tests;
    for (std::size_t i = 0; i < points.size(); ++i) {
        append(rays_[i], hits_[i], {}, 1 - points[i].y * scale / world_.camera.height());
    }
    return first;
}

void Growth::append(const Ray& ray, const Hit& hit, const Seed& seed, double picture_height) {
    Node& node = tile_.nodes.emplace_back();
    node.parent = seed.parent;
    node.weight = seed.weight;
    node.depth = seed.depth;
    node.crossed = seed.crossed;
    if (!hit.found()) {
        node.position = ray.direction;
        node.shadowed = true;
        const bool backdrop = world_.environment.backdrop && seed.parent == no_node;
        node.local = backdrop ? backdrop_radiance(world_.environment, picture_height) : environment_radiance(world_.environment, ray.direction);
        return;
    }
    const accel::Instance& instance = world_.instances[hit.instance];
    const Ray local = accel::to_local(instance, ray);
    const geometry::SurfacePoint surface = geometry::surface(*instance.shape, hit.primitive, local.at(hit.t));
    Vec3 geometric = surface.normal, shading = surface.shading_normal;
    double error = surface.error;
    node.position = surface.position;
    if (!instance.identity) {
        node.position = instance.to_world.point(surface.position);
        geometric = normalize(instance.to_local.transposed(geometric));
        shading = normalize(instance.to_local.transposed(shading));
        const Affine& m = instance.to_world;
        error *= std::max({length(m.x), length(m.y), length(m.z)}) * 1.7320508075688773;
        error += 16 * std::numeric_limits<double>::epsilon() * max_component(abs(m.origin));
    }
    error += 16 * std::numeric_limits<double>::epsilon() * max_component(abs(node.position));
    // Several times the bound: a ray must start so far off that its own intersection with the same surface, with the rounding of that
    // computation, lies behind it.
    node.offset = static_cast<float>(16 * error);
    node.inside = dot(geometric, ray.direction) > 0;
    if (node.inside) geometric = -geometric;
    if (dot(shading, geometric) < 0) shading = -shading;
    // An interpolated normal may turn from the viewer at silhouettes; bring it back to just visible.
    if (const double facing = -dot(shading, ray.direction); facing < 1e-4) {
        shading = normalize(shading - ray.direction * (1e-4 - facing));
    }
    node.normal = {static_cast<float>(shading.x), static_cast<float>(shading.y), static_cast<float>(shading.z)};
    node.geometric_normal = encode_direction(geometric);
    node.instance = hit.instance;
    node.primitive = hit.primitive;
    node.material = world_.material(hit.instance, surface.slot);
    if (world_.absorbs) node.weight *= transmittance(world_, tile_, static_cast<std::uint32_t>(tile_.nodes.size() - 1), hit.t);
}

Vec3 Growth::to_viewer(const Node& node) const {
    return node.parent == no_node ? world_.camera.to_viewer(node.position) : normalize(tile_.nodes[node.parent].position - node.position);
}

void Growth::light(std::span<const std::uint32_t> nodes, bool shadows, Coherence coherence) {
    const std::size_t lights = world_.lights.size();
    tile_.shares.resize(tile_.nodes.size() * lights, Share::untried);
    lit_.clear();
    for (const std::uint32_t i : nodes) {
        Node& node = tile_.nodes[i];
        if (node.left_scene()) continue;
        const Lobes& lobes = world_.lobes[node.material];
        const Vec3 normal = normal_of(node), viewer = to_viewer(node);
        lit_.push_back({i, &lobes, node.position, normal, decode_direction(node.geometric_normal), viewer, node.offset, {}, 0,
                        lobes.emission + reflect_environment(world_.environment, lobes, normal, viewer)});
        node.shadowed = node.shadowed || shadows;
    }
    for (std::size_t l = 0; l < lights; ++l) {
        const Light& light = world_.lights[l];
        for (Lit& lit : lit_) {
            lit.incident = light.at(lit.position);
            lit.cosine = is_black(lit.incident.strength) ? 0 : dot(lit.normal, lit.incident.to_light);
        }
        if (shadows && light.casts_shadows()) trace_shadows(l, coherence);
        for (Lit& lit : lit_) {
            if (!(lit.cosine > 0)) continue;
            const std::size_t key = std::size_t{lit.node} * lights + l;
            const Share share = tile_.shares[key];
            if (share == Share::blocked) continue;
            Rgb strength = lit.incident.strength;
            if (share == Share::filtered) strength *= tile_.filtered.at(key);
            lit.sum += strength * reflect_light(*lit.lobes, lit.normal, lit.viewer, lit.incident.to_light, lit.cosine, light.makes_highlights());
        }
    }
    for (const Lit& lit : lit_) tile_.nodes[lit.node].local = lit.sum;
}

void Growth::trace_shadows(std::size_t light, Coherence coherence) {
    const std::size_t lights = world_.lights.size();
    accel::TestCounts counts;
    if (settings_.shadow_cache) last_occluder_.resize(lights * 256);
    rays_.clear();
    shadow_nodes_.clear();
    for (const Lit& lit : lit_) {
        Share& share = tile_.shares[std::size_t{lit.node} * lights + light];
        if (!(lit.cosine > 0)) {
            share = Share::behind;
            continue;
        }
        Ray ray;
        ray.origin = start(lit.position, lit.geometric, lit.offset, lit.incident.to_light);
        ray.direction = lit.incident.to_light;
        ray.t_max = lit.incident.distance * (1 - 1e-12) - 2 * lit.offset;  // short of a surface that the lamp lies in
        ++tile_.rays.shadow;
        if (settings_.shadow_cache) {
            const Hit& last = last_occluder_[light * 256 + tile_.nodes[lit.node].depth];
            if (last.found()) {
                const accel::Instance& instance = world_.instances[last.instance];
                Hit hit;
                accel::nearest_in_part(instance, last.instance, accel::part_of(instance, last.primitive), accel::to_local(instance, ray), hit);
                ++counts.shape_tests;
                if (hit.found()) {
                    share = Share::blocked;
                    ++tile_.tests.shadow_cache_hits;
                    continue;
                }
            }
        }
        rays_.push_back(ray);
        shadow_nodes_.push_back(lit.node);
    }
    hits_.resize(rays_.size());
    crossings_.clear();
    world_.accelerator->shadow(rays_, hits_, crossings_, coherence, counts);
    tile_.tests.box_tests += counts.box_tests;
    tile_.tests.shape_tests += counts.shape_tests;

    std::sort(crossings_.begin(), crossings_.end(),
              [](const accel::Crossing& a, const accel::Crossing& b) { return a.ray != b.ray ? a.ray < b.ray : accel::before(a.hit, b.hit); });
    auto crossing = crossings_.begin();
    for (std::uint32_t i = 0; i < rays_.size(); ++i) {
        const auto first = crossing;
        while (crossing != crossings_.end() && crossing->ray == i) ++crossing;
        const std::size_t key = std::size_t{shadow_nodes_[i]} * lights + light;
        Share& share = tile_.shares[key];
        if (hits_[i].found()) {
            share = Share::blocked;
            if (settings_.shadow_cache) last_occluder_[light * 256 + tile_.nodes[shadow_nodes_[i]].depth] = hits_[i];
        } else if (first == crossing && !world_.absorbs) {
            share = Share::clear;
        } else {
            const Rgb filter = passage(world_, tile_, shadow_nodes_[i], {first, crossing}, rays_[i]);
            share = is_black(filter) ? Share::blocked : first == crossing && filter == Rgb{1, 1, 1} ? Share::clear : Share::filtered;
            if (share == Share::filtered) tile_.filtered[key] = filter;
        }
    }
}

void Growth::spawn(std::span<const std::uint32_t> nodes, std::vector<Pending>& pending) const {
    for (const std::uint32_t i : nodes) {
        const Node& node = tile_.nodes[i];
        if (node.left_scene() || node.depth >= settings_.depth) continue;
        const Lobes& lobes = world_.lobes[node.material];
        if (!lobes.mirrors() && !lobes.refracts()) continue;
        const double cosine = std::clamp(dot(normal_of(node), to_viewer(node)), 0.0, 1.0);
        const ChildWeights weights = child_weights(lobes, cosine, node.inside);
        const Rgb above = influence(tile_, i);
        if (!is_black(weights.reflected)) pending.push_back({i, weights.reflected, max_component(above * weights.reflected), false});
        if (!is_black(weights.refracted)) pending.push_back({i, weights.refracted, max_component(above * weights.refracted), true});
    }
}

void Growth::grow(std::span<const Pending> pending, std::vector<Pending>& next) {
    const auto first = static_cast<std::uint32_t>(tile_.nodes.size());
    std::vector<Ray> rays;
    std::vector<Seed> seeds;
    bool coherent = true;
    for (const Pending& p : pending) {
        const Node& node = tile_.nodes[p.parent];
        const Lobes& lobes = world_.lobes[node.material];
        const Vec3 normal = normal_of(node), geometric = decode_direction(node.geometric_normal), viewer = to_viewer(node);
        const double cosine = dot(normal, viewer);
        Ray ray;
        if (p.refracted) {
            const double eta = node.inside ? lobes.ior : 1 / lobes.ior;  // index in front over index behind
            const double sin2 = eta * eta * std::max(0.0, 1 - cosine * cosine);
            ray.direction = normalize(viewer * -eta + normal * (eta * cosine - std::sqrt(std::max(0.0, 1 - sin2))));
            ++tile_.rays.refracted;
        } else {
            ray.direction = normalize(normal * (2 * cosine) - viewer);
            // Interpolated normals can send a reflection into the surface: lift it to just above.
            if (const double above = dot(ray.direction, geometric); above < 1e-4) ray.direction = normalize(ray.direction + geometric * (1e-4 - above));
            ++tile_.rays.reflected;
        }
        ray.origin = start(node.position, geometric, node.offset, ray.direction);
        rays.push_back(ray);
        seeds.push_back({p.parent, p.weight, static_cast<std::uint8_t>(node.depth + 1), p.refracted});
        coherent = coherent && node.depth == 0;
    }
    hits_.resize(rays.size());
    accel::TestCounts counts;
    const Coherence coherence = coherent ? Coherence::coherent : Coherence::incoherent;
    world_.accelerator->nearest(rays, hits_, coherence, counts);
    tile_.tests.box_tests += counts.box_tests;
    tile_.tests.shape_tests += counts.shape_tests;
    fresh_.resize(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        append(rays[i], hits_[i], seeds[i], 0);
        fresh_[i] = first + static_cast<std::uint32_t>(i);
        Node& parent = tile_.nodes[pending[i].parent];
        (pending[i].refracted ? parent.refracted : parent.reflected) = fresh_[i];
    }
    light(fresh_, settings_.level >= scene::Level::shadows, coherence);
    spawn(fresh_, next);
}

bool Growth::grow_above(std::vector<Pending>& pending, double threshold, const Deadline& deadline) {
    // Takes what exceeds the threshold in the order in which it was spawned, a chunk at a time; its children queue behind.
    std::vector<Pending> chunk;
    std::size_t kept = 0, next = 0;  // pending[0 .. kept) stays, [next .. end) is still to be looked at
    bool in_time = true;
    while (in_time) {
        chunk.clear();
        for (; next < pending.size() && chunk.size() < chunk_size; ++next) {
            if (pending[next].influence > threshold) {
                chunk.push_back(pending[next]);
            } else {
                pending[kept++] = pending[next];
            }
        }
        if (chunk.empty()) break;
        grow(chunk, pending);
        in_time = !deadline.passed();
    }
    pending.erase(pending.begin() + static_cast<std::ptrdiff_t>(kept), pending.begin() + static_cast<std::ptrdiff_t>(next));
    return in_time;
}

}  // namespace crescente::render
