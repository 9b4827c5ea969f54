#include "render/stand_ins.h"

#include <algorithm>

namespace crescente::render {
namespace {

// as_at(value, root, corner): what a corner's value would be at the root.
template <class T, class AsAt>
void let_stand_in(const Tile& tile, std::vector<T>& values, AsAt&& as_at) {
    const auto waits = [&](std::uint32_t root) { return root < tile.samples.size() && tile.samples[root] == 0; };
    const auto ways = [&](std::uint32_t i) { return Smooth{!tile.nodes[i].samples_reflection, !tile.nodes[i].samples_refraction}; };
    std::vector<std::uint8_t> stand_ins;  // how many; by node, as soon as there is one
    std::vector<T> sums;
    for_each_stand_in(tile, waits, ways, [&](std::uint32_t root, std::uint32_t corner) {
        if (!tile.nodes[corner].sampled && (stand_ins.empty() || stand_ins[corner] == 0)) return;
        if (stand_ins.empty()) stand_ins.resize(tile.nodes.size()), sums.resize(tile.nodes.size());
        sums[root] += as_at(values[corner], root, corner);
        values[root] = sums[root] * (1.0f / static_cast<float>(++stand_ins[root]));
    });
}

}  // namespace

void let_stand_in(const Tile& tile, std::vector<Rgb>& radiances) {
    // The classic light knows a surface's colour, its relief and what it mirrors, but not how much light arrives: of that it takes the ratio, within bounds.
    static constexpr float most = 4;
    const auto ratio = [](float a, float b) { return b > 0 ? std::clamp(a / b, 1 / most, most) : 1.0f; };
    const bool known = tile.unsampled.size() == tile.nodes.size();
    let_stand_in(tile, radiances, [&](Rgb value, std::uint32_t root, std::uint32_t corner) {
        if (!known) return value;
        const Rgb &here = tile.unsampled[root], &there = tile.unsampled[corner];
        return value * Rgb{ratio(here.r, there.r), ratio(here.g, there.g), ratio(here.b, there.b)};
    });
}

void let_stand_in(const Tile& tile, std::vector<float>& clearness) {
    let_stand_in(tile, clearness, [](float value, std::uint32_t, std::uint32_t) { return value; });
}

}  // namespace crescente::render
