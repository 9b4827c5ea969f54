#include "render/light_hierarchy.h"

#include <algorithm>
#include <array>

namespace crescente::render {
namespace {

double angle_of(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

// The smallest cone about two.
void unite_cones(LightBounds& a, const LightBounds& b) {
    if (a.cos_spread <= -1) return;
    if (b.cos_spread <= -1) {
        a.axis = b.axis, a.cos_spread = -1;
        return;
    }
    const double spread_a = angle_of(a.cos_spread), spread_b = angle_of(b.cos_spread), between = angle_of(dot(a.axis, b.axis));
    if (std::min(between + spread_b, pi) <= spread_a) return;
    if (std::min(between + spread_a, pi) <= spread_b) {
        a.axis = b.axis, a.cos_spread = b.cos_spread;
        return;
    }
    const double spread = (spread_a + between + spread_b) / 2;
    Vec3 side = b.axis - a.axis * dot(a.axis, b.axis);
    if (spread >= pi || !(length(side) > 1e-12)) {
        a.cos_spread = -1;
        return;
    }
    side = normalize(side);
    const double turn = spread - spread_a;
    a.axis = normalize(a.axis * std::cos(turn) + side * std::sin(turn));
    // A little wider, so that rounding leaves nobody outside.
    a.cos_spread = std::max(-1.0, std::cos(spread) - 1e-9);
}

LightBounds unite(LightBounds a, const LightBounds& b) {
    if (b.power == 0) return a;  // which never shines
    if (a.power == 0) return b;
    a.box.include(b.box);
    unite_cones(a, b);
    a.two_sided = a.two_sided || b.two_sided;
    a.power += b.power;
    return a;
}

// cos(max(0, a - b)) of angles by their cosines and sines.
double cos_less(double cos_a, double sin_a, double cos_b, double sin_b) { return cos_a > cos_b ? 1 : cos_a * cos_b + sin_a * sin_b; }
double sin_less(double cos_a, double sin_a, double cos_b, double sin_b) { return cos_a > cos_b ? 0 : sin_a * cos_b - cos_a * sin_b; }
double sine_of(double cosine) { return std::sqrt(std::max(0.0, 1 - cosine * cosine)); }

// Bound on what the shapes may send to a point, up to a factor (section 3.3 of the paper; the receiver's side does not count, so that the chance of a
// shape is that of all directions from the point).
double importance(const LightBounds& b, Vec3 from) {
    if (b.power == 0) return 0;
    const Vec3 diagonal = b.box.diagonal(), path = from - b.box.center();
    const double radius2 = dot(diagonal, diagonal) / 4, distance2 = dot(path, path);
    const double received = b.power / std::max(distance2, radius2);
    if (distance2 <= radius2 || b.cos_spread <= -1) return received;  // among them, or they shine all around
    double cos_axis = dot(b.axis, path) / std::sqrt(distance2);
    if (b.two_sided) cos_axis = std::abs(cos_axis);
    const double sin_axis = sine_of(cos_axis), sin_spread = sine_of(b.cos_spread);
    const double cos_least = cos_less(cos_axis, sin_axis, b.cos_spread, sin_spread), sin_least = sin_less(cos_axis, sin_axis, b.cos_spread, sin_spread);
    const double sin_box = std::sqrt(radius2 / distance2);
    const double cosine = cos_less(cos_least, sin_least, sine_of(sin_box), sin_box);
    return cosine > 0 ? received * cosine : 0;
}

// How good a node is (section 3.2): power times what it may shine at, times surface.
double cost(const LightBounds& b, double largest_side, double side) {
    if (b.power == 0) return 0;
    const double spread = angle_of(b.cos_spread), widest = std::min(spread + pi / 2, pi), sine = std::sin(spread);
    const double solid = 2 * pi * (1 - b.cos_spread) +
                         pi / 2 * (2 * widest * sine - std::cos(spread - 2 * widest) - 2 * spread * sine + b.cos_spread);
    const Vec3 d = b.box.diagonal();
    return b.power * solid * (d.x * d.y + d.y * d.z + d.z * d.x) * largest_side / std::max(side, 1e-12 * largest_side);
}

}  // namespace

LightHierarchy::LightHierarchy(std::span<const LightBounds> members) : leaf_of_(members.size()) {
    if (members.empty()) return;
    std::vector<std::uint32_t> all(members.size());
    for (std::uint32_t i = 0; i < all.size(); ++i) all[i] = i;
    nodes_.reserve(2 * members.size());
    build(members, all, 0, 0);
}

std::uint32_t LightHierarchy::build(std::span<const LightBounds> members, std::span<std::uint32_t> some, std::uint32_t parent, int depth) {
    const auto here = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, parent, 0, 0});
    if (some.size() == 1) {
        nodes_[here].bounds = members[some[0]];
        nodes_[here].member = some[0];
        leaf_of_[some[0]] = here;
        return here;
    }
    Bounds centers;
    for (const std::uint32_t i : some) centers.include(members[i].box.center());
    const Vec3 extent = centers.diagonal();
    constexpr int bins = 12;
    const auto bin_of = [&](std::uint32_t i, int axis) {
        const double at = (members[i].box.center()[axis] - centers.lower[axis]) / extent[axis];
        return std::clamp(static_cast<int>(at * bins), 0, bins - 1);
    };
    double best = std::numeric_limits<double>::infinity();
    int best_axis = -1, best_bin = 0;
    constexpr int deepest = 64;  // below, members are only halved
    for (int axis = 0; axis < 3 && depth < deepest; ++axis) {
        if (!(extent[axis] > 0)) continue;
        std::array<LightBounds, bins> in{};
        for (const std::uint32_t i : some) {
            LightBounds& bin = in[static_cast<std::size_t>(bin_of(i, axis))];
            bin = unite(bin, members[i]);
        }
        for (int split = 1; split < bins; ++split) {
            LightBounds below, above;
            for (int k = 0; k < bins; ++k) (k < split ? below : above) = unite(k < split ? below : above, in[static_cast<std::size_t>(k)]);
            const double sum = cost(below, max_component(extent), extent[axis]) + cost(above, max_component(extent), extent[axis]);
            if (below.power > 0 && above.power > 0 && sum < best) best = sum, best_axis = axis, best_bin = split;
        }
    }
    auto middle = some.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
    if (best_axis >= 0) middle = std::stable_partition(some.begin(), some.end(), [&](std::uint32_t i) { return bin_of(i, best_axis) < best_bin; });
    build(members, {some.begin(), middle}, here, depth + 1);
    const std::uint32_t second = build(members, {middle, some.end()}, here, depth + 1);
    nodes_[here].second = second;
    nodes_[here].bounds = unite(nodes_[here + 1].bounds, nodes_[second].bounds);
    return here;
}

// Of the second child rather than the first; negative if neither can shine on the point.
double LightHierarchy::chance_of_second(std::uint32_t node, Vec3 from) const {
    const double first = importance(nodes_[node + 1].bounds, from), second = importance(nodes_[nodes_[node].second].bounds, from);
    return first + second > 0 ? second / (first + second) : -1;
}

std::optional<LightHierarchy::Choice> LightHierarchy::choose(Vec3 from, double u) const {
    constexpr double below_one = 1 - 0x1p-53;
    if (nodes_.empty() || importance(nodes_[0].bounds, from) == 0) return std::nullopt;
    std::uint32_t node = 0;
    double chance = 1;
    while (nodes_[node].second != 0) {
        const double second = chance_of_second(node, from);
        if (second < 0) return std::nullopt;
        const bool takes_first = u < 1 - second;
        const double share = takes_first ? 1 - second : second;
        u = std::clamp((takes_first ? u : u - (1 - second)) / share, 0.0, below_one);
        chance *= share;
        node = takes_first ? node + 1 : nodes_[node].second;
    }
    return Choice{nodes_[node].member, chance};
}

// By slabs (Kay and Kajiya 1986), of a box that is a little larger: what shines may be flat.
bool LightHierarchy::may_meet(const Bounds& box, const geometry::Ray& ray) {
    const double room = 1e-9 * (box.largest_coordinate() + max_component(abs(ray.origin)));
    double enter = ray.t_min, leave = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const double lower = box.lower[axis] - room - ray.origin[axis], upper = box.upper[axis] + room - ray.origin[axis], slope = ray.direction[axis];
        if (slope == 0) {
            if (lower > 0 || upper < 0) return false;
            continue;
        }
        const double a = lower / slope, b = upper / slope;
        enter = std::max(enter, std::min(a, b)), leave = std::min(leave, std::max(a, b));
    }
    return enter <= leave * (1 + 1e-9);
}

double LightHierarchy::chance(std::uint32_t member, Vec3 from) const {
    if (nodes_.empty() || importance(nodes_[0].bounds, from) == 0) return 0;
    // In the order of choose(), from the leaf up: the product is the same but for rounding.
    double chance = 1;
    for (std::uint32_t node = leaf_of_[member]; node != 0; node = nodes_[node].parent) {
        const std::uint32_t parent = nodes_[node].parent;
        const double second = chance_of_second(parent, from);
        if (second < 0) return 0;
        chance *= node == parent + 1 ? 1 - second : second;
    }
    return chance;
}

}  // namespace crescente::render
