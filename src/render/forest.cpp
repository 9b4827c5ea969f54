#include "render/forest.h"

namespace crescente::render {

std::size_t Tile::bytes() const {
    // Hash maps: a node with its link, and a bucket, for each entry.
    const auto map_bytes = [](const auto& map) {
        using Value = typename std::remove_cvref_t<decltype(map)>::value_type;
        return map.size() * (sizeof(Value) + sizeof(void*)) + map.bucket_count() * sizeof(void*);
    };
    return nodes.capacity() * sizeof(Node) + shares.capacity() * sizeof(Share) + corners.capacity() * sizeof(std::uint32_t) +
           pending.capacity() * sizeof(Pending) + quads.capacity() * sizeof(Quad) + todo.capacity() * sizeof(std::uint32_t) +
           pixels.capacity() * sizeof(Rgb) + map_bytes(filtered) + map_bytes(subpixel_roots);
}

Rgb influence(const Tile& tile, std::uint32_t node) {
    Rgb product{1, 1, 1};
    for (std::uint32_t i = node; i != no_node; i = tile.nodes[i].parent) product *= tile.nodes[i].weight;
    return product;
}

std::vector<Rgb> radiances(const Tile& tile) {
    std::vector<Rgb> result(tile.nodes.size());
    for (std::size_t i = tile.nodes.size(); i-- > 0;) {
        const Node& node = tile.nodes[i];
        Rgb sum = node.local;
        if (node.reflected != no_node) sum += tile.nodes[node.reflected].weight * result[node.reflected];
        if (node.refracted != no_node) sum += tile.nodes[node.refracted].weight * result[node.refracted];
        result[i] = sum;
    }
    return result;
}

}  // namespace crescente::render
