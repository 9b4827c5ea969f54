// Rays of a tile's trees, tried again against instances that an edit brought or took: each as it was traced, to the bit, against these alone.
#pragma once

#include "render/forest.h"
#include "render/instance_group.h"
#include "render/world.h"

namespace crescente::render {

class KeptRays {
public:
    // Of nodes that are not `lost`, with their indices. `places`: keys of roots' points (key_of), by node.
    KeptRays(Tile& tile, std::span<const std::uint8_t> lost, std::span<const std::uint64_t> places) : tile_(tile), lost_(lost), places_(places) {}

    // Nodes whose rays, or those that lead to them, meet something of the group no later than where they ended. `world`: in which they were traced.
    std::vector<std::uint32_t> that_meet(const InstanceGroup& group, const World& world);

    // Lit nodes and what the ways of a light to them meet of the group; those that meet nothing are left out, and those whose share is `settled`, or not known.
    // `world`: one with the light in the place from which it was tried, shares and nodes laid out by its lights.
    struct MetWay {
        std::uint32_t node;
        Meeting meeting;
    };
    std::vector<MetWay> ways_that_meet(const InstanceGroup& group, const World& world, std::size_t light, Share settled);

private:
    struct LitLanes {  // eight nodes in a row, of which these are lit
        std::uint32_t first;
        unsigned lit;
        Vec3Lanes position;
        Lanes offset;
    };
    struct LitBlock {  // neighbours
        std::size_t first, end;  // of lit_
        Bounds starts;           // of the rays to lights
    };
    void find_lit();
    void count(std::size_t rays, const accel::TestCounts& tests);

    Tile& tile_;
    std::span<const std::uint8_t> lost_;
    std::span<const std::uint64_t> places_;
    std::vector<LitLanes> lit_;
    std::vector<LitBlock> blocks_;
    Bounds lit_starts_;
    bool lit_known_ = false;
};

}  // namespace crescente::render
