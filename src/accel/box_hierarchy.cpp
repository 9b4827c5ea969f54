#include "accel/box_hierarchy.h"

#include <algorithm>
#include <array>
#include <optional>

namespace crescente::accel {

using namespace math;

namespace {

constexpr int bin_count = 16;
constexpr std::size_t max_leaf = 4;
constexpr int max_sah_depth = 64;  // below it nodes are halved, which ends within 32 more levels
// Estimated costs; only their ratio matters. A part test includes the dispatch to its shape.
constexpr double box_cost = 1, part_cost = 2;

struct Item {
    Bounds box;
    std::uint32_t index;

    // Twice the centre, which serves as well as the centre.
    double position(int axis) const { return box.lower[axis] + box.upper[axis]; }
};

struct Extent {
    Bounds box, positions;
};

Extent extent_of(std::span<const Item> items) {
    Extent extent;
    for (const Item& item : items) {
        extent.box.include(item.box);
        extent.positions.include(item.box.lower + item.box.upper);
    }
    return extent;
}

double half_area(const Bounds& box) {
    const Vec3 d = box.diagonal();
    return d.x * d.y + d.y * d.z + d.z * d.x;
}

struct Binning {
    double origin, scale;

    Binning(const Bounds& positions, int axis)
        : origin(positions.lower[axis]), scale(bin_count * (1 - 1e-9) / (positions.upper[axis] - positions.lower[axis])) {}

    int bin(double position) const { return std::min(static_cast<int>((position - origin) * scale), bin_count - 1); }
};

struct Split {
    int axis, bin;  // items of this bin and above go to the second child
    double cost;    // of the items' tests, times the node's half area
};

struct Bin {
    Bounds box;
    std::size_t count = 0;

    void include(const Bin& other) { box.include(other.box), count += other.count; }
    double cost() const { return count > 0 ? half_area(box) * static_cast<double>(count) : 0; }
};

std::optional<Split> best_split(std::span<const Item> items, const Bounds& positions) {
    std::optional<Split> best;
    for (int axis = 0; axis < 3; ++axis) {
        const Binning binning(positions, axis);
        if (!(positions.diagonal()[axis] > 0) || !std::isfinite(binning.scale)) continue;
        std::array<Bin, bin_count> bins;
        for (const Item& item : items) bins[binning.bin(item.position(axis))].include({item.box, 1});

        std::array<Bin, bin_count> above;
        above[bin_count - 1] = bins[bin_count - 1];
        for (int i = bin_count - 2; i > 0; --i) {
            above[i] = above[i + 1];
            above[i].include(bins[i]);
        }
        Bin below;
        for (int i = 1; i < bin_count; ++i) {
            below.include(bins[i - 1]);
            if (below.count == 0 || above[i].count == 0) continue;
            const double cost = part_cost * (below.cost() + above[i].cost());
            if (!best || cost < best->cost) best = Split{axis, i, cost};
        }
    }
    return best;
}

// Where the items of the second child begin after reordering; none if the items are best left together.
std::optional<std::size_t> divide(std::span<Item> items, const Extent& extent, int depth) {
    if (depth < max_sah_depth) {
        const auto split = best_split(items, extent.positions);
        const double area = half_area(extent.box);
        const bool pays = split && split->cost + 2 * box_cost * area < part_cost * area * static_cast<double>(items.size());
        if (items.size() <= max_leaf && !pays) return std::nullopt;
        if (split) {
            const Binning binning(extent.positions, split->axis);
            const auto second = std::partition(items.begin(), items.end(), [&](const Item& item) {
                return binning.bin(item.position(split->axis)) < split->bin;
            });
            return static_cast<std::size_t>(second - items.begin());
        }
    }
    if (items.size() <= max_leaf) return std::nullopt;
    const Vec3 d = extent.positions.diagonal();
    const int axis = d.x >= d.y && d.x >= d.z ? 0 : d.y >= d.z ? 1 : 2;
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + half, items.end(),
                     [=](const Item& a, const Item& b) { return a.position(axis) < b.position(axis); });
    return half;
}

}  // namespace

BoxHierarchy build_box_hierarchy(std::span<const Bounds> boxes) {
    BoxHierarchy hierarchy;
    if (boxes.empty()) return hierarchy;
    std::vector<Item> items(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) items[i] = {boxes[i], static_cast<std::uint32_t>(i)};

    struct Work {
        std::uint32_t node;
        std::size_t begin, end;
        int depth;
    };
    std::vector<Work> waiting{{0, 0, items.size(), 0}};
    hierarchy.nodes.reserve(boxes.size());
    hierarchy.nodes.emplace_back();
    while (!waiting.empty()) {
        const Work work = waiting.back();
        waiting.pop_back();
        const std::span<Item> own = std::span(items).subspan(work.begin, work.end - work.begin);
        const Extent extent = extent_of(own);
        BoxNode& node = hierarchy.nodes[work.node];
        node.box = extent.box;
        if (const auto second = own.size() > 1 ? divide(own, extent, work.depth) : std::nullopt) {
            const auto child = static_cast<std::uint32_t>(hierarchy.nodes.size());
            node.first = child;
            hierarchy.nodes.resize(hierarchy.nodes.size() + 2);
            waiting.push_back({child + 1, work.begin + *second, work.end, work.depth + 1});
            waiting.push_back({child, work.begin, work.begin + *second, work.depth + 1});
        } else {
            node.first = static_cast<std::uint32_t>(work.begin);
            node.count = static_cast<std::uint32_t>(own.size());
        }
    }
    hierarchy.nodes.shrink_to_fit();
    hierarchy.order.reserve(items.size());
    for (const Item& item : items) hierarchy.order.push_back(item.index);
    return hierarchy;
}

}  // namespace crescente::accel
