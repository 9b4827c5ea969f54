// Growing the trees of a tile (render/growth.h): the light of nodes, and the ways of lamps to them.
#include <algorithm>

#include "render/bsdf.h"
#include "render/catcher.h"
#include "render/environment.h"
#include "render/growth.h"
#include "render/light_seen.h"
#include "render/medium.h"
#include "render/ray_lanes.h"

namespace crescente::render {
namespace {

using accel::Coherence;
using accel::Hit;
using geometry::Ray;

// Eight rays from points to the light that they reach so.
void make_shadow_rays(const Vec3Lanes& position, const Vec3Lanes& geometric_normal, const Lanes& offset, const Reach<Lanes>& reach, Ray* rays) {
    // Short of a surface that the lamp lies in.
    make_rays(starts(position, geometric_normal, offset, reach.to_light), reach.to_light, Lanes{}, reach.distance * (1 - 1e-12) - 2.0 * offset, rays);
}

}  // namespace

void Growth::light(std::span<const std::uint32_t> nodes, bool shadows, Coherence coherence, std::span<const Lobes* const> lobes) {
    gather(nodes);
    find_lobes(lobes);
    light_points(shadows, coherence);
}

void Growth::light_points(bool shadows, Coherence coherence) {
    const std::size_t lights = world_.lights.size();
    if (tile_.all_lit > 0 && tile_.nodes.size() * lights > tile_.shares.capacity()) tile_.shares.reserve(tile_.nodes.capacity() * lights);
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
    p.physical = p.classic = p.blinn = p.layered = p.sampled = p.catching = 0;
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
        } else if (!lobes.composed()) {
            p.classic |= 1u << i;
            if (lobes.highlight_lobe == HighlightLobe::blinn) p.blinn |= 1u << i;
            set_lane(p.classic_view, i, classic_view(lobes));
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
    if (p.lit & p.classic) {
        const Lanes n_v = dot(p.normal, p.viewer), v_l = dot(p.viewer, p.reach.to_light);
        const Lanes phong = phong_cosine(p.cosine, n_v, v_l);
        Lanes classic[3];
        reflect_classic(p.classic_view, p.cosine, p.blinn ? blend(p.blinn, blinn_cosine(p.cosine, n_v, v_l), phong) : phong, light.makes_highlights(), classic);
        for (int k = 0; k < 3; ++k) radiance[k] = blend(p.classic, classic[k], radiance[k]);
    }
    for (unsigned rest = p.lit & ~p.physical & ~p.classic; rest; rest &= rest - 1) {
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
    rays_.resize(blocks_of(nodes.size()) * lane_count);
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

}  // namespace crescente::render
