#include "render/kept_rays.h"

#include <algorithm>

#include "render/growth.h"

namespace crescente::render {
namespace {

// Nodes that are looked at together; neighbours in the list are mostly neighbours in the picture.
constexpr std::uint32_t block_size = 64;

// How far from a node, in its offsets, its ray may have ended: several times what rounding can do.
constexpr double end_slack = 4;

Bounds around(Vec3 point, double distance) {
    const Vec3 beside = Vec3{1, 1, 1} * distance;
    return {point - beside, point + beside};
}

// Where a node's ray ran.
struct Stretch {
    Bounds start;
    Bounds end;    // or the direction, if
    bool endless;  // it left the scene

    Bundle bundle() const { return endless ? toward(start, end) : between(start, end); }
};

Stretch stretch_of(const Tile& tile, std::uint32_t i, Vec3 start, double beside) {
    const Node& node = tile.nodes[i];
    return {around(start, beside), around(node.position, node.left_scene() ? 0 : end_slack * node.offset), node.left_scene()};
}

// Boxes of several stretches.
struct Stretches {
    Bounds starts, ends, endless_starts, directions;

    void include(const Stretch& s) {
        (s.endless ? endless_starts : starts).include(s.start);
        (s.endless ? directions : ends).include(s.end);
    }
    bool may_meet(const InstanceGroup& group) const {
        return (!ends.empty() && group.may_meet(between(starts, ends))) || (!directions.empty() && group.may_meet(toward(endless_starts, directions)));
    }
};

// Rays through any point of the tile.
Bundle camera_bundle(const World& world, const Tile& tile) {
    Bounds origins, directions;
    for (const int x : {tile.x0, tile.x0 + tile.width}) {
        for (const int y : {tile.y0, tile.y0 + tile.height}) {
            const geometry::Ray ray = camera_ray(world, {static_cast<std::uint32_t>(x) << subpixel_bits, static_cast<std::uint32_t>(y) << subpixel_bits});
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
    const auto nodes = static_cast<std::uint32_t>(tile_.nodes.size());
    const auto stretch = [&](std::uint32_t i) {
        const std::uint32_t parent = tile_.nodes[i].parent;
        if (parent == no_node) return stretch_of(tile_, i, camera_ray(world, point_of(places_[i])).origin, 0);
        return stretch_of(tile_, i, tile_.nodes[parent].position, tile_.nodes[parent].offset);
    };
    std::vector<std::uint32_t> near;
    std::vector<Stretch> own(block_size);
    std::vector<std::uint32_t> block;
    for (std::uint32_t first = 0; first < nodes; first += block_size) {
        Stretches all;
        block.clear();
        for (std::uint32_t i = first; i < std::min(first + block_size, nodes); ++i) {
            if (lost_[i] || (tile_.nodes[i].parent == no_node && !roots_may)) continue;
            own[block.size()] = stretch(i);
            all.include(own[block.size()]);
            block.push_back(i);
        }
        if (!all.may_meet(group)) continue;
        for (std::size_t k = 0; k < block.size(); ++k) {
            if (group.may_meet(own[k].bundle())) near.push_back(block[k]);
        }
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

void KeptRays::find_lit_blocks() {
    lit_known_ = true;
    const auto nodes = static_cast<std::uint32_t>(tile_.nodes.size());
    for (std::uint32_t first = 0; first < nodes; first += block_size) {
        LitBlock block{first, std::min(first + block_size, nodes), {}};
        for (std::uint32_t i = first; i < block.end; ++i) {
            if (is_lit(i)) block.starts.include(around(tile_.nodes[i].position, tile_.nodes[i].offset));
        }
        if (block.starts.empty()) continue;
        lit_starts_.include(block.starts);
        lit_.push_back(block);
    }
}

std::vector<KeptRays::MetWay> KeptRays::ways_that_meet(const InstanceGroup& group, const World& world, std::size_t light, Share settled) {
    if (!lit_known_) find_lit_blocks();
    std::vector<MetWay> found;
    const scene::Light& source = world.lights[light].source();
    const auto may_meet = [&](const Bounds& starts) {
        if (source.kind == scene::LightKind::directional) return group.may_meet(toward(starts, {-source.direction, -source.direction}));
        return group.may_meet(between(starts, {source.position, source.position}));
    };
    if (lit_.empty() || !may_meet(lit_starts_)) return found;
    std::vector<std::uint32_t> near;
    for (const LitBlock& block : lit_) {
        if (!may_meet(block.starts)) continue;
        for (std::uint32_t i = block.first; i < block.end; ++i) {
            const Share share = tile_.shares[i * world.lights.size() + light];
            if (share == Share::untried || share == Share::behind || share == settled || !is_lit(i)) continue;
            if (may_meet(around(tile_.nodes[i].position, tile_.nodes[i].offset))) near.push_back(i);
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
