#include "render/tile_archive.h"

#include <algorithm>
#include <bit>

#include "base/byte_archive.h"
#include "render/counts_archive.h"
#include "render/growth.h"

namespace crescente::render {
namespace {

static_assert(std::endian::native == std::endian::little, "the bytes of numbers go into the file as they are");

// A node without the bits that nobody has set.
struct NodeRecord {
    Vec3 position;
    std::array<float, 3> normal;
    std::uint32_t geometric_normal;
    float offset;
    std::uint32_t instance, primitive, material, parent, reflected, refracted;
    Rgb weight, local;
    std::uint8_t depth, flags;
    std::uint16_t clear;  // and the bit for outdated
};
static_assert(sizeof(NodeRecord) == 96);

NodeRecord record_of(const Node& n) {
    const int flags = n.inside | n.crossed << 1 | n.shadowed << 2 | n.spawned << 3 | n.hidden << 4 | n.sampled << 5 | n.samples_reflection << 6 | n.samples_refraction << 7;
    return {n.position, n.normal, n.geometric_normal, n.offset, n.instance, n.primitive, n.material, n.parent, n.reflected, n.refracted, n.weight, n.local,
            n.depth, static_cast<std::uint8_t>(flags), static_cast<std::uint16_t>(n.clear | n.outdated << 15)};
}
Node node_of(const NodeRecord& r) {
    Node n;
    n.position = r.position, n.normal = r.normal, n.geometric_normal = r.geometric_normal, n.offset = r.offset;
    n.instance = r.instance, n.primitive = r.primitive, n.material = r.material;
    n.parent = r.parent, n.reflected = r.reflected, n.refracted = r.refracted, n.weight = r.weight, n.local = r.local, n.depth = r.depth, n.clear = r.clear & all_clear;
    n.inside = r.flags & 1, n.crossed = r.flags >> 1 & 1, n.shadowed = r.flags >> 2 & 1, n.spawned = r.flags >> 3 & 1, n.hidden = r.flags >> 4 & 1;
    n.sampled = r.flags >> 5 & 1, n.samples_reflection = r.flags >> 6 & 1, n.samples_refraction = r.flags >> 7 & 1, n.outdated = r.clear >> 15;
    return n;
}

struct PendingRecord {
    std::uint32_t parent;
    Rgb weight;
    float influence;
    std::uint32_t way;
};

template <class Archive>
void nodes(Archive& a, std::vector<Node>& v) {
    list(a, v, sizeof(NodeRecord), [&](Node& node) {
        NodeRecord record = record_of(node);
        value(a, record);
        node = node_of(record);
    });
}
template <class Archive>
void rays(Archive& a, std::vector<Pending>& v) {
    list(a, v, sizeof(PendingRecord), [&](Pending& p) {
        PendingRecord record{p.parent, p.weight, p.influence, static_cast<std::uint32_t>(p.way)};
        value(a, record);
        if (record.way > static_cast<std::uint32_t>(Way::straight)) return a.fail();
        p = {record.parent, record.weight, record.influence, static_cast<Way>(record.way)};
    });
}
// In the order of its keys, so that the same tile gives the same bytes. Nothing that is read gets into the map before all keys ascend and are such as a tile
// can have: numbers are their own hash, and many that fall into one bucket would take for ever.
template <class Archive, class Key, class Value, class IsKey>
void map(Archive& a, std::unordered_map<Key, Value>& v, IsKey&& is_key) {
    std::vector<std::pair<Key, Value>> entries(v.begin(), v.end());
    std::sort(entries.begin(), entries.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
    list(a, entries, sizeof(Key) + sizeof(Value), [&](auto& entry) { value(a, entry.first), value(a, entry.second); });
    if constexpr (std::is_same_v<Archive, ByteReader>) {
        const auto ascend_not = [](const auto& x, const auto& y) { return x.first >= y.first; };
        if (std::adjacent_find(entries.begin(), entries.end(), ascend_not) != entries.end()) a.fail();
        if (!std::all_of(entries.begin(), entries.end(), [&](const auto& entry) { return is_key(entry.first); })) a.fail();
        if (a.good()) v = {entries.begin(), entries.end()};
    }
}

bool is_within(LatticePoint p, const Tile& tile) {
    const auto along = [](std::uint32_t at, int first, int extent) {
        return at >= static_cast<std::uint32_t>(first) << subpixel_bits && at <= static_cast<std::uint32_t>(first + extent) << subpixel_bits;
    };
    return along(p.x, tile.x0, tile.width) && along(p.y, tile.y0, tile.height);
}

template <class Archive>
void columns(Archive& a, Tile& tile) {
    // Every member, so that a new one cannot be forgotten here: it is to be written, checked (tile_check.cpp) and makes another checkpoint_version. Previews
    // are not written: a session that goes on shows what the trees say.
    [[maybe_unused]] auto& [x0, y0, width, height, all_nodes, shares, filtered, straight, samples, estimates, lens_samples, lens_estimates, lens_pixels, lens_clear, unsampled, corners, pending, growing, quads, quads_before, subpixel_roots, stage,
                            cursor, todo, pixels, clear_pixels, pixels_stage, previewed_until, kept, going_on, lit, all_lit, all_spawned, keeps_clear, materials, revision, changed,
                            unsettled, untried, lens_piloted, forgotten, resamples, split_anew, ray_counts, test_counts] = tile;
    nodes(a, all_nodes);
    array(a, shares);
    map(a, filtered, [&](std::uint64_t key) { return key < tile.shares.size(); });
    map(a, straight, [&](std::uint32_t key) { return key < tile.nodes.size(); });
    array(a, samples), array(a, estimates);
    array(a, lens_samples), array(a, lens_estimates), array(a, lens_pixels), array(a, lens_clear);
    array(a, corners);
    rays(a, pending), rays(a, growing);
    array(a, quads), array(a, quads_before);
    map(a, subpixel_roots, [&](std::uint64_t key) { return is_within(point_of(key), tile); });
    value(a, stage), value(a, cursor);
    array(a, todo);
    array(a, pixels), array(a, clear_pixels);
    value(a, pixels_stage);
    value(a, going_on), value(a, lit), value(a, untried), value(a, resamples), value(a, split_anew), value(a, lens_piloted);
    value(a, forgotten);
    counts(a, ray_counts), counts(a, test_counts);
}

}  // namespace

void append_tile(Tile& tile, std::string& bytes) {
    ByteWriter writer{std::move(bytes)};
    columns(writer, tile);
    bytes = std::move(writer.bytes);
}

std::optional<Tile> tile_of(std::string_view bytes, const Tile& place) {
    Tile tile = blank_tile(place);
    ByteReader reader{bytes};
    columns(reader, tile);
    if (!reader.good() || !reader.bytes.empty()) return std::nullopt;
    return tile;
}

}  // namespace crescente::render
