#include "render/scheduler.h"

#include <algorithm>

namespace crescente::render {

std::vector<Work> next_work(std::span<const TileState> tiles, const Plan& plan) {
    std::vector<Work> work;
    const std::size_t most = plan.batch ? plan.batch : tiles.size();
    const std::size_t most_to_end = plan.batch ? plan.threads : tiles.size();
    for (std::uint32_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i].under_way) work.push_back({i, plan.stages});
    }
    if (!work.empty()) return work;
    const auto nearest = [&](std::size_t count) {
        std::stable_sort(work.begin(), work.end(), [&](const Work& a, const Work& b) { return tiles[a.tile].distance < tiles[b.tile].distance; });
        work.resize(std::min(work.size(), count));
        return work;
    };
    const auto kept = [](const TileState& t) { return t.stage == t.shown_stage; };
    int lowest = plan.stages, lowest_looked_at = plan.stages;
    for (const TileState& t : tiles) {
        if (!kept(t)) continue;
        lowest = std::min(lowest, t.stage);
        if (t.distance == 0) lowest_looked_at = std::min(lowest_looked_at, t.stage);
    }
    const bool looked_at_only = lowest > 0 && lowest_looked_at < plan.stages;
    const int stage = looked_at_only ? lowest_looked_at : lowest;
    const int until = plan.even || stage == 0 ? stage + 1 : plan.stages;
    for (std::uint32_t i = 0; stage < plan.stages && i < tiles.size(); ++i) {
        if (kept(tiles[i]) && tiles[i].stage == stage && !(looked_at_only && tiles[i].distance > 0)) work.push_back({i, until});
    }
    if (!work.empty()) return nearest(until == plan.stages ? most_to_end : most);
    for (std::uint32_t i = 0; i < tiles.size(); ++i) {
        if (tiles[i].shown_stage < plan.stages) work.push_back({i, plan.stages});
    }
    return nearest(most_to_end);
}

std::vector<std::uint32_t> tiles_to_drop(std::span<const TileState> tiles, int stages, std::uint64_t ceiling, std::uint64_t floor) {
    std::uint64_t total = 0;
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < tiles.size(); ++i) {
        total += tiles[i].bytes;
        if (tiles[i].stage > 0 && !tiles[i].under_way) order.push_back(i);
    }
    std::vector<std::uint32_t> drop;
    if (total <= ceiling) return drop;
    const auto rank = [&](std::uint32_t i) { return tiles[i].stage >= stages ? 0 : 1 + tiles[i].stage; };
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return rank(a) != rank(b) ? rank(a) < rank(b) : a > b; });
    for (const std::uint32_t i : order) {
        if (total <= ceiling) break;
        if (tiles[i].bytes <= floor) continue;
        total -= tiles[i].bytes - floor;
        drop.push_back(i);
    }
    return drop;
}

}  // namespace crescente::render
