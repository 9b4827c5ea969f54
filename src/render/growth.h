// Growing the trees of a tile: camera rays become roots, nodes get their light, pending rays become children. All levels of realism are made of
// these steps. What they compute depends on the tile alone, so the order of tiles, threads and interruptions never shows.
#pragma once

#include <span>

#include "math/octahedral.h"
#include "render/classic_view.h"
#include "render/deadline.h"
#include "render/forest.h"
#include "render/physical_view.h"
#include "render/surface_lobes.h"
#include "render/world.h"

namespace crescente::render {

// A point of the picture in fractions of a pixel: pixel corner (i, j) is (i << subpixel_bits, j << subpixel_bits).
struct LatticePoint {
    std::uint32_t x, y;
};
inline constexpr int subpixel_bits = 6;  // more than the most splits that the settings allow
inline constexpr double pixels_per_step = 1.0 / (1 << subpixel_bits);

// What Tile::subpixel_roots goes by.
constexpr std::uint64_t key_of(LatticePoint p) { return std::uint64_t{p.y} << 32 | p.x; }
constexpr LatticePoint point_of(std::uint64_t key) { return {static_cast<std::uint32_t>(key), static_cast<std::uint32_t>(key >> 32)}; }

// Of a pixel corner, by its coordinates in the picture.
constexpr LatticePoint corner_point(int x, int y) { return {static_cast<std::uint32_t>(x) << subpixel_bits, static_cast<std::uint32_t>(y) << subpixel_bits}; }

inline geometry::Ray camera_ray(const World& world, LatticePoint point) {
    return world.camera.through(point.x * pixels_per_step, point.y * pixels_per_step);
}

// Work is cut into chunks of this many rays, between which a deadline is looked at.
inline constexpr std::size_t chunk_size = 256;

class Growth {
public:
    // unseen: nobody looks at the tile before its shadows are done, so light without shadows need not be computed.
    Growth(const World& world, Tile& tile, bool unseen) : world_(world), settings_(world.scene.settings), tile_(tile), unseen_(unseen) {}

    const World& world() const { return world_; }
    const scene::Settings& settings() const { return settings_; }
    Tile& tile() { return tile_; }
    bool unseen() const { return unseen_; }

    // Traces camera rays and appends their roots, in order, without light. Returns the index of the first. `tried_first`, if not
    // empty, lists for each point four roots whose objects are tried first (coherent sub-pixel rays).
    std::uint32_t add_roots(std::span<const LatticePoint> points, std::span<const std::array<std::uint32_t, 4>> tried_first = {});

    // Computes the local light of nodes; with shadows, the ways of lights to them that are not yet known are traced first. lobes: by node, if the caller has them.
    void light(std::span<const std::uint32_t> nodes, bool shadows, accel::Coherence coherence, std::span<const Lobes* const> lobes = {});

    // Appends to `pending` the rays that nodes spawn, if the depth bound lets them. Node after node, in the order of Way.
    void spawn(std::span<const std::uint32_t> nodes, std::vector<Pending>& pending);

    // Both for nodes that are new; with shadows, if the picture is to have any.
    void light_and_spawn(std::span<const std::uint32_t> nodes, accel::Coherence coherence, std::vector<Pending>& pending);

    // Traces pending rays into child nodes with their light, and appends the rays that these spawn to `next`.
    void grow(std::span<const Pending> rays, std::vector<Pending>& next);

    // The rays that grow() would trace for `pending`, in its order, to the bit. They stay until the next call of any function.
    std::span<const geometry::Ray> child_rays(std::span<const Pending> pending);

    // The rays that light() would trace from nodes that did not leave the scene to a light, in their order, to the bit; whether or not it reaches
    // their side. They stay until the next call of any function.
    std::span<const geometry::Ray> shadow_rays(std::span<const std::uint32_t> nodes, std::size_t light);

    // Grows everything in `pending` of more influence than `threshold`, generation by generation; the rest stays in `pending`. Stops
    // between chunks when the deadline passes and returns false; calling again goes on.
    bool grow_above(std::vector<Pending>& pending, double threshold, const Deadline& deadline);

    // Radiance of the nodes that were there when pixels were last split, while the same Growth splits them further; else empty (level_edges.cpp).
    std::vector<Rgb>& radiance_before_splits() { return radiance_before_splits_; }

private:
    struct Seed {  // what a new node inherits
        std::uint32_t parent = no_node;
        Rgb weight{1, 1, 1};
        std::uint8_t depth = 0;
        bool crossed = false;
    };
    struct PointLanes {  // eight hits that are being lit, or grow rays
        int count = 0;
        std::uint32_t node[lane_count];
        Vec3Lanes position, normal, geometric, viewer;
        OctahedralPoint<Lanes> code;  // of the geometric normal, in steps
        Lanes offset;
        const Lobes* lobes[lane_count];
        unsigned physical;            // lanes of physical materials
        PhysicalView<Lanes> view;     // theirs
        unsigned classic, blinn;      // lanes of classic materials, and of those with Blinn's highlight
        ClassicView<Lanes> classic_view;
        unsigned sampled;             // lanes that take the light of lights with extent from their samples
        unsigned catching;            // lanes of catchers (render/catcher.h)
        float open[lane_count], all[lane_count];  // light that they caught so far
        unsigned layered;             // of those, lanes that ask for layer_at of the light
        FloatLanes sum[3];            // radiance so far, by channel
        // Of the current light:
        Reach<Lanes> reach;
        Lanes cosine;
        unsigned lit;  // lanes that it reaches, if nothing stands in the way
    };
    void append();
    void gather(std::span<const std::uint32_t> nodes);
    void find_lobes(std::span<const Lobes* const> known = {});
    void light_points(bool shadows, accel::Coherence coherence);
    void begin_light(PointLanes& points, bool shadows);
    bool any_untried(const PointLanes& points) const;
    void aim(PointLanes& points, std::size_t light) const;
    void leave_out_of_reach(const PointLanes& points, std::size_t light);
    void add_light(PointLanes& points, std::size_t light) const;
    void begin_catcher(PointLanes& points, int lane) const;
    void catch_light(PointLanes& points, std::size_t light) const;
    void end_catcher(const PointLanes& points, int lane);
    void spawn_from_points(std::vector<Pending>& pending);
    bool occluded_as_last(std::size_t light, std::uint8_t depth, const geometry::Ray& ray);
    void trace_shadows(std::size_t light, accel::Coherence coherence);

    const World& world_;
    const scene::Settings& settings_;
    Tile& tile_;
    bool unseen_;

    // Scratch, kept between chunks.
    std::vector<geometry::Ray> rays_;
    std::vector<accel::Hit> hits_;
    std::vector<Seed> seeds_;
    std::vector<PointLanes> points_room_;  // made once: to clear so much each time would take longer than some of the work
    std::span<PointLanes> points_;         // what of it is in use
    std::vector<TexturedLobes> textured_;  // of points_, where these have textures
    std::vector<std::uint32_t> parents_;
    std::vector<std::uint32_t> shadow_nodes_;
    std::vector<accel::Crossing> crossings_;
    std::vector<std::uint32_t> fresh_, sky_nodes_;
    std::vector<Rgb> radiance_before_splits_;
    std::vector<accel::Hit> last_occluder_;  // shadow cache: by light and depth
};

}  // namespace crescente::render
