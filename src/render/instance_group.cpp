#include "render/instance_group.h"

#include <algorithm>

#include "accel/box_hierarchy.h"

namespace crescente::render {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// At most this many boxes are held against every bundle.
constexpr std::size_t few = 16;

// Boxes that together hold all others: a cut through a hierarchy of them, the largest boxes opened first.
std::vector<Bounds> few_boxes(std::span<const Bounds> boxes) {
    if (boxes.size() <= few) return {boxes.begin(), boxes.end()};
    Bounds all;
    for (const Bounds& box : boxes) all.include(box);
    constexpr double largest = 1e100;  // that the hierarchy can take
    if (all.largest_coordinate() >= largest || std::any_of(boxes.begin(), boxes.end(), [](const Bounds& b) { return b.empty(); })) return {all};
    const accel::BoxHierarchy hierarchy = accel::build_box_hierarchy(boxes);
    std::vector<const accel::BoxNode*> cut{&hierarchy.nodes.front()};
    const auto size = [](const accel::BoxNode* node) { return node->leaf() ? -1.0 : max_component(node->box.diagonal()); };
    while (cut.size() < few) {
        const auto widest = std::max_element(cut.begin(), cut.end(), [&](const auto* a, const auto* b) { return size(a) < size(b); });
        if ((*widest)->leaf()) break;
        const accel::BoxNode* first = &hierarchy.nodes[(*widest)->first];
        *widest = first;
        cut.push_back(first + 1);
    }
    std::vector<Bounds> result;
    for (const accel::BoxNode* node : cut) result.push_back(node->box);
    return result;
}

}  // namespace

Bundle between(const Bounds& start, const Bounds& end) { return {start, end.lower - start.lower, end.upper - start.upper, 1}; }

Bundle toward(const Bounds& start, const Bounds& directions) { return {start, directions.lower, directions.upper, infinity}; }

bool may_pass(const Bounds& box, const Bundle& bundle) {
    constexpr double rounding = 1e-9;
    double from = 0, to = bundle.end;
    // Within the stretch where start + t way <= limit.
    const auto keep_below = [&](double start, double way, double limit) {
        if (way > 0) to = std::min(to, (limit - start) / way);
        else if (way < 0) from = std::max(from, (limit - start) / way);
        else if (start > limit) to = -1;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const double margin = rounding * (std::max(std::abs(bundle.start.lower[axis]), std::abs(bundle.start.upper[axis])) +
                                          std::max(std::abs(box.lower[axis]), std::abs(box.upper[axis])));
        keep_below(bundle.start.lower[axis], bundle.lower[axis], box.upper[axis] + margin);
        keep_below(-bundle.start.upper[axis], -bundle.upper[axis], margin - box.lower[axis]);
    }
    return !(from > to);  // boxes without an end give what compares with nothing
}

unsigned may_pass(const Bounds& box, const StretchLanes& stretches) {
    constexpr double rounding = 1e-9;
    const Vec3Lanes from = stretches.start - broadcast(box.center());
    const Vec3 half_box = box.diagonal() * 0.5;
    const Lanes margin = stretches.slack + rounding * (largest_component(stretches.start) + box.largest_coordinate());
    const Vec3Lanes extent = broadcast(half_box) + Vec3Lanes{margin, margin, margin};
    // Without an end is far enough for the whole box.
    const Lanes far = (absolute(from.x) + absolute(from.y) + absolute(from.z) + (extent.x + extent.y + extent.z)) / largest_component(stretches.way);
    const Vec3Lanes half = stretches.way * blend(stretches.endless, 0.5 * far, Lanes{} + 0.5);
    const Vec3Lanes middle = from + half;
    const Vec3Lanes size{absolute(half.x), absolute(half.y), absolute(half.z)};
    const Vec3Lanes turned = cross(middle, half);
    const LaneMask apart = (absolute(middle.x) > extent.x + size.x) | (absolute(middle.y) > extent.y + size.y) | (absolute(middle.z) > extent.z + size.z) |
                           (absolute(turned.x) > extent.y * size.z + extent.z * size.y) | (absolute(turned.y) > extent.x * size.z + extent.z * size.x) |
                           (absolute(turned.z) > extent.x * size.y + extent.y * size.x);
    return ~bits_of(apart) & ((1u << lane_count) - 1);
}

InstanceGroup::InstanceGroup(std::span<const Bounds> boxes, std::vector<accel::Instance> instances, std::unique_ptr<accel::Accelerator> alone)
    : boxes_(few_boxes(boxes)), instances_(std::move(instances)), alone_(std::move(alone)) {
    for (const Bounds& box : boxes_) box_.include(box);
}

bool InstanceGroup::may_meet(const Bundle& bundle) const {
    return std::any_of(boxes_.begin(), boxes_.end(), [&](const Bounds& box) { return may_pass(box, bundle); });
}

unsigned InstanceGroup::may_meet(const StretchLanes& stretches) const {
    constexpr unsigned all = (1u << lane_count) - 1;
    if (!box_.bounded()) return all;
    const unsigned near = may_pass(box_, stretches);
    if (!near || boxes_.size() == 1) return near;
    unsigned found = 0;
    for (std::size_t i = 0; i < boxes_.size() && found != near; ++i) found |= near & may_pass(boxes_[i], stretches);
    return found;
}

void InstanceGroup::meet(std::span<const geometry::Ray> rays, std::vector<Meeting>& meetings, accel::TestCounts& counts) const {
    meetings.assign(rays.size(), alone_ ? Meeting::nothing : Meeting::something);
    if (!alone_) return;
    std::vector<accel::Hit> hits(rays.size());
    alone_->nearest(rays, hits, accel::Coherence::coherent, counts);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (hits[i].found()) meetings[i] = Meeting::something;
    }
}

void InstanceGroup::meet_light(std::span<const geometry::Ray> rays, std::vector<Meeting>& meetings, accel::TestCounts& counts) const {
    meetings.assign(rays.size(), alone_ ? Meeting::nothing : Meeting::something);
    if (!alone_) return;
    std::vector<accel::Hit> occluders(rays.size());
    std::vector<accel::Crossing> crossings;
    alone_->shadow(rays, occluders, crossings, accel::Coherence::coherent, counts);
    for (const accel::Crossing& crossing : crossings) meetings[crossing.ray] = Meeting::something;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (occluders[i].found()) meetings[i] = Meeting::occluder;
    }
}

}  // namespace crescente::render
