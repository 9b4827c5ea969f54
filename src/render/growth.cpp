#include "render/growth.h"

#include <algorithm>
#include <cstring>

#include "math/octahedral.h"
#include "render/bsdf.h"
#include "render/catcher.h"
#include "render/environment.h"
#include "render/hit_surface.h"
#include "render/light_seen.h"
#include "render/medium.h"
#include "render/surface_lobes.h"

namespace crescente::render {
namespace {

using accel::Coherence;
using accel::Hit;
using geometry::Ray;

// Starts on the side of `direction` of a surface, clear of it.
Vec3Lanes starts(const Vec3Lanes& position, const Vec3Lanes& geometric_normal, const Lanes& offset, const Vec3Lanes& direction) {
    return position + geometric_normal * (dot(geometric_normal, direction) >= 0.0 ? offset : -offset);
}

// Eight rays that begin at their origins.
void make_rays(const Vec3Lanes& origin, const Vec3Lanes& direction, const Lanes& t_max, Ray* rays) {
    Lanes rows[lane_count] = {origin.x, origin.y, origin.z, direction.x, direction.y, direction.z, Lanes{}, t_max};
    transpose(rows);
    std::memcpy(static_cast<void*>(rays), rows, sizeof rows);
}

// Eight rays from points to the light that they reach so.
void make_shadow_rays(const Vec3Lanes& position, const Vec3Lanes& geometric_normal, const Lanes& offset, const Reach<Lanes>& reach, Ray* rays) {
    // Short of a surface that the lamp lies in.
    make_rays(starts(position, geometric_normal, offset, reach.to_light), reach.to_light, reach.distance * (1 - 1e-12) - 2.0 * offset, rays);
}

Vec3Lanes geometric_normals(const OctahedralPoint<Lanes>& code) { return from_octahedral(OctahedralPoint<Lanes>{code.a / octahedral_scale, code.b / octahedral_scale}); }

}  // namespace

std::uint32_t Growth::add_roots(std::span<const LatticePoint> points, std::span<const std::array<std::uint32_t, 4>> tried_first) {
    const auto first = static_cast<std::uint32_t>(tile_.nodes.size());
    rays_.clear();
    for (const LatticePoint& p : points) rays_.push_back(camera_ray(world_, p));
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
    seeds_.assign(points.size(), {});
    append();
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (!hits_[i].found()) light_sky(world_, tile_, first + static_cast<std::uint32_t>(i), points[i]);
    }
    return first;
}

// Nodes for rays_ and their hits_, with what they inherit from seeds_. Those that left the scene, but for roots, are left to be lit: sky_nodes_.
void Growth::append() {
    const std::size_t first = tile_.nodes.size();
    sky_nodes_.clear();
    tile_.nodes.resize(first + rays_.size());
    for (std::size_t block = 0; block < rays_.size(); block += lane_count) {
        const int count = static_cast<int>(std::min<std::size_t>(lane_count, rays_.size() - block));
        unsigned found = 0;
        for (int i = 0; i < count; ++i) found |= hits_[block + i].found() ? 1u << i : 0u;
        const SurfaceLanes at = surfaces_at(world_, &rays_[block], &hits_[block], found);
        const OctahedralPoint<Lanes> code = to_octahedral(at.geometric);
        for (int i = 0; i < count; ++i) {
            Node& node = tile_.nodes[first + block + i];
            const Hit& hit = hits_[block + i];
            const Seed& seed = seeds_[block + i];
            node.parent = seed.parent;
            node.weight = seed.weight;
            node.depth = seed.depth;
            node.crossed = seed.crossed;
            if (!(found >> i & 1)) {
                node.position = rays_[block + i].direction;
                node.shadowed = true;
                if (node.parent != no_node) sky_nodes_.push_back(static_cast<std::uint32_t>(first + block + i));
                continue;
            }
            node.position = lane(at.position, i);
            node.normal = {static_cast<float>(at.shading.x[i]), static_cast<float>(at.shading.y[i]), static_cast<float>(at.shading.z[i])};
            node.geometric_normal = pack_octahedral(code.a[i], code.b[i]);
            node.offset = static_cast<float>(at.offset[i]);
            node.inside = at.inside >> i & 1;
            node.instance = hit.instance;
            node.primitive = hit.primitive;
            node.material = at.material[i];
            tile_.materials |= std::uint64_t{1} << node.material % 64;
            if (world_.bends_normals) bend_normal(world_, tile_, static_cast<std::uint32_t>(first + block + i));
            if (world_.absorbs) node.weight *= transmittance(world_, tile_, static_cast<std::uint32_t>(first + block + i), hit.t);
        }
    }
}

// Collects what is needed to light the nodes, and to grow rays from them: points_.
void Growth::gather(std::span<const std::uint32_t> nodes) {
    points_.clear();
    int filled = lane_count;
    for (const std::uint32_t i : nodes) {
        const Node& node = tile_.nodes[i];
        if (node.left_scene()) continue;
        if (filled == lane_count) {
            points_.emplace_back();
            filled = 0;
        }
        PointLanes& p = points_.back();
        p.node[filled] = i;
        set_lane(p.position, filled, node.position);
        p.normal.x[filled] = node.normal[0], p.normal.y[filled] = node.normal[1], p.normal.z[filled] = node.normal[2];
        p.code.a[filled] = octahedral_a(node.geometric_normal), p.code.b[filled] = octahedral_b(node.geometric_normal);
        p.offset[filled] = node.offset;
        // Where the viewer is seen from; in an orthographic picture all see it in one direction.
        const Vec3 viewer = node.parent != no_node ? tile_.nodes[node.parent].position : world_.camera.viewer_of(node.position);
        set_lane(p.viewer, filled, viewer);
        p.count = ++filled;
    }
    for (PointLanes& p : points_) {
        p.viewer = normalize(p.viewer - p.position);
        p.geometric = geometric_normals(p.code);
    }
}

// What the points are made of.
void Growth::find_lobes() {
    if (!world_.textured.empty()) textured_.resize(points_.size() * lane_count);
    for (std::size_t k = 0; k < points_.size(); ++k) {
        PointLanes& p = points_[k];
        for (int i = 0; i < p.count; ++i) {
            const std::uint32_t material = tile_.nodes[p.node[i]].material;
            p.lobes[i] = world_.textured_material(material) ? &lobes_of(world_, tile_, p.node[i], textured_[k * lane_count + i]) : &world_.lobes[material];
        }
    }
}

void Growth::light(std::span<const std::uint32_t> nodes, bool shadows, Coherence coherence) {
    gather(nodes);
    find_lobes();
    light_points(shadows, coherence);
}

void Growth::light_points(bool shadows, Coherence coherence) {
    const std::size_t lights = world_.lights.size();
    tile_.shares.resize(tile_.nodes.size() * lights, Share::untried);
    for (PointLanes& p : points_) begin_light(p, shadows);
    if (shadows && std::any_of(points_.begin(), points_.end(), [&](const PointLanes& p) { return any_untried(p); })) {
        for (std::size_t l = 0; l < lights; ++l) {
            if (is_black(world_.lights[l].color())) continue;
            for (PointLanes& p : points_) aim(p, l);
            if (world_.lights[l].casts_shadows()) trace_shadows(l, coherence);
            for (PointLanes& p : points_) catch_light(p, l), add_light(p, l);
        }
    } else {  // nothing to trace: all lights of the same points, while these are in the cache
        for (PointLanes& p : points_) {
            for (std::size_t l = 0; l < lights; ++l) {
                if (is_black(world_.lights[l].color())) continue;
                aim(p, l);
                if (shadows && world_.lights[l].casts_shadows()) leave_out_of_reach(p, l);
                catch_light(p, l), add_light(p, l);
            }
        }
    }
    for (const PointLanes& p : points_) {
        for (int i = 0; i < p.count; ++i) {
            Node& node = tile_.nodes[p.node[i]];
            node.local = {p.sum[0][i], p.sum[1][i], p.sum[2][i]};
            node.clear = 0;
            if (p.catching >> i & 1) end_catcher(p, i);
        }
    }
}

// Light without that of lamps.
void Growth::begin_light(PointLanes& p, bool shadows) {
    p.physical = p.layered = p.sampled = p.catching = 0;
    for (int i = 0; i < p.count; ++i) {
        Node& node = tile_.nodes[p.node[i]];
        const Lobes& lobes = *p.lobes[i];
        if (node.sampled) p.sampled |= 1u << i;
        node.shadowed = node.shadowed || shadows;
        if (lobes.catcher && catches(world_, tile_, p.node[i])) {
            begin_catcher(p, i);
            continue;
        }
        if (lobes.layered() && !lobes.composed()) {
            p.physical |= 1u << i;
            const PhysicalView<double> view = physical_view(lobes, dot(lane(p.normal, i), lane(p.viewer, i)));
            set_lane(p.view, i, view);
            if (asks_for_layer(lobes)) p.layered |= 1u << i;
        }
        const Rgb around = node.sampled ? sampled_radiance(world_, tile_, p.node[i]) : reflect_environment(world_.environment, lobes, lane(p.normal, i), lane(p.viewer, i), node.inside);
        const Rgb sum = lobes.emission + around + lights_before(world_, tile_, p.node[i]);
        p.sum[0][i] = sum.r, p.sum[1][i] = sum.g, p.sum[2][i] = sum.b;
    }
}

bool Growth::any_untried(const PointLanes& p) const {
    const std::size_t lights = world_.lights.size();
    return std::any_of(p.node, p.node + p.count, [&](std::uint32_t node) {
        const Share* first = tile_.shares.data() + node * lights;
        return std::find(first, first + lights, Share::untried) != first + lights;
    });
}

// Where the light stands, and which of the points it reaches if nothing is in its way that is not known yet.
void Growth::aim(PointLanes& p, std::size_t light) const {
    const std::size_t lights = world_.lights.size();
    p.lit = 0;
    const unsigned asked = world_.lights[light].is_sampled() ? ~p.sampled : ~0u;
    for (int i = 0; i < p.count; ++i) p.lit |= asked >> i & may_arrive(tile_.shares[std::size_t{p.node[i]} * lights + light]) ? 1u << i : 0u;
    if (world_.lights[light].receivers()) {
        for (int i = 0; i < p.count; ++i) p.lit &= ~(world_.lights[light].acts_on(tile_.nodes[p.node[i]].instance) ? 0u : 1u << i);
    }
    if (!p.lit) return;
    p.reach = world_.lights[light].reach(p.position);
    p.cosine = dot(p.normal, p.reach.to_light);
    p.lit &= bits_of((p.cosine > 0.0) & (p.reach.factor > 0.0));
}

void Growth::leave_out_of_reach(const PointLanes& p, std::size_t light) {
    const std::size_t lights = world_.lights.size();
    const bool is_sampled = world_.lights[light].is_sampled();
    for (int i = 0; i < p.count; ++i) {
        if (is_sampled && p.sampled >> i & 1) continue;  // not asked
        Share& share = tile_.shares[std::size_t{p.node[i]} * lights + light];
        if (!(p.lit >> i & 1) && may_arrive(share)) share = Share::behind;
    }
}

void Growth::add_light(PointLanes& p, std::size_t l) const {
    const std::size_t lights = world_.lights.size();
    const Light& light = world_.lights[l];
    unsigned filtered = 0;
    for (unsigned rest = p.lit; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        const Share share = tile_.shares[std::size_t{p.node[i]} * lights + l];
        if (!may_arrive(share)) p.lit &= ~(1u << i);
        else if (share == Share::filtered) filtered |= 1u << i;
    }
    if (!p.lit) return;
    Lanes radiance[3]{};
    if (const unsigned physical = p.lit & p.physical) {
        const LayerAt<Lanes> layer = layer_at(p.lobes, physical & p.layered, p.cosine);
        reflect_physical(p.view, p.cosine, dot(p.viewer, p.reach.to_light), layer, light.makes_highlights(), radiance);
    }
    for (unsigned rest = p.lit & ~p.physical; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        const Rgb one = reflect_light(*p.lobes[i], lane(p.normal, i), lane(p.viewer, i), lane(p.reach.to_light, i), p.cosine[i], light.makes_highlights());
        radiance[0][i] = one.r, radiance[1][i] = one.g, radiance[2][i] = one.b;
    }
    const FloatLanes factor = to_floats(p.reach.factor);
    for (int k = 0; k < 3; ++k) {
        FloatLanes strength = light.color()[k] * factor;
        for (unsigned rest = filtered; rest; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            strength[i] *= tile_.filtered.at(std::size_t{p.node[i]} * lights + l)[k];
        }
        p.sum[k] = blend(p.lit, p.sum[k] + strength * to_floats(radiance[k]), p.sum[k]);
    }
}

// The shadow cache: whether what stood in the way of the last ray of this light and depth stands in the way of this one.
bool Growth::occluded_as_last(std::size_t light, std::uint8_t depth, const Ray& ray) {
    const Hit& last = last_occluder_[light * 256 + depth];
    if (!last.found()) return false;
    const accel::Instance& instance = world_.instances[last.instance];
    Hit hit;
    accel::nearest_in_part(instance, last.instance, accel::part_of(instance, last.primitive), accel::to_local(instance, ray), hit, accel::Sense::light);
    ++tile_.tests.shape_tests;
    tile_.tests.shadow_cache_hits += hit.found();
    return hit.found();
}

std::span<const Ray> Growth::shadow_rays(std::span<const std::uint32_t> nodes, std::size_t light) {
    rays_.resize((nodes.size() + lane_count - 1) / lane_count * lane_count);
    for (std::size_t block = 0; block < nodes.size(); block += lane_count) {
        Vec3Lanes position{};
        Lanes a{}, b{}, offset{};  // a, b: of the geometric normal
        for (std::size_t i = 0; i < lane_count; ++i) {
            const Node& node = tile_.nodes[nodes[std::min(block + i, nodes.size() - 1)]];
            set_lane(position, static_cast<int>(i), node.position);
            a[i] = octahedral_a(node.geometric_normal), b[i] = octahedral_b(node.geometric_normal);
            offset[i] = node.offset;
        }
        make_shadow_rays(position, geometric_normals({a, b}), offset, world_.lights[light].reach(position), &rays_[block]);
    }
    rays_.resize(nodes.size());
    return rays_;
}

void Growth::trace_shadows(std::size_t light, Coherence coherence) {
    const std::size_t lights = world_.lights.size();
    accel::TestCounts counts;
    if (settings_.shadow_cache) last_occluder_.resize(lights * 256);
    rays_.clear();
    shadow_nodes_.clear();
    for (PointLanes& p : points_) {
        leave_out_of_reach(p, light);
        unsigned untried = 0;
        for (int i = 0; i < p.count; ++i) {
            if (p.lit >> i & 1 && tile_.shares[std::size_t{p.node[i]} * lights + light] == Share::untried) untried |= 1u << i;
        }
        if (!untried) continue;
        alignas(64) Ray rays[lane_count];
        make_shadow_rays(p.position, p.geometric, p.offset, p.reach, rays);
        tile_.rays.shadow += static_cast<unsigned>(__builtin_popcount(untried));
        for (unsigned rest = untried; rest; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            if (settings_.shadow_cache && occluded_as_last(light, tile_.nodes[p.node[i]].depth, rays[i])) {
                tile_.shares[std::size_t{p.node[i]} * lights + light] = Share::blocked;
                continue;
            }
            rays_.push_back(rays[i]);
            shadow_nodes_.push_back(p.node[i]);
        }
    }
    hits_.resize(rays_.size());
    crossings_.clear();
    world_.accelerator->shadow(rays_, hits_, crossings_, coherence, counts);
    tile_.tests.box_tests += counts.box_tests;
    tile_.tests.shape_tests += counts.shape_tests;

    accel::sort_by_ray(crossings_);
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

void Growth::spawn(std::span<const std::uint32_t> nodes, std::vector<Pending>& pending) {
    gather(nodes);
    find_lobes();
    spawn_from_points(pending);
}

void Growth::spawn_from_points(std::vector<Pending>& pending) {
    for (const PointLanes& p : points_) {
        const Lanes cosines = lesser(greater(dot(p.normal, p.viewer), Lanes{}), Lanes{} + 1.0);
        for (int i = 0; i < p.count; ++i) {
            Node& node = tile_.nodes[p.node[i]];
            node.spawned = true;
            const Lobes& lobes = *p.lobes[i];
            if (node.depth >= settings_.depth || !lobes.goes_on()) continue;
            const double over = coat_cosine(lobes, lane(p.viewer, i), cosines[i]);
            ChildWeights weights = child_weights(lobes, cosines[i], over, node.inside);
            if (settings_.level > scene::Level::edges) {  // rough lobes will be sampled: the rays of smooth ones carry these alone
                const Smooth smooth = smooth_lobes(lobes);
                const ChildWeights alone = smooth_weights(lobes, cosines[i], over, node.inside);
                if (smooth.reflects) weights.reflected = alone.reflected;
                if (smooth.refracts) weights.refracted = alone.refracted;
            }
            const Rgb above = influence(tile_, p.node[i]);
            if (!is_black(weights.reflected)) pending.push_back({p.node[i], weights.reflected, max_component(above * weights.reflected), Way::reflected});
            if (!is_black(weights.refracted)) pending.push_back({p.node[i], weights.refracted, max_component(above * weights.refracted), Way::refracted});
            if (!is_black(lobes.straight)) pending.push_back({p.node[i], lobes.straight, max_component(above * lobes.straight), Way::straight});
        }
    }
}

std::span<const Ray> Growth::child_rays(std::span<const Pending> pending) {
    parents_.clear();
    for (const Pending& p : pending) parents_.push_back(p.parent);
    gather(parents_);
    rays_.resize((pending.size() + lane_count - 1) / lane_count * lane_count);
    for (std::size_t block = 0; block < points_.size(); ++block) {
        const PointLanes& p = points_[block];
        const Lanes cosine = dot(p.normal, p.viewer);
        Vec3Lanes mirrors = p.normal;
        Lanes eta = Lanes{} + 1.0;  // index in front over index behind
        unsigned refracted = 0, straight = 0;
        for (int i = 0; i < p.count; ++i) {
            const Pending& from = pending[block * lane_count + i];
            const Node& node = tile_.nodes[from.parent];
            if (from.way == Way::refracted) {
                Lobes scratch;
                const double ior = lobes_of(world_, tile_, from.parent, scratch).ior;
                refracted |= 1u << i;
                eta[i] = node.inside ? ior : 1 / ior;
            }
            if (from.way == Way::straight) straight |= 1u << i;
            if (from.way == Way::reflected && has_own_coat(world_, node.material)) {
                Lobes scratch;
                set_lane(mirrors, i, mirror_normal(lobes_of(world_, tile_, from.parent, scratch), lane(p.normal, i)));
            }
        }
        Vec3Lanes direction = normalize(mirrors * (2.0 * dot(mirrors, p.viewer)) - p.viewer);
        // Interpolated normals can send a reflection into the surface: lift it to just above.
        const Lanes above = dot(direction, p.geometric);
        if (bits_of(above < 1e-4)) direction = select(above < 1e-4, normalize(direction + p.geometric * (1e-4 - above)), direction);
        if (refracted) {
            const Lanes zero{}, sin2 = eta * eta * greater(1.0 - cosine * cosine, zero);
            const Vec3Lanes through = normalize(p.normal * (eta * cosine - square_root(greater(1.0 - sin2, zero))) - p.viewer * eta);
            direction = blend(refracted, through, direction);
        }
        if (straight) direction = blend(straight, -p.viewer, direction);
        make_rays(starts(p.position, p.geometric, p.offset, direction), direction, Lanes{} + std::numeric_limits<double>::infinity(),
                  &rays_[block * lane_count]);
    }
    rays_.resize(pending.size());
    return rays_;
}

void Growth::grow(std::span<const Pending> pending, std::vector<Pending>& next) {
    const auto first = static_cast<std::uint32_t>(tile_.nodes.size());
    child_rays(pending);
    seeds_.clear();
    bool coherent = true;
    for (const Pending& from : pending) {
        const std::uint8_t depth = tile_.nodes[from.parent].depth;
        seeds_.push_back({from.parent, from.weight, static_cast<std::uint8_t>(depth + 1), from.way != Way::reflected});
        coherent = coherent && depth == 0;
        ++(from.way == Way::reflected ? tile_.rays.reflected : tile_.rays.refracted);
    }
    hits_.resize(rays_.size());
    accel::TestCounts counts;
    const Coherence coherence = coherent ? Coherence::coherent : Coherence::incoherent;
    world_.accelerator->nearest(rays_, hits_, coherence, counts);
    tile_.tests.box_tests += counts.box_tests;
    tile_.tests.shape_tests += counts.shape_tests;
    append();
    fresh_.resize(rays_.size());
    for (std::size_t i = 0; i < rays_.size(); ++i) {
        fresh_[i] = first + static_cast<std::uint32_t>(i);
        Node& parent = tile_.nodes[pending[i].parent];
        switch (pending[i].way) {
            case Way::reflected: parent.reflected = fresh_[i]; break;
            case Way::refracted: parent.refracted = fresh_[i]; break;
            case Way::straight: tile_.straight.emplace(pending[i].parent, fresh_[i]); break;
        }
    }
    for (const std::uint32_t i : sky_nodes_) light_sky(world_, tile_, i, {});
    gather(fresh_);
    find_lobes();
    light_points(settings_.level >= scene::Level::shadows, coherence);
    spawn_from_points(next);
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
