// Chooses one of many luminous shapes by how much it may shine on a point: a hierarchy of boxes with cones of normals (Conty Estevez and Kulla 2018,
// "Importance Sampling of Many Lights with Adaptive Tree Splitting"; without the splitting, as in pbrt-v4, 12.6.3).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/ray.h"
#include "math/bounds.h"

namespace crescente::render {

using namespace math;

// Where a shape, or a group of them, is and shines: to the half spaces of normals within an angle of an axis.
struct LightBounds {
    Bounds box;
    Vec3 axis{0, 0, 1};      // unit
    double cos_spread = -1;  // of the angle between the axis and the furthest normal; -1: all directions
    bool two_sided = false;
    double power = 0;
};

class LightHierarchy {
public:
    LightHierarchy() = default;
    explicit LightHierarchy(std::span<const LightBounds> members);

    struct Choice {
        std::uint32_t member;
        double chance;
    };
    // For u in [0, 1). None if no member can shine on the point.
    std::optional<Choice> choose(Vec3 from, double u) const;

    // With which choose(from) takes a member.
    double chance(std::uint32_t member, Vec3 from) const;

    // Calls visit(member) for all whose boxes a ray may meet within its bounds, and maybe some more, in an order of the hierarchy alone.
    template <class Visit>
    void for_each_on(const geometry::Ray& ray, Visit&& visit) const {
        if (nodes_.empty()) return;
        std::array<std::uint32_t, 2 * 64> open;  // deeper than any hierarchy: beyond 64 it is halved
        std::size_t count = 0;
        open[count++] = 0;
        while (count > 0) {
            const std::uint32_t i = open[--count];
            const Node& node = nodes_[i];
            if (!may_meet(node.bounds.box, ray)) continue;
            if (node.second == 0) {
                visit(node.member);
                continue;
            }
            open[count++] = node.second, open[count++] = i + 1;
        }
    }

private:
    struct Node {
        LightBounds bounds;
        std::uint32_t parent = 0;
        std::uint32_t second = 0;  // child; the first follows the node. 0: a leaf
        std::uint32_t member = 0;  // of a leaf
    };
    static bool may_meet(const Bounds& box, const geometry::Ray& ray);
    std::uint32_t build(std::span<const LightBounds> members, std::span<std::uint32_t> some, std::uint32_t parent, int depth);
    double chance_of_second(std::uint32_t node, Vec3 from) const;

    std::vector<Node> nodes_;             // children after parents
    std::vector<std::uint32_t> leaf_of_;  // by member; 0 is a leaf only where it is all there is
};

}  // namespace crescente::render
