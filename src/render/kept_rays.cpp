#include "render/kept_rays.h"

#include <algorithm>

#include "render/growth.h"

namespace crescente::render {
namespace {

// Lanes of nodes that are looked at together; neighbours in the list are mostly neighbours in the picture.
constexpr std::size_t block_size = 8;

// How far from a node, in its offsets, its ray may have ended: several times what rounding can do.
constexpr double end_slack = 4;

// Rays through any point of the tile.
Bundle camera_bundle(const World& world, const Tile& tile) {
    Bounds origins, directions;
    for (const int x : {tile.x0, tile.x0 + tile.width}) {
        for (const int y : {tile.y0, tile.y0 + tile.height}) {
            const geometry::Ray ray = camera_ray(world, corner_point(x, y));
            origins.include(ray.origin), directions.include(ray.direction);
        }
    }
    return toward(origins, directions);
}

Way way_to(const Tile& tile, std::uint32_t child) {
    const Node& parent = tile.nodes[tile.nodes[child].parent];
    return parent.reflected == child ? Way::reflected : parent.refracted == child ? Way::refracted : Way::straight;
}

}  // namespace

std::vector<std::uint32_t> KeptRays::that_meet(const InstanceGroup& group, const World& world) {
    const bool roots_may = group.may_meet(camera_bundle(world, tile_));
    std::vector<std::uint32_t> near;
    for (std::uint32_t first = 0; first < tile_.nodes.size(); first += lane_count) {
        StretchLanes ran{{}, {Lanes{} + 1.0, Lanes{}, Lanes{}}, {}, 0};
        unsigned asked = 0;
        for (std::uint32_t i = first; i < std::min<std::size_t>(first + lane_count, tile_.nodes.size()); ++i) {
            const Node& node = tile_.nodes[i];
            if (lost_[i] || (node.parent == no_node && !roots_may)) continue;
            const int k = static_cast<int>(i - first);
            const Node* parent = node.parent == no_node ? nullptr : &tile_.nodes[node.parent];
            const Vec3 start = parent ? parent->position : camera_ray(world, point_of(places_[i])).origin;
            set_lane(ran.start, k, start);
            set_lane(ran.way, k, node.left_scene() ? node.position : node.position - start);
            ran.slack[k] = (parent ? parent->offset : 0.0) + (node.left_scene() ? 0.0 : end_slack * node.offset);
            ran.endless |= node.left_scene() ? 1u << k : 0u;
            asked |= 1u << k;
        }
        if (!asked) continue;
        for (unsigned may = asked & group.may_meet(ran); may; may &= may - 1) near.push_back(first + static_cast<std::uint32_t>(__builtin_ctz(may)));
    }

    Growth growth(world, tile_, false);
    std::vector<std::uint32_t> found;
    std::vector<geometry::Ray> rays;
    std::vector<Pending> children;
    std::vector<Meeting> meetings;
    accel::TestCounts tests;
    for (std::size_t first = 0; first < near.size(); first += chunk_size) {
        const auto chunk = std::span(near).subspan(first, std::min(chunk_size, near.size() - first));
        children.clear();
        for (const std::uint32_t i : chunk) {
            if (tile_.nodes[i].parent != no_node) children.push_back({tile_.nodes[i].parent, {}, 0, way_to(tile_, i)});
        }
        auto child_ray = growth.child_rays(children).begin();
        rays.clear();
        for (const std::uint32_t i : chunk) {
            const Node& node = tile_.nodes[i];
            geometry::Ray& ray = rays.emplace_back(node.parent == no_node ? camera_ray(world, point_of(places_[i])) : *child_ray++);
            // The hit's distance is not kept, but its place, up to rounding.
            if (!node.left_scene()) ray.t_max = dot(node.position - ray.origin, ray.direction) * (1 + 1e-9) + end_slack * node.offset;
        }
        group.meet(rays, meetings, tests);
        for (std::size_t k = 0; k < chunk.size(); ++k) {
            if (meetings[k] != Meeting::nothing) found.push_back(chunk[k]);
        }
    }
    count(near.size(), tests);
    return found;
}

void KeptRays::find_lit() {
    lit_known_ = true;
    lit_.reserve(tile_.nodes.size() / lane_count + 1);
    for (std::uint32_t first = 0; first < tile_.nodes.size(); first += lane_count) {
        LitLanes lanes{first, 0, {}, {}};
        for (std::uint32_t i = first; i < std::min<std::size_t>(first + lane_count, tile_.nodes.size()); ++i) {
            const Node& node = tile_.nodes[i];
            if (lost_[i] || node.left_scene()) continue;
            lanes.lit |= 1u << (i - first);
            set_lane(lanes.position, static_cast<int>(i - first), node.position);
            lanes.offset[i - first] = node.offset;
        }
        if (lanes.lit) lit_.push_back(lanes);
    }
    for (std::size_t first = 0; first < lit_.size(); first += block_size) {
        LitBlock block{first, std::min(first + block_size, lit_.size()), {}};
        for (std::size_t k = block.first; k < block.end; ++k) {
            for (unsigned rest = lit_[k].lit; rest; rest &= rest - 1) {
                const int i = __builtin_ctz(rest);
                const Vec3 position = lane(lit_[k].position, i), beside = Vec3{1, 1, 1} * lit_[k].offset[i];
                block.starts.include({position - beside, position + beside});
            }
        }
        lit_starts_.include(block.starts);
        blocks_.push_back(block);
    }
}

std::vector<KeptRays::MetWay> KeptRays::ways_that_meet(const InstanceGroup& group, const World& world, std::size_t light, Share settled) {
    if (!lit_known_) find_lit();
    std::vector<MetWay> found;
    const scene::Light& source = world.lights[light].source();
    const bool directional = source.kind == scene::LightKind::directional;
    const auto may_meet = [&](const Bounds& starts) {
        if (directional) return group.may_meet(toward(starts, {-source.direction, -source.direction}));
        return group.may_meet(between(starts, {source.position, source.position}));
    };
    if (lit_.empty() || !may_meet(lit_starts_)) return found;
    std::vector<std::uint32_t> near;
    for (const LitBlock& block : blocks_) {
        if (!may_meet(block.starts)) continue;
        for (std::size_t k = block.first; k < block.end; ++k) {
            const LitLanes& lanes = lit_[k];
            const Vec3Lanes way = directional ? broadcast(-source.direction) : broadcast(source.position) - lanes.position;
            for (unsigned may = lanes.lit & group.may_meet({lanes.position, way, lanes.offset, directional ? ~0u : 0u}); may; may &= may - 1) {
                const std::uint32_t i = lanes.first + static_cast<std::uint32_t>(__builtin_ctz(may));
                const Share share = tile_.shares[i * world.lights.size() + light];
                if (share != Share::untried && share != Share::behind && share != settled) near.push_back(i);
            }
        }
    }
    Growth growth(world, tile_, false);
    std::vector<Meeting> meetings;
    accel::TestCounts tests;
    for (std::size_t first = 0; first < near.size(); first += chunk_size) {
        const auto chunk = std::span(near).subspan(first, std::min(chunk_size, near.size() - first));
        group.meet_light(growth.shadow_rays(chunk, light), meetings, tests);
        for (std::size_t k = 0; k < chunk.size(); ++k) {
            if (meetings[k] != Meeting::nothing) found.push_back({chunk[k], meetings[k]});
        }
    }
    count(near.size(), tests);
    return found;
}

void KeptRays::count(std::size_t rays, const accel::TestCounts& tests) {
    tile_.tests.kept_rays += rays, tile_.tests.box_tests += tests.box_tests, tile_.tests.shape_tests += tests.shape_tests;
}

}  // namespace crescente::render
