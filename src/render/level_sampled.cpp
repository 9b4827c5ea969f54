#include "render/level_sampled.h"

#include <algorithm>
#include <bit>

#include "render/catcher.h"
#include "render/level_lens.h"
#include "render/path_sampler.h"
#include "render/stand_ins.h"
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
          depths_(split_depths(growth.tile())),
          sampler_(growth.world(), growth.tile().rays, growth.tile().tests) {}

    bool run(const Deadline& deadline) {
        tile_.samples.resize(tile_.nodes.size());
        tile_.estimates.resize(tile_.nodes.size() * groups_);
        const bool some_wait = bound_ < most_ && share(deepest_split()) == 0;
        if (some_wait) find_waiting();
        if (some_wait && bound_ == 1 && tile_.cursor == 0) tile_.unsampled = radiances(tile_);
        while (tile_.cursor < tile_.nodes.size()) {
            std::size_t end = tile_.cursor;
            const std::size_t furthest = std::min(tile_.nodes.size(), end + most_looked_at);
            for (; end < furthest && chunk_.size() < chunk_size; ++end) {
                const auto i = static_cast<std::uint32_t>(end);
                const std::uint32_t root = tile_.nodes[i].left_scene() ? no_node : root_of_seen(i);
                if (root == no_node) continue;
                if (renews_ && tile_.nodes[i].outdated) forget_samples(tile_, i);
                const Wanted wanted{i, split_depth(depths_, root), !waiting_.empty() && waiting_[root]};
                forget_too_many(wanted);
                if (tile_.samples[i] < goal(wanted) || (!tile_.nodes[i].sampled && tile_.samples[i] > 0)) chunk_.push_back(wanted);
            }
            const bool complete = sample_chunk(deadline);
            show_chunk();
            chunk_.clear();
            if (!complete) return false;
            tile_.cursor = end;
            if (deadline.passed() && end < tile_.nodes.size()) return false;
        }
        if (!some_wait) release(tile_.unsampled);
        return true;
    }

private:
    struct Wanted {
        std::uint32_t node;
        SplitDepth depth;  // of its root
        bool waits;        // others stand in for the root until its parts of pixels have a share in the round
    };

    // What textures say of smoothness is not worth asking for that.
    void find_waiting() {
        waiting_.resize(tile_.nodes.size());
        const auto all = [](std::uint32_t) { return true; };
        const auto ways = [&](std::uint32_t i) { return smooth_lobes(world_.lobes[tile_.nodes[i].material]); };
        for_each_stand_in(tile_, all, ways, [&](std::uint32_t root, std::uint32_t) { waiting_[root] = true; });
    }

    // no_node: the node is no part of the picture: below what was hidden, below rays that stand for lobes that are sampled, or in parts of pixels that are no more.
    std::uint32_t root_of_seen(std::uint32_t i) {
        for (std::uint32_t above = tile_.nodes[i].parent; above != no_node; i = above, above = tile_.nodes[i].parent) {
            if (tile_.nodes[i].hidden) return no_node;
            const Node& parent = tile_.nodes[above];
            const Smooth smooth = smooth_lobes_of(above);
            if ((parent.reflected == i && !smooth.reflects) || (parent.refracted == i && !smooth.refracts)) return no_node;
        }
        return split_depth(depths_, i).parts == SplitDepth::none ? no_node : i;
    }

    Smooth smooth_lobes_of(std::uint32_t i) { return smooth_lobes(lobes_of(world_, tile_, i, scratch_)); }

    // A round gives a pixel about as many samples whether it is split or not, until the last gives every node what it needs. splits: of the pixel.
    std::uint32_t share(unsigned splits) const { return bound_ == most_ ? bound_ : bound_ >> (2 * splits); }

    unsigned deepest_split() const {
        unsigned deepest = 0;
        for (const SplitDepth& depth : depths_) deepest = depth.parts == SplitDepth::none ? deepest : std::max<unsigned>(deepest, depth.parts);
        return deepest;
    }

    std::uint32_t goal(Wanted wanted) const {
        const auto [i, depth, waits] = wanted;
        if (tile_.nodes[i].outdated) return tile_.samples[i];
        if (waits && share(depth.parts) == 0) return 0;
        const std::uint32_t bound = std::max(std::min(bound_, fewest_to_tell), share(depth.parts));
        if (bound <= pilot) return bound;
        return tile_.samples[i] < pilot ? pilot : std::min(bound, samples_needed(world_, tile_, i, depth.place));
    }

    // After an edit a node may have more samples than a fresh render would have given it.
    void forget_too_many(Wanted wanted) {
        const auto [i, depth, waits] = wanted;
        const std::uint32_t samples = tile_.samples[i];
        const std::uint32_t needed = most_ <= pilot ? most_ : samples >= pilot ? samples_needed(world_, tile_, i, depth.place) : samples;
        if (samples > needed && !tile_.nodes[i].outdated) forget_samples(tile_, i);
    }

    // One sample of each after the other, so that neighbours are traced together. Whether there was time for all.
    bool sample_chunk(const Deadline& deadline) {
        chunk_points_.clear(), surfaces_.clear();
        chunk_lobes_.resize(chunk_.size()), surfaces_.reserve(chunk_.size());
        for (std::size_t k = 0; k < chunk_.size(); ++k) {
            SamplePoint point = point_of(chunk_[k].node, chunk_lobes_[k]);
            point.surface = &surfaces_.emplace_back(*point.lobes, point.facing, point.to_viewer, SmoothAs::nothing);
            chunk_points_.push_back(point);
        }
        while (true) {
            wanting_.clear(), points_.clear();
            for (std::size_t k = 0; k < chunk_.size(); ++k) {
                const std::uint32_t i = chunk_[k].node;
                if (tile_.samples[i] >= goal(chunk_[k])) continue;
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

    SamplePoint point_of(std::uint32_t i, TexturedLobes& scratch) const {
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
        shown_.clear(), shown_lobes_.clear();
        for (std::size_t k = 0; k < chunk_.size(); ++k) {
            const std::uint32_t i = chunk_[k].node;
            if (tile_.samples[i] == 0) continue;
            shown_.push_back(i), shown_lobes_.push_back(chunk_points_[k].lobes);
            Node& node = tile_.nodes[i];
            const Smooth smooth = smooth_lobes(*chunk_points_[k].lobes);
            node.sampled = true;
            node.samples_reflection = !smooth.reflects, node.samples_refraction = !smooth.refracts;
        }
        growth_.light(shown_, true, accel::Coherence::coherent, shown_lobes_);
    }

    Growth& growth_;
    Tile& tile_;
    const World& world_;
    const std::size_t groups_;
    const bool renews_;
    const std::uint32_t most_, bound_;
    const std::vector<SplitDepth> depths_;
    std::vector<bool> waiting_;  // roots that others stand in for; empty: none has to wait in this round
    PathSampler sampler_;
    TexturedLobes scratch_;
    std::vector<Wanted> chunk_;
    std::vector<std::uint32_t> wanting_, shown_;
    std::vector<SamplePoint> chunk_points_, points_;
    std::vector<TexturedLobes> chunk_lobes_;
    std::vector<const Lobes*> shown_lobes_;
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
