#include "render/level_sampled.h"

#include <algorithm>
#include <bit>

#include "render/catcher.h"
#include "render/level_lens.h"
#include "render/path_sampler.h"
#include "render/surface_lobes.h"

namespace crescente::render {
namespace {

// The last round: what an edit made outdated, and has been shown nevertheless, is sampled anew, a few nodes at a time to the end.
constexpr double renewal = 0;

constexpr std::size_t most_looked_at = 16 * chunk_size;  // nodes, for those of a chunk: whoever interrupts does not wait for a search through all of them

std::vector<Stage> rounds(scene::Level level, const scene::Settings& settings) {
    std::vector<Stage> stages;
    int before = 0;
    // From one sample at once to as many as tell of their noise; then so that halfway through a round the picture is not much worse than if all nodes had the same number.
    for (int bound = 1; before < settings.samples; bound = bound == 1 ? static_cast<int>(fewest_to_tell) : 2 * bound) {
        const int samples = std::min(bound, settings.samples);
        stages.push_back({level, double(samples), double(samples - before)});
        before = samples;
    }
    stages.push_back({level, renewal, 1});
    return stages;
}

// By which the random numbers of a node go: where it is, to the bit. So they are the same in every tile, and whatever became of other nodes.
std::uint64_t key_of(Vec3 position) {
    std::uint64_t key = 0;
    for (const double x : {position.x, position.y, position.z}) key = mix_bits(key ^ std::bit_cast<std::uint64_t>(x));
    return key;
}

constexpr std::uint8_t no_depth = 0xff;

// How often pixels are split about each root: of the parts that have it as a corner, the largest counts. Empty: nowhere.
std::vector<std::uint8_t> split_depths(const Tile& tile) {
    std::vector<std::uint8_t> of_roots, of_quads(tile.quads.size());
    if (of_quads.size() > static_cast<std::size_t>(tile.width) * static_cast<std::size_t>(tile.height)) of_roots.assign(tile.nodes.size(), no_depth);
    for (std::size_t q = 0; q < tile.quads.size() && !of_roots.empty(); ++q) {  // parts come after what they are parts of
        const Quad& quad = tile.quads[q];
        for (std::uint32_t k = 0; k < 4; ++k) {
            if (quad.parts != no_node) of_quads[quad.parts + k] = static_cast<std::uint8_t>(of_quads[q] + 1);
            else if (quad.corners[k] != no_node) of_roots[quad.corners[k]] = std::min(of_roots[quad.corners[k]], of_quads[q]);
        }
    }
    return of_roots;
}

class Sampling {
public:
    Sampling(Growth& growth, const Stage& stage)
        : growth_(growth),
          tile_(growth.tile()),
          world_(growth.world()),
          groups_(estimate_groups(growth.world())),
          renews_(stage.parameter == renewal),
          most_(static_cast<std::uint32_t>(growth.settings().samples)),
          bound_(renews_ ? most_ : static_cast<std::uint32_t>(stage.parameter)),
          depths_(bound_ < most_ ? split_depths(growth.tile()) : std::vector<std::uint8_t>{}),
          sampler_(growth.world(), growth.tile().rays, growth.tile().tests) {}

    bool run(const Deadline& deadline) {
        tile_.samples.resize(tile_.nodes.size());
        tile_.estimates.resize(tile_.nodes.size() * groups_);
        while (tile_.cursor < tile_.nodes.size()) {
            std::size_t end = tile_.cursor;
            const std::size_t furthest = std::min(tile_.nodes.size(), end + most_looked_at);
            for (; end < furthest && chunk_.size() < chunk_size; ++end) {
                const auto i = static_cast<std::uint32_t>(end);
                const std::uint32_t root = tile_.nodes[i].left_scene() ? no_node : root_of_seen(i);
                if (root == no_node) continue;
                if (renews_ && tile_.nodes[i].outdated) forget_samples(tile_, i);
                forget_too_many(i);
                const std::uint32_t bound = bound_below(root);
                if (!tile_.nodes[i].sampled || tile_.samples[i] < goal(i, bound)) chunk_.push_back(i), bounds_.push_back(bound);
            }
            const bool complete = sample_chunk(deadline);
            show_chunk();
            chunk_.clear(), bounds_.clear();
            if (!complete) return false;
            tile_.cursor = end;
            if (deadline.passed() && end < tile_.nodes.size()) return false;
        }
        return true;
    }

private:
    // no_node: the node is no part of the picture: below what was hidden, or below rays that stand for lobes that are sampled.
    std::uint32_t root_of_seen(std::uint32_t i) {
        for (std::uint32_t above = tile_.nodes[i].parent; above != no_node; i = above, above = tile_.nodes[i].parent) {
            if (tile_.nodes[i].hidden) return no_node;
            const Node& parent = tile_.nodes[above];
            const Smooth smooth = smooth_lobes_of(above);
            if ((parent.reflected == i && !smooth.reflects) || (parent.refracted == i && !smooth.refracts)) return no_node;
        }
        return i;
    }

    // A round gives a pixel about as many samples whether it is split or not, until the last gives every node what it needs.
    std::uint32_t bound_below(std::uint32_t root) const {
        if (depths_.empty() || depths_[root] == no_depth) return bound_;
        return std::max(std::min(bound_, fewest_to_tell), bound_ >> (2 * depths_[root]));
    }

    Smooth smooth_lobes_of(std::uint32_t i) { return smooth_lobes(lobes_of(world_, tile_, i, scratch_)); }

    std::uint32_t goal(std::uint32_t i, std::uint32_t bound) const {
        if (tile_.nodes[i].outdated) return tile_.samples[i];
        if (bound <= pilot) return bound;
        return tile_.samples[i] < pilot ? pilot : std::min(bound, samples_needed(world_, tile_, i));
    }

    // After an edit a node may have more samples than a fresh render would have given it.
    void forget_too_many(std::uint32_t i) {
        const std::uint32_t samples = tile_.samples[i];
        const std::uint32_t needed = most_ <= pilot ? most_ : samples >= pilot ? samples_needed(world_, tile_, i) : samples;
        if (samples > needed && !tile_.nodes[i].outdated) forget_samples(tile_, i);
    }

    // One sample of each after the other, so that neighbours are traced together. Whether there was time for all.
    bool sample_chunk(const Deadline& deadline) {
        chunk_points_.clear(), surfaces_.clear();
        chunk_lobes_.resize(chunk_.size()), surfaces_.reserve(chunk_.size());
        for (std::size_t k = 0; k < chunk_.size(); ++k) {
            SamplePoint point = point_of(chunk_[k], chunk_lobes_[k]);
            point.surface = &surfaces_.emplace_back(*point.lobes, point.facing, point.to_viewer, SmoothAs::nothing);
            chunk_points_.push_back(point);
        }
        while (true) {
            wanting_.clear(), points_.clear();
            for (std::size_t k = 0; k < chunk_.size(); ++k) {
                const std::uint32_t i = chunk_[k];
                if (tile_.samples[i] >= goal(i, bounds_[k])) continue;
                wanting_.push_back(i), points_.push_back(chunk_points_[k]);
                points_.back().index = tile_.samples[i];
            }
            if (points_.empty()) return true;
            light_.resize(points_.size() * groups_);
            sampler_.sample(points_, light_);
            for (std::size_t k = 0; k < wanting_.size(); ++k) {
                const std::uint32_t i = wanting_[k];
                for (std::size_t g = 0; g < groups_; ++g) {
                    const SampledLight& light = light_[k * groups_ + g];
                    add_sample(tile_.estimates[i * groups_ + g], tile_.samples[i], light.diffuse, light.glossy);
                }
                ++tile_.samples[i];
            }
            if (deadline.passed()) return false;
        }
    }

    SamplePoint point_of(std::uint32_t i, Lobes& scratch) const {
        const Node& node = tile_.nodes[i];
        const Vec3 viewer = node.parent != no_node ? tile_.nodes[node.parent].position : world_.camera.viewer_of(node.position);
        SamplePoint point;
        point.position = node.position;
        point.facing = {{node.normal[0], node.normal[1], node.normal[2]}, decode_direction(node.geometric_normal), node.inside};
        point.to_viewer = normalize(viewer - node.position);
        point.offset = node.offset;
        point.instance = node.instance;
        point.lobes = &lobes_of(world_, tile_, i, scratch);
        point.catches = catches(world_, tile_, i);
        if (world_.filters_light || !world_.textured.empty()) point.path = path_length(world_, tile_, i);
        point.key = key_of(node.position);
        return point;
    }

    // Lights the chunk's nodes that have samples by them.
    void show_chunk() {
        std::erase_if(chunk_, [&](std::uint32_t i) { return tile_.samples[i] == 0; });
        for (const std::uint32_t i : chunk_) {
            Node& node = tile_.nodes[i];
            const Smooth smooth = smooth_lobes_of(i);
            node.sampled = true;
            node.samples_reflection = !smooth.reflects, node.samples_refraction = !smooth.refracts;
        }
        growth_.light(chunk_, true, accel::Coherence::coherent);
    }

    Growth& growth_;
    Tile& tile_;
    const World& world_;
    const std::size_t groups_;
    const bool renews_;
    const std::uint32_t most_, bound_;
    const std::vector<std::uint8_t> depths_;
    PathSampler sampler_;
    Lobes scratch_;  // of a textured material
    std::vector<std::uint32_t> chunk_, bounds_, wanting_;  // bounds_: of samples, this round, of each of the chunk
    std::vector<SamplePoint> chunk_points_, points_;
    std::vector<Lobes> chunk_lobes_;  // of textured materials
    std::vector<Scattering> surfaces_;
    std::vector<SampledLight> light_;
};

}  // namespace

std::vector<Stage> soft_stages(const scene::Settings& settings) {
    return settings.level == scene::Level::soft ? rounds(scene::Level::soft, settings) : std::vector<Stage>{};
}

std::vector<Stage> indirect_stages(const scene::Settings& settings) { return rounds(scene::Level::indirect, settings); }

bool advance_sampled(Growth& growth, const Stage& stage, const Deadline& deadline) {
    return growth.world().lens ? advance_lens(growth, stage, deadline) : Sampling(growth, stage).run(deadline);
}

}  // namespace crescente::render
