#include "render/catcher.h"

#include "render/environment.h"
#include "render/light_seen.h"

namespace crescente::render {
namespace {

// Sums of a node's samples over the groups, each by its scale: visit(estimate, scale over the number of samples).
template <class Visit>
void for_each_estimate(const World& world, const Tile& tile, std::uint32_t node, Visit&& visit) {
    const std::size_t groups = estimate_groups(world);
    const float share = 1.0f / static_cast<float>(tile.samples[node]);
    for (std::size_t g = 0; g < groups; ++g) visit(tile.estimates[node * groups + g], scale_of_group(world, g) * share);
}

// What of a light without samples reaches a node, and what would if nothing were in its way.
CaughtLight caught_of(const World& world, const Tile& tile, std::uint32_t i, std::size_t l) {
    const Node& node = tile.nodes[i];
    const Light& light = world.lights[l];
    if (!light.acts_on(node.instance)) return {};
    const Incident incident = light.at(node.position);
    const double cosine = dot(Vec3{node.normal[0], node.normal[1], node.normal[2]}, incident.to_light);
    if (!(cosine > 0) || is_black(incident.strength)) return {};
    const std::size_t key = std::size_t{i} * world.lights.size() + l;
    const Rgb filter = tile.shares[key] == Share::filtered ? tile.filtered.at(key) : gray(may_arrive(tile.shares[key]) ? 1.0f : 0.0f);
    return {luminance(incident.strength * filter) * static_cast<float>(cosine), luminance(incident.strength) * static_cast<float>(cosine)};
}

}  // namespace

bool catches(const World& world, const Tile& tile, std::uint32_t node) {
    const Node& at = tile.nodes[node];
    if (at.left_scene() || !world.lobes[at.material].catcher) return false;
    while (goes_straight(world, tile, node)) node = tile.nodes[node].parent;
    return tile.nodes[node].parent == no_node;
}

CaughtLight caught_evenly(const World& world, Vec3 normal) {
    const double factor = pi * world.environment.strength() * world.environment.even_share();
    const float light = factor > 0 ? luminance(world.environment.irradiance(normal)) * static_cast<float>(factor) : 0.0f;
    return {light, light};
}

CaughtLight caught_by_lamps(const World& world, const Tile& tile, std::uint32_t node) {
    CaughtLight sum;
    for (std::size_t l = 0; l < world.lights.size(); ++l) {
        if (world.lights[l].is_sampled() && tile.nodes[node].sampled) continue;
        const CaughtLight one = caught_of(world, tile, node, l);
        sum.open += one.open, sum.all += one.all;
    }
    return sum;
}

CaughtLight caught_by_samples(const World& world, const Tile& tile, std::uint32_t node) {
    CaughtLight sum;
    for_each_estimate(world, tile, node, [&](const Estimate& e, Rgb scale) { sum.open += e.diffuse.g * luminance(scale), sum.all += e.diffuse.b * luminance(scale); });
    return sum;
}

Rgb mirrored_by_samples(const World& world, const Tile& tile, std::uint32_t node) {
    Rgb sum;
    for_each_estimate(world, tile, node, [&](const Estimate& e, Rgb scale) { sum += e.glossy * scale; });
    return sum;
}

Rgb seen_behind(const World& world, Vec3 point) {
    const Environment& around = world.environment;
    if (around.source().transparent) return {};
    if (!around.backdrop()) return environment_radiance(around, normalize(point - world.camera.viewer_of(point)));
    const auto place = world.camera.project(point);
    return backdrop_radiance(around, place ? 1 - place->y / world.camera.height() : 0.5);
}

void Growth::begin_catcher(PointLanes& p, int i) const {
    const std::uint32_t node = p.node[i];
    const bool sampled = tile_.nodes[node].sampled;
    const CaughtLight caught = sampled ? caught_by_samples(world_, tile_, node) : caught_evenly(world_, lane(p.normal, i));
    p.catching |= 1u << i;
    p.open[i] = caught.open, p.all[i] = caught.all;
    const Rgb sum = p.lobes[i]->emission + (sampled ? mirrored_by_samples(world_, tile_, node) : Rgb{}) + lights_before(world_, tile_, node);
    p.sum[0][i] = sum.r, p.sum[1][i] = sum.g, p.sum[2][i] = sum.b;
}

// What of a light reaches catchers, and what would if nothing were in its way; add_light then leaves them out.
void Growth::catch_light(PointLanes& p, std::size_t l) const {
    const Light& light = world_.lights[l];
    for (unsigned rest = p.catching; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        if (light.is_sampled() && p.sampled >> i & 1) continue;
        const CaughtLight caught = caught_of(world_, tile_, p.node[i], l);
        p.open[i] += caught.open, p.all[i] += caught.all;
    }
    p.lit &= ~p.catching;
}

void Growth::end_catcher(const PointLanes& p, int i) {
    Node& node = tile_.nodes[p.node[i]];
    const float clear = CaughtLight{p.open[i], p.all[i]}.clear() * p.lobes[i]->opacity;
    node.local += seen_behind(world_, node.position) * clear;
    if (!world_.environment.source().transparent) return;
    node.clear = static_cast<std::uint16_t>(clear * all_clear + 0.5f) & all_clear;
    tile_.keeps_clear = true;
}

}  // namespace crescente::render
