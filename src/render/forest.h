// The forest of rays of one tile: every ray tree that its pixels' corners grew, kept. A tile with its trees is the unit of work, of
// memory and of distribution; it depends on no other tile (it repeats the corners on its border).
//
// Related work that kept rays: Séquin and Smyrl 1989, "Parameterized Ray Tracing"; Brière and Poulin 1996, "Hierarchical
// View-dependent Structures for Interactive Scene Manipulation"; Bala, Dorsey and Teller 1999, "Radiance Interpolants".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "math/color.h"
#include "math/vec.h"
#include "render/counts.h"
#include "render/estimates.h"
#include "scene/settings.h"

namespace crescente::render {

using namespace math;

inline constexpr std::uint32_t no_node = 0xffffffff;

// Where a ray ended, and what the light does there.
struct Node {
    Vec3 position;                   // the hit; for a ray that left the scene, its direction
    std::array<float, 3> normal{};   // shading normal on the side of the viewer
    std::uint32_t geometric_normal = 0;  // on the side of the viewer, octahedral
    float offset = 0;                // how far from position, along the geometric normal, rays may start without meeting the surface again
    std::uint32_t instance = no_node;    // no_node: the ray left the scene
    std::uint32_t primitive = 0;
    std::uint32_t material = 0;      // index of lobes
    std::uint32_t parent = no_node;  // no_node: the root, ended by a camera ray
    std::uint32_t reflected = no_node, refracted = no_node;  // children, after this node in the tile; rare third ones: Tile::straight
    Rgb weight{1, 1, 1};             // of this node's radiance in the parent's; of a root's in its pixel
    Rgb local;                       // radiance towards the viewer, without the children
    std::uint8_t depth = 0;          // bounces
    bool inside : 1 = false;         // met from inside
    bool crossed : 1 = false;        // the ray came through the parent's surface, not back from it
    bool shadowed : 1 = false;       // lights have been tried, and local counts them
    bool spawned : 1 = false;        // its rays are children or in Tile::pending
    bool sampled : 1 = false;        // `local` counts what the samples say, instead of what levels that do not sample make up
    bool samples_reflection : 1 = false, samples_refraction : 1 = false;  // then these rays stand for rough lobes, and are no part of the picture
    bool hidden : 1 = false;         // kept, but below the threshold or the depth bound since an edit: no part of the picture
    std::uint16_t clear : 15 = 0;    // share of what is behind the scene that is seen here, in 32767ths, where the picture keeps it apart (alpha)
    std::uint16_t outdated : 1 = 0;  // its samples are of before an edit: shown until all others have theirs, and never in a finished picture

    bool left_scene() const { return instance == no_node; }
};
static_assert(sizeof(Node) == 96);

// How a light's way to a node fared; one byte for each node and light.
enum class Share : std::uint8_t {
    untried,   // counts as clear: level 0 lights without shadows
    behind,    // the light does not reach the surface's side: no ray
    blocked,
    clear,
    filtered,  // the RGB share is in Tile::filtered
};

inline constexpr std::uint16_t all_clear = 32767;  // Node::clear where nothing is in front of what is behind the scene

constexpr bool may_arrive(Share share) { return share != Share::behind && share != Share::blocked; }

// How a ray goes on from a surface.
enum class Way : std::uint8_t {
    reflected,
    refracted,
    straight,  // past the coverage of a surface that also refracts
};

// A ray that may still be grown.
struct Pending {
    std::uint32_t parent;
    Rgb weight;
    float influence;  // largest component, at the pixel
    Way way;
};

// A pixel, or a part of one, with its corners: top left, top right, bottom left, bottom right (roots). Split ones have four parts in
// the same order.
struct Quad {
    std::array<std::uint32_t, 4> corners;
    std::uint32_t parts = no_node;  // index of the first of four
};

struct Tile {
    int x0 = 0, y0 = 0, width = 0, height = 0;  // pixels of the picture

    std::vector<Node> nodes;
    std::vector<Share> shares;                             // lights of node i from i * lights
    std::unordered_map<std::uint64_t, Rgb> filtered;       // by node * lights + light
    std::unordered_map<std::uint32_t, std::uint32_t> straight;  // children that rays past a node's coverage ended at, by node
    std::vector<std::uint16_t> samples;                    // of each node; empty until a level samples
    std::vector<Estimate> estimates;                       // what they say, groups of node i from i * estimate_groups()
    std::vector<std::uint16_t> lens_samples;               // of each pixel of level_lens.h, where the picture is taken through a lens; the nodes then have none
    std::vector<Estimate> lens_estimates;                  // what they say, columns of pixel i from i * LensColumns::count()
    std::vector<Rgb> lens_pixels;                          // what the picture shows of them; empty: it shows the trees
    std::vector<float> lens_clear;                         // with those, as clear_pixels; empty: the picture keeps no alpha
    std::vector<Rgb> unsampled;                            // radiances() before the first sample; only while corners wait for theirs (stand_ins.h)
    std::vector<std::uint32_t> corners;                    // roots of the (width + 1) x (height + 1) pixel corners
    std::vector<Pending> pending;
    std::vector<Pending> growing;                          // of new corners inside pixels, while they are grown to the end
    std::vector<Quad> quads;                               // the first width x height are the pixels; empty before the first split
    std::vector<Quad> quads_before;                        // those of the picture before an edit, shown until the new ones are complete
    std::unordered_map<std::uint64_t, std::uint32_t> subpixel_roots;  // by lattice point; only while pixels are split

    int stage = 0;           // stages of growth that are complete
    std::size_t cursor = 0;  // work of the next stage that is done
    std::vector<std::uint32_t> todo;  // what the next stage works through: its meaning is the stage's
    std::vector<Rgb> pixels;  // what the trees gave at an earlier time: before they were dropped, left unlit or edited
    std::vector<float> clear_pixels;  // with those: what clearness() says of the pixels; empty: nothing behind the scene is seen in any
    int pixels_stage = -1;    // stages that were complete then; -1: never
    int previewed_until = 0;  // before this stage only pixels whose corners were all grown since an edit are shown by their trees, the others by `pixels`
    std::uint32_t kept = 0;   // with that: nodes that the edit left; those after them were grown since
    bool going_on = false;    // dropped before it was finished, and being grown anew to the end
    bool lit = true;          // false: some nodes wait for their light
    std::uint32_t all_lit = 0, all_spawned = 0;  // nodes, the first ones, that after an edit are known to be lit, or to have sent their rays

    bool keeps_clear = false;     // some node may show what is behind the scene: Node::clear
    std::uint64_t materials = 0;  // bit i: some node may be of a material whose index is i modulo 64
    std::uint64_t revision = 0;  // edits of the session that the trees know
    std::uint64_t changed = 0;   // when its picture last did, by the session's clock
    bool unsettled = false;      // an edit touched the trees, and what is missing in them has not been looked for
    bool untried = false;        // with that: ways of lights to nodes are not known any more
    bool lens_piloted = false;   // the pilots of all pixels are complete: their spread holds
    std::size_t forgotten = 0;   // times that a pixel's parts were given up: their roots are still among the nodes
    bool resamples = false;      // with that: samples do not hold any more
    bool split_anew = false;     // with that: splits of pixels are not known any more, or asked for otherwise

    RayCounts rays;
    TestCounts tests;

    std::size_t bytes() const;         // allocated
    std::size_t filled_bytes() const;  // in use: about what is left after trim()
    void trim();                       // gives back what was allocated in reserve, if it is much
    bool shows_pixels() const { return pixels_stage > stage || !lit; }
    int shown_stage() const { return shows_pixels() ? pixels_stage : stage; }
    std::uint32_t& corner(int x, int y) { return corners[static_cast<std::size_t>(y) * (width + 1) + x]; }
    std::uint32_t corner(int x, int y) const { return corners[static_cast<std::size_t>(y) * (width + 1) + x]; }
};

// Empties a container and gives its memory back, which `= {}` does not.
template <class Container>
void release(Container& container) {
    container = Container();
}

// Calls visit(child, way) for the children of a node that are not hidden, in the order in which their light is added.
template <class Visit>
void for_each_child(const Tile& tile, std::uint32_t node, Visit&& visit) {
    const Node& parent = tile.nodes[node];
    if (parent.reflected != no_node && !parent.samples_reflection && !tile.nodes[parent.reflected].hidden) visit(parent.reflected, Way::reflected);
    if (parent.refracted != no_node && !parent.samples_refraction && !tile.nodes[parent.refracted].hidden) visit(parent.refracted, Way::refracted);
    if (tile.straight.empty()) return;
    const auto child = tile.straight.find(node);
    if (child != tile.straight.end() && !tile.nodes[child->second].hidden) visit(child->second, Way::straight);
}

// Radiance of a node with its children, whose own radiance_of_child(child) gives; of a root as it arrives at the camera, which may be in a medium. `correction`:
// added to its own.
template <class RadianceOfChild>
Rgb radiance_above(const Tile& tile, std::uint32_t node, RadianceOfChild&& radiance_of_child, Rgb correction = {}) {
    Rgb sum = tile.nodes[node].local + correction;
    for_each_child(tile, node, [&](std::uint32_t child, Way) { sum += tile.nodes[child].weight * radiance_of_child(child); });
    return tile.nodes[node].parent == no_node ? sum * tile.nodes[node].weight : sum;
}

// Takes the light of samples out of the nodes, which are to be lit again. What the samples told is kept, or forgotten too.
void show_without_samples(Tile& tile);
void forget_samples(Tile& tile);
void forget_samples(Tile& tile, std::uint32_t node);  // of one

// How often pixels are split where a root is a corner. Of a node that is no corner, or is one only of parts that are no more: none.
struct SplitDepth {
    static constexpr std::uint8_t none = 0xff;
    std::uint8_t place = none;  // 0: a corner of pixels; 1: of their quarters; and so on. The same in every tile that has it
    std::uint8_t parts = none;  // the largest that it is a corner of in this tile
};
std::vector<SplitDepth> split_depths(const Tile& tile);  // by node; empty: no pixel is split
inline SplitDepth split_depth(const std::vector<SplitDepth>& depths, std::uint32_t root) { return depths.empty() ? SplitDepth{0, 0} : depths[root]; }

// The tiles of a picture, row by row, for which nothing was done yet.
std::vector<Tile> cut_tiles(const scene::Settings& settings);

// A tile of the same pixels that nothing was done for yet; it knows the same edits.
Tile blank_tile(const Tile& place);

// The product of the weights from the pixel down to the node, taken in this order.
Rgb influence(const Tile& tile, std::uint32_t node);

// By node, what is added to its own radiance, and to its share of what is behind the scene where the picture keeps that apart. Empty: nothing.
struct Corrections {
    std::vector<Rgb> radiance;
    std::vector<float> clear;
};

// Radiance of every node with its children, by node: what the trees say now. Roots: as it arrives at the camera.
std::vector<Rgb> radiances(const Tile& tile, const Corrections& corrections = {});

// The same for the nodes that came since `known` was made, to which it is appended; nothing else changed since, and no node got another child.
void append_radiances(const Tile& tile, std::vector<Rgb>& known);

// Share of what is behind the scene that is seen in every node, by node. Empty: none in any.
std::vector<float> clearness(const Tile& tile, const Corrections& corrections = {});

}  // namespace crescente::render
