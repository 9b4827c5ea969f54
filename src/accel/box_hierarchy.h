// A binary hierarchy of boxes in double precision.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "math/bounds.h"

namespace crescente::accel {

struct BoxNode {
    math::Bounds box;
    std::uint32_t first = 0;  // leaf: its first place in BoxHierarchy::order; else its first child, the other one follows it
    std::uint32_t count = 0;  // leaf: how many places; else 0

    bool leaf() const { return count > 0; }
};

struct BoxHierarchy {
    // No path from the root is longer, so that a depth-first traversal never holds more than this many waiting nodes.
    static constexpr int max_depth = 96;

    std::vector<BoxNode> nodes;        // the root first; none if there are no boxes
    std::vector<std::uint32_t> order;  // indices of the boxes, leaf by leaf
};

// Groups boxes where the surface area heuristic expects the fewest tests (Wald 2007, "On fast Construction of SAH-based Bounding Volume
// Hierarchies": centroids in bins). The boxes must be neither empty nor unbounded, their coordinates below 1e100. At most 2^31 boxes.
// The same boxes give the same hierarchy.
BoxHierarchy build_box_hierarchy(std::span<const math::Bounds> boxes);

}  // namespace crescente::accel
