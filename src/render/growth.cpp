#include "render/growth.h"

#include <algorithm>

#include "render/bsdf.h"
#include "render/hit_surface.h"
#include "render/light_seen.h"
#include "render/medium.h"
#include "render/ray_lanes.h"
#include "render/surface_lobes.h"

namespace crescente::render {
namespace {

using accel::Coherence;
using accel::Hit;
using geometry::Ray;

void camera_rays(const World& world, std::span<const LatticePoint> points, std::vector<Ray>& rays) {
    rays.resize(blocks_of(points.size()) * lane_count);
    for (std::size_t block = 0; block < points.size(); block += lane_count) {
        Lanes x, y;
        for (int i = 0; i < lane_count; ++i) {
            const LatticePoint& p = points[std::min(block + i, points.size() - 1)];
            x[i] = p.x, y[i] = p.y;
        }
        world.camera.through(x * pixels_per_step, y * pixels_per_step, &rays[block]);
    }
    rays.resize(points.size());
}

}  // namespace

std::uint32_t Growth::add_roots(std::span<const LatticePoint> points, std::span<const std::array<std::uint32_t, 4>> tried_first) {
    const auto first = static_cast<std::uint32_t>(tile_.nodes.size());
    camera_rays(world_, points, rays_);
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
    // To what was grown before an edit little is added as a rule: not worth twice the room.
    const std::size_t count = first + rays_.size();
    if (tile_.all_lit > 0 && count > tile_.nodes.capacity()) tile_.nodes.reserve(count + count / 32);
    tile_.nodes.resize(count);
    for (std::size_t block = 0; block < rays_.size(); block += lane_count) {
        const int lanes = static_cast<int>(std::min<std::size_t>(lane_count, rays_.size() - block));
        unsigned found = 0;
        for (int i = 0; i < lanes; ++i) found |= hits_[block + i].found() ? 1u << i : 0u;
        const SurfaceLanes at = surfaces_at(world_, &rays_[block], &hits_[block], found);
        const OctahedralPoint<Lanes> code = to_octahedral(at.geometric);
        for (int i = 0; i < lanes; ++i) {
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
    points_room_.resize(std::max(points_room_.size(), blocks_of(nodes.size())));
    std::size_t used = 0;
    int filled = lane_count;
    for (const std::uint32_t i : nodes) {
        const Node& node = tile_.nodes[i];
        if (node.left_scene()) continue;
        if (filled == lane_count) ++used, filled = 0;
        PointLanes& p = points_room_[used - 1];
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
    points_ = std::span(points_room_).first(used);
    for (PointLanes& p : points_) {
        p.viewer = normalize(p.viewer - p.position);
        p.geometric = geometric_normals(p.code);
    }
}

// What the points are made of; known: of those that did not leave the scene.
void Growth::find_lobes(std::span<const Lobes* const> known) {
    if (!known.empty()) {
        std::size_t next = 0;
        for (PointLanes& p : points_) {
            for (int i = 0; i < p.count; ++i) p.lobes[i] = known[next++];
        }
        return;
    }
    if (!world_.textured.empty()) textured_.resize(points_.size() * lane_count);
    for (std::size_t k = 0; k < points_.size(); ++k) {
        PointLanes& p = points_[k];
        for (int i = 0; i < p.count; ++i) {
            const std::uint32_t material = tile_.nodes[p.node[i]].material;
            p.lobes[i] = world_.textured_material(material) ? &lobes_of(world_, tile_, p.node[i], textured_[k * lane_count + i]) : &world_.lobes[material];
        }
    }
}

void Growth::spawn(std::span<const std::uint32_t> nodes, std::vector<Pending>& pending) {
    gather(nodes);
    find_lobes();
    spawn_from_points(pending);
}

void Growth::light_and_spawn(std::span<const std::uint32_t> nodes, Coherence coherence, std::vector<Pending>& pending) {
    light(nodes, settings_.level >= scene::Level::shadows, coherence);
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
    rays_.resize(blocks_of(pending.size()) * lane_count);
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
                TexturedLobes scratch;
                const double ior = lobes_of(world_, tile_, from.parent, scratch).ior;
                refracted |= 1u << i;
                eta[i] = node.inside ? ior : 1 / ior;
            }
            if (from.way == Way::straight) straight |= 1u << i;
            if (from.way == Way::reflected && has_own_coat(world_, node.material)) {
                TexturedLobes scratch;
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
        make_rays(starts(p.position, p.geometric, p.offset, direction), direction, Lanes{}, Lanes{} + std::numeric_limits<double>::infinity(),
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
    light_and_spawn(fresh_, coherence, next);
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
