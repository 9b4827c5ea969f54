#include "render/revision.h"

#include <algorithm>
#include <utility>

#include "render/environment.h"
#include "render/film.h"
#include "render/growth.h"
#include "render/kept_rays.h"
#include "render/level.h"
#include "render/level_edges.h"
#include "render/level_visible.h"
#include "render/light_seen.h"

namespace crescente::render {
namespace {

// The stage that sends a camera ray through every corner that has none.
int all_roots(const scene::Settings& settings) { return stages_to_all_roots(settings) - 1; }

bool is_sampled(const Tile& tile) { return !tile.samples.empty() || !tile.lens_samples.empty(); }

constexpr std::uint64_t nowhere = ~std::uint64_t{0};

class Reviser {
public:
    Reviser(Tile& tile, const World& before, const World& now, const Change& change, bool watched, std::span<const Rgb> displayed)
        : tile_(tile), before_(before), now_(now), change_(change), watched_(watched), displayed_(displayed) {}

    void run() {
        const std::size_t count = tile_.nodes.size();
        lost_.assign(count, 0), spawn_again_.assign(count, 0), bends_.assign(count, 0);
        if (change_.resamples && is_sampled(tile_)) take_samples_back();
        outdates_ = change_.outdates_samples && !tile_.samples.empty();
        touched_ = touched_ || outdates_ || !tile_.lens_samples.empty();  // the light of lens samples is not that of nodes
        const bool outdated = tile_.pixels_stage > tile_.stage;  // a picture of trees that are not here any more
        constexpr std::size_t few = 32;
        const bool untidy = tile_.forgotten * few > count;
        const bool rays_may_end_elsewhere = !change_.same_geometry;
        if (rays_may_end_elsewhere || untidy || change_.sky) place_roots();
        if (rays_may_end_elsewhere || untidy) find_lost_rays();
        if (lost_roots_) keep_picture(tile_, displayed_);
        if (lost_roots_ || outdated) tile_.pixels_stage = tile_.lit ? -1 : 0;
        if (change_.renumbered || change_.any_reassigned || change_.any_lobes || change_.all_lit || change_.depth || change_.sky) {
            update_nodes();
        }
        if (!tile_.growing.empty()) {  // stopped amid splitting, which is then begun again
            std::move(tile_.growing.begin(), tile_.growing.end(), std::back_inserter(tile_.pending));
            tile_.growing.clear();
            touched_ = true;
        }
        if (lost_any_ || spawns_again_) respawn();
        update_shares();
        tile_.split_anew = tile_.split_anew || lost_roots_ || untidy || change_.splitting || change_.stages;
        if (change_.stages) tile_.stage = std::min(tile_.stage, all_roots(now_.scene.settings));  // up to there all plans are the same
        if (tile_.pixels_stage > tile_.stage) tile_.pixels_stage = tile_.lit ? -1 : 0;  // of a longer plan, maybe
        touched_ = touched_ || outdated || lost_any_ || weights_changed_ || change_.frontier || change_.splitting || change_.stages;
        if (watched_ && touched_ && !lost_roots_ && !tile_.unsettled) keep_picture(tile_, displayed_);
        if (touched_) tile_.previewed_until = 0;
        if (lost_any_) compact();
        if (rays_may_end_elsewhere || untidy) tile_.forgotten = 0;
        if (!now_.absorbs && (weights_changed_ || change_.frontier)) weigh();
        tile_.unsettled = tile_.unsettled || touched_;
    }

private:
    // What the samples told does not hold any more. Until the tile is settled its picture is still made of them, unless they are of other groups of lights.
    void take_samples_back() {
        touched_ = tile_.resamples = true;
        if (estimate_groups(before_) == estimate_groups(now_)) return;
        if (watched_ && !tile_.unsettled) keep_picture(tile_, displayed_);
        forget_samples(tile_);
    }

    // Which point of the picture each root belongs to; the others no longer belong to any.
    void place_roots() {
        place_.assign(tile_.nodes.size(), nowhere);
        for (int y = 0; y <= tile_.height && !tile_.corners.empty(); ++y) {
            for (int x = 0; x <= tile_.width; ++x) place(tile_.corner(x, y), corner_point(tile_.x0 + x, tile_.y0 + y));
        }
        for (const auto& [key, root] : tile_.subpixel_roots) place(root, point_of(key));
        const std::vector<Quad>& quads = tile_.quads.empty() ? tile_.quads_before : tile_.quads;
        if (quads.empty()) return;
        std::uint32_t i = 0;
        for (int y = 0; y < tile_.height; ++y) {
            for (int x = 0; x < tile_.width; ++x) place_parts(quads, i++, corner_point(tile_.x0 + x, tile_.y0 + y), 1u << subpixel_bits);
        }
    }
    void place(std::uint32_t root, LatticePoint at) {
        if (root != no_node) place_[root] = key_of(at);
    }
    void place_parts(const std::vector<Quad>& quads, std::uint32_t quad, LatticePoint at, std::uint32_t size) {
        const std::uint32_t parts = quads[quad].parts, half = size / 2;
        if (parts == no_node) return;
        for (std::uint32_t k = 0; k < 4; ++k) {
            const LatticePoint corner{at.x + (k & 1 ? half : 0), at.y + (k & 2 ? half : 0)};
            for (std::uint32_t c = 0; c < 4; ++c) place(quads[parts + k].corners[c], {corner.x + (c & 1 ? half : 0), corner.y + (c & 2 ? half : 0)});
            place_parts(quads, parts + k, corner, half);
        }
    }

    // Rays that ended on what is gone, or that now end earlier.
    void find_lost_rays() {
        for (std::uint32_t i = 0; i < tile_.nodes.size(); ++i) {
            const Node& node = tile_.nodes[i];
            const bool root = node.parent == no_node;
            const bool forgotten = root && place_[i] == nowhere;  // of a pixel that is no longer split
            if (forgotten || (!root && lost_[node.parent])) lost_[i] = lost_any_ = true;
            else if (!node.left_scene() && change_.instance_now[node.instance] == no_node) lose(i);
        }
        if (!change_.came) return;
        for (const std::uint32_t i : KeptRays(tile_, lost_, place_).that_meet(*change_.came, before_)) lose(i);
    }
    void lose(std::uint32_t i) {
        lost_[i] = lost_any_ = true;
        const std::uint32_t parent = tile_.nodes[i].parent;
        if (parent == no_node) lost_roots_ = true;
        else spawn_again_[parent] = spawns_again_ = true;
    }

    // Instances and materials by their present index, skies, and who is to be lit anew or to send its rays anew.
    void update_nodes() {
        for (std::uint32_t i = 0; i < tile_.nodes.size(); ++i) {
            if (lost_[i]) continue;
            Node& node = tile_.nodes[i];
            if (node.left_scene()) {
                if (change_.sky) update_sky(i, point_of(place_[i]));
                continue;
            }
            if (const std::uint32_t now = change_.instance_now[node.instance]; now != node.instance) node.instance = now;  // most need not be written
            LobesChange lobes;
            if (change_.reassigned[node.instance]) {
                const std::uint32_t material = now_.material(node.instance, geometry::slot(*now_.instances[node.instance].shape, node.primitive));
                lobes = change_between(before_, node.material, now_, material);
                node.material = material;
                tile_.materials |= std::uint64_t{1} << material % 64;
            } else {
                lobes = change_.lobes[node.material];
            }
            if (lobes.light || change_.all_lit) relight(node);
            if (lobes.rays || change_.depth) spawn_again_[i] = spawns_again_ = true;
            if (lobes.bends) bends_[i] = true;
            if (!outdates_ || i >= tile_.samples.size() || tile_.samples[i] == 0) continue;
            if (lobes.light) forget_samples(tile_, i);
            else node.outdated = true;
        }
    }
    void update_sky(std::uint32_t i, LatticePoint at) {
        Node& node = tile_.nodes[i];
        const Rgb was = node.local;
        const std::uint16_t was_clear = node.clear;
        light_sky(now_, tile_, i, at);
        if (node.local != was || node.clear != was_clear) touched_ = true;
    }
    void relight(Node& node) {
        node.shadowed = false;
        touched_ = true;
    }

    // Compares the rays that nodes send now with those they sent: children keep what holds, and get their weight; the rest is pending, or lost.
    void respawn() {
        std::vector<std::uint32_t> again;
        for (std::uint32_t i = 0; i < tile_.nodes.size(); ++i) {
            if (!spawn_again_[i]) continue;
            const Node& node = tile_.nodes[i];
            if (lost_[i] || !node.spawned || node.left_scene()) spawn_again_[i] = false;
            else again.push_back(i);
        }
        Growth growth(now_, tile_, false);
        std::vector<Pending> sent, missing;
        for (std::size_t i = 0; i < again.size(); i += chunk_size) {
            growth.spawn(std::span(again).subspan(i, std::min(chunk_size, again.size() - i)), sent);
        }
        auto next = sent.begin();
        for (std::uint32_t i = 0; i < tile_.nodes.size(); ++i) {
            if (!lost_[i] && !spawn_again_[i]) continue;
            const Pending* rays[3] = {};
            for (; next != sent.end() && next->parent == i; ++next) rays[static_cast<std::size_t>(next->way)] = &*next;
            if (lost_[i]) {
                for (const Way way : ways) {
                    if (const std::uint32_t child = child_of(i, way); child != no_node) lost_[child] = true;
                }
                continue;
            }
            for (const Way way : ways) {
                const Pending* ray = rays[static_cast<std::size_t>(way)];
                const std::uint32_t child = child_of(i, way);
                const bool holds = child != no_node && !lost_[child] && ray && !(way == Way::refracted && bends_[i]);
                if (child != no_node && !holds) lost_[child] = lost_any_ = true;
                if (holds && tile_.nodes[child].weight != ray->weight && !now_.absorbs) tile_.nodes[child].weight = ray->weight, weights_changed_ = true;
                if (!ray || holds) continue;
                missing.push_back(*ray);
                if (is_unseen(i)) missing.back().influence = 0;
            }
        }
        std::erase_if(tile_.pending, [&](const Pending& p) { return lost_[p.parent] || spawn_again_[p.parent]; });
        tile_.pending.insert(tile_.pending.end(), missing.begin(), missing.end());
    }
    static constexpr Way ways[] = {Way::reflected, Way::refracted, Way::straight};
    bool is_unseen(std::uint32_t i) const {
        while (i != no_node && !tile_.nodes[i].hidden) i = tile_.nodes[i].parent;
        return i != no_node;
    }
    std::uint32_t child_of(std::uint32_t node, Way way) const {
        if (way == Way::reflected) return tile_.nodes[node].reflected;
        if (way == Way::refracted) return tile_.nodes[node].refracted;
        const auto child = tile_.straight.find(node);
        return child == tile_.straight.end() ? no_node : child->second;
    }

    // Ways of lights that are others are untried again, or known to be blocked; nodes are lit again where they are.
    void update_shares() {
        const std::size_t lights = change_.lights.size();
        bool same = change_.lights_before == lights;
        for (std::size_t l = 0; l < lights; ++l) same = same && change_.light_before[l] == l;
        if (!same) lay_out_shares();
        tile_.shares.resize(tile_.nodes.size() * lights, Share::untried);
        for (std::size_t l = 0; l < lights; ++l) {
            if (change_.lights[l] != LightChange::none) change_light(l);
        }
        if (change_.light_went || change_.light_came) try_shares_again();
    }

    // For the lights that there are now, which may be others, in another order.
    void lay_out_shares() {
        const std::size_t before = change_.lights_before, now = change_.lights.size();
        tile_.shares.resize(tile_.nodes.size() * before, Share::untried);
        std::vector<Share> shares(tile_.nodes.size() * now, Share::untried);
        std::unordered_map<std::uint64_t, Rgb> filtered;
        for (std::size_t l = 0; l < now; ++l) {
            const std::size_t was = change_.light_before[l];
            if (was == no_node) continue;
            for (std::size_t i = 0; i < tile_.nodes.size(); ++i) {
                shares[i * now + l] = tile_.shares[i * before + was];
                if (shares[i * now + l] == Share::filtered) filtered[i * now + l] = tile_.filtered.at(i * before + was);
            }
        }
        tile_.shares = std::move(shares);
        tile_.filtered = std::move(filtered);
    }

    void change_light(std::size_t l) {
        const std::size_t lights = change_.lights.size();
        const LightChange change = change_.lights[l];
        const bool is_new = change_.light_before[l] == no_node;
        for (std::size_t i = 0; i < tile_.nodes.size(); ++i) {
            Node& node = tile_.nodes[i];
            if (lost_[i] || node.left_scene()) continue;
            const Share share = tile_.shares[i * lights + l];
            tile_.untried = tile_.untried || is_new;
            if (share != Share::untried && (change == LightChange::way || (change == LightChange::reach && share == Share::behind))) {
                change_share(static_cast<std::uint32_t>(i), l, Share::untried);
            } else if (may_arrive(share) || now_.lobes[node.material].catcher) {  // the strength of a light that does not arrive does not matter, but to what catches shadows
                relight(node);
            }
        }
    }
    void change_share(std::uint32_t node, std::size_t light, Share now) {
        const std::size_t key = node * change_.lights.size() + light;
        if (tile_.shares[key] == Share::filtered) tile_.filtered.erase(key);
        tile_.shares[key] = now;
        tile_.untried = tile_.untried || now == Share::untried;
        relight(tile_.nodes[node]);
    }

    // What went may open ways that were not clear, what came may close those that were not blocked.
    void try_shares_again() {
        KeptRays kept(tile_, lost_, place_);
        const std::size_t lights = change_.lights.size();
        for (std::size_t l = 0; l < lights; ++l) {
            if (change_.lights[l] == LightChange::way) continue;
            if (change_.light_went) {
                for (const auto& way : kept.ways_that_meet(*change_.light_went, now_, l, Share::clear)) change_share(way.node, l, Share::untried);
            }
            if (!change_.light_came) continue;
            for (const auto& way : kept.ways_that_meet(*change_.light_came, now_, l, Share::blocked)) {
                change_share(way.node, l, way.meeting == Meeting::occluder ? Share::blocked : Share::untried);
            }
        }
    }

    // Takes lost nodes out. The others keep their order, so that children still come after their parents.
    void compact() {
        std::vector<std::uint32_t> index(tile_.nodes.size(), no_node);
        std::uint32_t count = 0;
        for (std::uint32_t i = 0; i < tile_.nodes.size(); ++i) {
            if (!lost_[i]) index[i] = count++;
        }
        const auto now_at = [&](std::uint32_t i) { return i == no_node ? no_node : index[i]; };
        const std::size_t lights = now_.lights.size(), groups = tile_.samples.empty() ? 0 : estimate_groups(now_);
        tile_.shares.resize(tile_.nodes.size() * lights, Share::untried);
        if (groups > 0) tile_.samples.resize(tile_.nodes.size()), tile_.estimates.resize(tile_.nodes.size() * groups);
        for (std::uint32_t i = 0; i < tile_.nodes.size(); ++i) {
            const std::uint32_t to = index[i];
            if (to == no_node) continue;
            Node& node = tile_.nodes[to] = tile_.nodes[i];
            node.parent = now_at(node.parent), node.reflected = now_at(node.reflected), node.refracted = now_at(node.refracted);
            std::copy_n(tile_.shares.begin() + static_cast<std::ptrdiff_t>(i * lights), lights, tile_.shares.begin() + static_cast<std::ptrdiff_t>(to * lights));
            if (groups == 0) continue;
            tile_.samples[to] = tile_.samples[i];
            std::copy_n(tile_.estimates.begin() + static_cast<std::ptrdiff_t>(i * groups), groups, tile_.estimates.begin() + static_cast<std::ptrdiff_t>(to * groups));
        }
        if (groups > 0) tile_.samples.resize(count), tile_.estimates.resize(count * groups);
        tile_.nodes.resize(count);
        tile_.shares.resize(count * lights);
        std::unordered_map<std::uint64_t, Rgb> filtered;
        for (const auto& [key, share] : tile_.filtered) {
            if (const std::uint32_t to = index[key / lights]; to != no_node) filtered.emplace(to * lights + key % lights, share);
        }
        tile_.filtered = std::move(filtered);
        std::unordered_map<std::uint32_t, std::uint32_t> straight;
        for (const auto& [parent, child] : tile_.straight) {
            if (index[parent] != no_node && index[child] != no_node) straight.emplace(index[parent], index[child]);
        }
        tile_.straight = std::move(straight);
        for (std::uint32_t& root : tile_.corners) root = now_at(root);
        std::erase_if(tile_.subpixel_roots, [&](const auto& entry) { return index[entry.second] == no_node; });
        for (auto& [key, root] : tile_.subpixel_roots) root = index[root];
        for (std::vector<Quad>* quads : {&tile_.quads, &tile_.quads_before}) {
            for (Quad& quad : *quads) {
                for (std::uint32_t& root : quad.corners) root = now_at(root);
            }
        }
        for (Pending& pending : tile_.pending) pending.parent = index[pending.parent];
    }

    // Influences by the weights as they are now: what falls below the threshold is hidden with all below it, what rises above it shows again.
    void weigh() {
        const scene::Settings& settings = now_.scene.settings;
        const std::size_t count = tile_.nodes.size();
        std::vector<Rgb> influence(count);
        std::vector<bool> unseen(count);
        for (std::size_t i = 0; i < count; ++i) {
            Node& node = tile_.nodes[i];
            if (node.parent == no_node) {
                influence[i] = node.weight;
                continue;
            }
            influence[i] = influence[node.parent] * node.weight;
            node.hidden = !(max_component(influence[i]) > settings.threshold) || node.depth > settings.depth;
            unseen[i] = node.hidden || unseen[node.parent];
        }
        for (Pending& p : tile_.pending) p.influence = unseen[p.parent] ? 0 : max_component(influence[p.parent] * p.weight);
    }

    Tile& tile_;
    const World &before_, &now_;
    const Change& change_;
    const bool watched_;
    const std::span<const Rgb> displayed_;
    std::vector<std::uint64_t> place_;  // by node: key of a root's point
    std::vector<std::uint8_t> lost_, spawn_again_, bends_;  // by node
    bool lost_roots_ = false, lost_any_ = false, spawns_again_ = false, weights_changed_ = false, touched_ = false, outdates_ = false;
};

// The tile without its trees; its picture stays until there is another.
void begin_anew(Tile& tile) {
    tile = without_trees(tile);
}

// Lights the nodes that wait for it.
void light_again(Tile& tile, const World& world) {
    const bool shadows = world.scene.settings.level >= scene::Level::shadows;
    Growth growth(world, tile, false);
    std::vector<std::uint32_t> chunk;
    for (std::uint32_t i = 0; i < tile.nodes.size();) {
        chunk.clear();
        for (; i < tile.nodes.size() && chunk.size() < chunk_size; ++i) {
            if (!tile.nodes[i].shadowed) chunk.push_back(i);
        }
        growth.light(chunk, shadows, accel::Coherence::coherent);
    }
}

}  // namespace

void revise(Tile& tile, const World& before, const World& now, const Change& change, bool watched, std::span<const Rgb> displayed) {
    if (!change.touches_trees()) return;
    if (change.anew || tile.nodes.empty()) return begin_anew(tile);
    if (change.lobes_only && !(change.lobes_bits & tile.materials) && !((change.resamples || change.outdates_samples) && is_sampled(tile))) return;
    Reviser(tile, before, now, change, watched, displayed).run();
}

void settle(Tile& tile, const World& world, std::span<const scene::Level> level_of_stage) {
    if (!std::exchange(tile.unsettled, false)) return;
    const scene::Settings& settings = world.scene.settings;
    const auto first_of = [&](scene::Level level) { return first_stage(level_of_stage, level); };
    const int shadows = first_of(scene::Level::shadows), reflections = first_of(scene::Level::reflections), edges = first_of(scene::Level::edges);
    const int first_round = first_of(settings.level > scene::Level::edges ? settings.level : scene::Level::soft);  // of samples
    const bool untried = std::exchange(tile.untried, false), resamples = std::exchange(tile.resamples, false);
    const bool sampled = is_sampled(tile);
    // The stages go on from a picture without samples, as they did at first; those that still hold come back with the first round.
    if (resamples) forget_samples(tile);
    else if (sampled) show_without_samples(tile);
    const auto is_missing = [](std::uint32_t root) { return root == no_node; };
    const auto shows = [&](const Pending& p) { return p.influence > settings.threshold; };

    int stage = static_cast<int>(level_of_stage.size());
    // Later stages begin with all nodes lit; where the picture has no shadows no stage lights what is there.
    tile.all_lit = tile.all_spawned = 0;
    if (tile.lit && (settings.level == scene::Level::visible || (tile.stage > shadows && !untried))) {
        light_again(tile, world);
        tile.all_lit = static_cast<std::uint32_t>(tile.nodes.size());
    } else {
        stage = std::min(stage, shadows);
    }
    if (tile.stage > reflections) tile.all_spawned = static_cast<std::uint32_t>(tile.nodes.size());
    if (std::any_of(tile.corners.begin(), tile.corners.end(), is_missing)) stage = std::min(stage, all_roots(settings));
    if (std::any_of(tile.pending.begin(), tile.pending.end(), shows)) stage = std::min(stage, reflections);
    tile.todo.clear();
    tile.cursor = 0;
    // Stopped amid splitting, or with some roots lost, splits cannot be looked through one by one.
    const bool complete = tile.stage == static_cast<int>(level_of_stage.size()) && tile.quads_before.empty();
    if (std::exchange(tile.split_anew, false) || !complete) unsplit(tile, settings);
    tile.stage = std::min({tile.stage, stage, edges, first_round});
    if (tile.stage == static_cast<int>(level_of_stage.size())) forget_picture(tile);
    const bool watched = tile.previewed_until > 0;
    if (watched) tile.previewed_until = stage <= shadows ? shadows + 1 : stage == reflections ? edges : 0;
    // Stale light is better than none, and than very noisy light.
    if (sampled && watched) tile.previewed_until = std::min(first_round + (resamples ? 2 : 1), static_cast<int>(level_of_stage.size()));
}

}  // namespace crescente::render
