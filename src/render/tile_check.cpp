#include "render/tile_check.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "render/level_edges.h"
#include "render/level_lens.h"
#include "render/lens_sampler.h"

namespace crescente::render {
namespace {

bool is_unit(Vec3 v) { return std::abs(length(v) - 1) < 1e-3; }  // up to rounding

// One more than the largest primitive that a hit on the shape can name.
std::uint32_t primitives(const geometry::Shape& shape) {
    if (std::holds_alternative<geometry::Box>(shape)) return 6;  // its sides
    if (std::holds_alternative<geometry::Cone>(shape) || std::holds_alternative<geometry::Cylinder>(shape)) return 3;  // wall, base, top
    return geometry::parts(shape);
}

// Where points of an instance can be: its box, grown by as much again, so that no rounding nor tolerance leads out of it.
Bounds reach_of(const Bounds& box) {
    if (!box.bounded()) return Bounds::everything();
    const double margin = length(box.diagonal()) + 1e-6 * box.largest_coordinate();
    return {box.lower - Vec3{margin, margin, margin}, box.upper + Vec3{margin, margin, margin}};
}

class TileCheck {
public:
    TileCheck(const Tile& tile, const World& world, std::span<const Stage> stages) : tile_(tile), world_(world), stages_(stages) {
        for (std::size_t i = 0; i < world.instances.size(); ++i) {
            primitives_.push_back(primitives(*world.instances[i].shape));
            reaches_.push_back(reach_of(world.boxes[i]));
        }
    }

    std::string run() {
        if (!progress_holds()) return "says it is farther than it is";
        if (tile_.corners.empty()) return is_blank() ? "" : "has trees without roots";
        if (!nodes_hold()) return "has a node that is no part of a tree, or of nothing in the scene";
        if (!roots_hold()) return "has a pixel corner without a tree";
        if (!shares_hold()) return "has light that nobody knows of";
        if (!samples_hold()) return "has samples that do not fit its nodes";
        if (!lens_holds()) return "has samples that do not fit its pixels";
        if (!rays_hold(tile_.pending) || !rays_hold(tile_.growing)) return "has rays that come from nowhere";
        if (!quads_hold(tile_.quads, false) || !quads_hold(tile_.quads_before, true)) return "has pixels whose parts do not fit";
        if (!stopped_soundly()) return "was stopped where it cannot have been";
        return "";
    }

private:
    std::size_t pixel_count() const { return static_cast<std::size_t>(tile_.width) * static_cast<std::size_t>(tile_.height); }
    bool is_root(std::uint32_t i) const { return i < tile_.nodes.size() && tile_.nodes[i].parent == no_node; }
    bool is_root_or_none(std::uint32_t i) const { return i == no_node || is_root(i); }
    int first_stage_after(scene::Level level) const {
        return static_cast<int>(std::count_if(stages_.begin(), stages_.end(), [&](const Stage& s) { return s.level <= level; }));
    }

    bool progress_holds() const {
        const int all = static_cast<int>(stages_.size());
        if (tile_.stage < 0 || tile_.stage > all || tile_.pixels_stage < -1 || tile_.pixels_stage > all) return false;
        if (!tile_.pixels.empty() && tile_.pixels.size() != pixel_count()) return false;
        if (!tile_.clear_pixels.empty() && tile_.clear_pixels.size() != tile_.pixels.size()) return false;
        // What waits for its light gets it from the stage of shadows.
        const int visible = first_stage_after(scene::Level::visible);
        if (!tile_.lit && (visible == all || tile_.stage > visible)) return false;
        return !tile_.shows_pixels() || (!tile_.pixels.empty() && tile_.pixels_stage >= 0);
    }
    bool is_blank() const {
        return tile_.nodes.empty() && tile_.lens_samples.empty() && tile_.lens_estimates.empty() && tile_.lens_pixels.empty() && tile_.lens_clear.empty() && !tile_.lens_piloted && tile_.shares.empty() && tile_.filtered.empty() && tile_.straight.empty() && tile_.pending.empty() && tile_.growing.empty() &&
               tile_.quads.empty() && tile_.quads_before.empty() && tile_.subpixel_roots.empty() && tile_.todo.empty() && tile_.stage == 0 && tile_.cursor == 0;
    }

    bool nodes_hold() {
        if (tile_.nodes.size() >= no_node) return false;
        // Each but a root is one child of its parent: what goes down the trees comes to a node once.
        sent_.assign(tile_.nodes.size(), 0);
        std::vector<std::uint8_t> met(tile_.nodes.size());
        const auto meet = [&](std::uint32_t child, std::uint32_t parent, Way way) {
            if (child == no_node) return true;
            return child < tile_.nodes.size() && tile_.nodes[child].parent == parent && !std::exchange(met[child], 1) && send(parent, way);
        };
        for (std::uint32_t i = 0; i < tile_.nodes.size(); ++i) {
            const Node& node = tile_.nodes[i];
            if (!has_its_place(node, i) || !ends_somewhere(node)) return false;
            if (!meet(node.reflected, i, Way::reflected) || !meet(node.refracted, i, Way::refracted)) return false;
        }
        for (const auto& [parent, child] : tile_.straight) {
            if (child == no_node || !meet(child, parent, Way::straight)) return false;
        }
        for (std::uint32_t i = 0; i < tile_.nodes.size(); ++i) {
            if (is_root(i) == (met[i] != 0)) return false;
        }
        return true;
    }
    // Its parent must have its place.
    bool ends_somewhere(const Node& node) const {
        if (!math::is_finite(node.position) || !std::isfinite(node.offset) || node.material >= world_.lobes.size()) return false;
        if (node.left_scene()) return is_unit(node.position);
        if (!is_unit({node.normal[0], node.normal[1], node.normal[2]})) return false;
        // What lights a node and sends its rays looks from it to the viewer.
        const Vec3 viewer = node.parent == no_node ? world_.camera.viewer_of(node.position) : tile_.nodes[node.parent].position;
        if (!is_unit(normalize(viewer - node.position))) return false;
        if (node.instance >= world_.instances.size() || node.primitive >= primitives_[node.instance]) return false;
        const Bounds& reach = reaches_[node.instance];
        return max(reach.lower, min(node.position, reach.upper)) == node.position;
    }
    // Depths make sure that no way up is longer than they can count.
    bool has_its_place(const Node& node, std::uint32_t i) const {
        if (node.parent == no_node) return node.depth == 0;
        return node.parent < i && !tile_.nodes[node.parent].left_scene() && node.depth == tile_.nodes[node.parent].depth + 1;
    }

    bool roots_hold() const {
        if (tile_.corners.size() != static_cast<std::size_t>(tile_.width + 1) * static_cast<std::size_t>(tile_.height + 1)) return false;
        const bool all_there = tile_.stage >= first_stage_after(scene::Level::visible);
        std::vector<std::uint8_t> taken(tile_.nodes.size());  // each corner has its own root: what goes down from all of them comes to a node once
        for (const std::uint32_t root : tile_.corners) {
            if (root == no_node ? all_there : !is_root(root) || std::exchange(taken[root], 1)) return false;
        }
        return std::all_of(tile_.subpixel_roots.begin(), tile_.subpixel_roots.end(), [&](const auto& entry) { return is_root(entry.second); });
    }

    bool shares_hold() const {
        const std::size_t lights = world_.lights.size();
        if (tile_.shares.size() > tile_.nodes.size() * lights || (lights > 0 && tile_.shares.size() % lights != 0)) return false;
        for (std::size_t key = 0; key < tile_.shares.size(); ++key) {
            if (tile_.shares[key] > Share::filtered) return false;
            if (tile_.shares[key] == Share::filtered && !tile_.filtered.contains(key)) return false;
        }
        return true;
    }

    bool rays_hold(const std::vector<Pending>& rays) {
        return std::all_of(rays.begin(), rays.end(), [&](const Pending& p) {
            return p.parent < tile_.nodes.size() && !tile_.nodes[p.parent].left_scene() && tile_.nodes[p.parent].depth < 255 && send(p.parent, p.way);
        });
    }
    bool samples_hold() const {
        if (tile_.samples.size() > tile_.nodes.size() || (world_.lens && !tile_.samples.empty()) || tile_.estimates.size() != tile_.samples.size() * estimate_groups(world_)) return false;
        if (!std::all_of(tile_.estimates.begin(), tile_.estimates.end(), sums_hold)) return false;
        for (std::size_t i = 0; i < tile_.nodes.size(); ++i) {
            if ((tile_.nodes[i].sampled || tile_.nodes[i].outdated) && (i >= tile_.samples.size() || tile_.samples[i] == 0)) return false;
        }
        return true;
    }

    // Through a lens pixels have samples, all of them once a round is complete.
    bool lens_holds() const {
        const bool begun = !tile_.lens_samples.empty();
        const std::size_t count = begun ? lens_pixels_of(tile_, world_.scene.settings).count() : 0;
        if (begun && !world_.lens) return false;
        const std::size_t columns = begun ? LensColumns(world_).count() : 0;
        if (tile_.lens_samples.size() != count || tile_.lens_pixels.size() != (begun ? pixel_count() : 0) || tile_.lens_estimates.size() != count * columns) return false;
        if (tile_.lens_clear.size() != (begun && world_.lens->apart ? pixel_count() : 0)) return false;
        if (!begun) return !tile_.lens_piloted && (!world_.lens || tile_.stage <= first_stage_after(scene::Level::edges));
        const auto most = tile_.lens_piloted ? std::numeric_limits<std::uint16_t>::max() : pilot;
        const auto least = tile_.stage > first_stage_after(scene::Level::edges) ? 1u : 0u;
        const auto samples_hold = [&](std::uint16_t samples) { return samples >= least && samples <= most; };
        return std::all_of(tile_.lens_samples.begin(), tile_.lens_samples.end(), samples_hold) &&
               std::all_of(tile_.lens_estimates.begin(), tile_.lens_estimates.end(), sums_hold) &&
               std::all_of(tile_.lens_pixels.begin(), tile_.lens_pixels.end(), [](Rgb light) { return math::is_finite(light); }) &&
               std::all_of(tile_.lens_clear.begin(), tile_.lens_clear.end(), [](float clear) { return std::isfinite(clear); });
    }
    static bool sums_hold(const Estimate& e) { return math::is_finite(e.diffuse) && math::is_finite(e.glossy); }

    // Whether the node can have sent this ray, which it does once.
    bool send(std::uint32_t node, Way way) {
        const auto bit = static_cast<std::uint8_t>(1 << static_cast<int>(way));
        const bool again = sent_[node] & bit;
        sent_[node] |= bit;
        return tile_.nodes[node].spawned && !again;
    }

    // Parts come after what they are parts of, four by four, and belong to one quad only: nothing that goes down them goes in circles or multiplies.
    bool quads_hold(const std::vector<Quad>& quads, bool roots_may_be_lost) const {
        if (quads.empty()) return true;
        const std::size_t pixels = pixel_count();
        if (quads.size() < pixels || (quads.size() - pixels) % 4 != 0) return false;
        std::vector<std::uint8_t> depth(quads.size());
        std::vector<std::uint8_t> belongs(quads.size());
        std::fill_n(belongs.begin(), pixels, 1);
        for (std::size_t i = 0; i < quads.size(); ++i) {
            // What once was a part and no longer is may have lost its roots.
            const bool whole = belongs[i] && !roots_may_be_lost;
            for (const std::uint32_t root : quads[i].corners) {
                if (whole ? !is_root(root) : !is_root_or_none(root)) return false;
            }
            const std::size_t parts = quads[i].parts;
            if (parts == no_node) continue;
            if (parts < pixels || parts <= i || parts + 3 >= quads.size() || (parts - pixels) % 4 != 0 || belongs[parts] || depth[i] + 1 >= subpixel_bits) return false;
            for (std::size_t k = 0; k < 4; ++k) belongs[parts + k] = belongs[i], depth[parts + k] = static_cast<std::uint8_t>(depth[i] + 1);
        }
        return true;
    }

    bool stopped_soundly() const {
        if (tile_.cursor == 0) return tile_.growing.empty();
        if (tile_.stage == static_cast<int>(stages_.size())) return false;
        const Stage& stage = stages_[static_cast<std::size_t>(tile_.stage)];
        if (stage.level == scene::Level::edges) return can_go_on(tile_, stage);
        const bool by_pixel = world_.lens && stage.level > scene::Level::edges;
        return tile_.growing.empty() && tile_.cursor <= (by_pixel ? lens_pixels_of(tile_, world_.scene.settings).count() : tile_.nodes.size());
    }

    const Tile& tile_;
    const World& world_;
    std::span<const Stage> stages_;
    std::vector<std::uint32_t> primitives_;  // by instance
    std::vector<Bounds> reaches_;            // by instance
    std::vector<std::uint8_t> sent_;         // by node: bit w if its ray of way w is a child or waits
};

}  // namespace

std::string tile_problem(const Tile& tile, const World& world, std::span<const Stage> stages) { return TileCheck(tile, world, stages).run(); }

}  // namespace crescente::render
