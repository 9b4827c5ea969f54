// Corners of parts of pixels get their samples later than those of pixels; until then corners of the same surfaces beside them stand in. So a split pixel costs
// about as much as another, and its edges are smooth all the while.
#pragma once

#include <cstdint>
#include <vector>

#include "render/bsdf.h"
#include "render/forest.h"

namespace crescente::render {

// Whether two nodes met the same surface, and so did those of their rays that go on and are part of the picture: of the second node ways_of(node), a Smooth, says which.
template <class WaysOf>
bool see_the_same(const Tile& tile, std::uint32_t a, std::uint32_t b, WaysOf&& ways_of) {
    constexpr float least_cosine = 0.9f;
    const Node &one = tile.nodes[a], &other = tile.nodes[b];
    if (one.instance != other.instance) return false;
    if (one.left_scene()) return true;
    if (one.material != other.material || one.inside != other.inside) return false;
    if (one.normal[0] * other.normal[0] + one.normal[1] * other.normal[1] + one.normal[2] * other.normal[2] < least_cosine) return false;
    if (one.reflected == no_node && one.refracted == no_node && other.reflected == no_node && other.refracted == no_node) return true;
    const auto same = [&](std::uint32_t x, std::uint32_t y) {
        const auto is_seen = [&](std::uint32_t i) { return i != no_node && !tile.nodes[i].hidden; };
        return is_seen(x) == is_seen(y) && (!is_seen(x) || see_the_same(tile, x, y, ways_of));
    };
    const Smooth ways = ways_of(b);
    return (!ways.reflects || same(one.reflected, other.reflected)) && (!ways.refracts || same(one.refracted, other.refracted));
}

// Calls visit(root, corner) for each root on a surface that splitting a quad added, if it is asked for, and each corner of that quad that sees the same; all of
// larger quads first.
template <class IsAsked, class WaysOf, class Visit>
void for_each_stand_in(const Tile& tile, IsAsked&& is_asked, WaysOf&& ways_of, Visit&& visit) {
    for (const Quad& quad : tile.quads) {
        if (quad.parts == no_node) continue;
        const auto corner_of_part = [&](std::uint32_t part, std::uint32_t corner) { return tile.quads[quad.parts + part].corners[corner]; };
        for (const std::uint32_t root : {corner_of_part(0, 1), corner_of_part(0, 2), corner_of_part(0, 3), corner_of_part(1, 3), corner_of_part(2, 3)}) {
            if (root == no_node || !is_asked(root) || tile.nodes[root].left_scene()) continue;
            for (const std::uint32_t corner : quad.corners) {
                if (corner != no_node && see_the_same(tile, root, corner, ways_of)) visit(root, corner);
            }
        }
    }
}

// Of roots that have no samples yet, where some stand in for them: the mean of these, of their radiance as far as Tile::unsampled tells how much brighter a root is
// than they are, or of their share of what is behind the scene.
void let_stand_in(const Tile& tile, std::vector<Rgb>& radiances);
void let_stand_in(const Tile& tile, std::vector<float>& clearness);

}  // namespace crescente::render
