// Sixteen rays by component, tried against one shape eight at a time.
#pragma once

#include <cstring>

#include "accel/triangle_clusters.h"
#include "geometry/patch_leaves.h"
#include "geometry/sphere.h"

namespace crescente::accel {

inline constexpr int packet_size = 16;

inline Lanes load(const double* values) { return *reinterpret_cast<const Lanes*>(values); }

// Lanes beyond the rays loaded repeat the first; masks say which count.
struct RayPacket {
    alignas(64) double ox[packet_size], oy[packet_size], oz[packet_size], dx[packet_size], dy[packet_size], dz[packet_size];
    alignas(64) double start[packet_size], end[packet_size];  // end: the nearer of t_max and the hit so far

    // count: 1 to packet_size.
    void load_rays(const Ray* rays, int count) {
        static_assert(sizeof(Ray) == sizeof(Lanes) && lane_count == 8);
        double* const components[] = {ox, oy, oz, dx, dy, dz, start, end};
        for (int first = 0; first < packet_size; first += lane_count) {
            Lanes rows[lane_count];
            for (int i = 0; i < lane_count; ++i) std::memcpy(&rows[i], &rays[first + i < count ? first + i : 0], sizeof(Lanes));
            transpose(rows);
            for (int k = 0; k < lane_count; ++k) *reinterpret_cast<Lanes*>(components[k] + first) = rows[k];
        }
    }
};

// Eight rays of a packet in the space of an instance, as to_local gives them one by one.
struct LocalLanes {
    geometry::Point3<Lanes> origin, direction;

    LocalLanes() = default;
    LocalLanes(const RayPacket& rays, int first, const Instance& instance)
        : origin{load(rays.ox + first), load(rays.oy + first), load(rays.oz + first)},
          direction{load(rays.dx + first), load(rays.dy + first), load(rays.dz + first)} {
        const Affine& m = instance.to_local;
        const auto &o = origin, &d = direction;
        if (instance.translation) {
            origin = {o.x + m.origin.x, o.y + m.origin.y, o.z + m.origin.z};
            return;
        }
        origin = {m.x.x * o.x + m.y.x * o.y + m.z.x * o.z + m.origin.x, m.x.y * o.x + m.y.y * o.y + m.z.y * o.z + m.origin.y,
                  m.x.z * o.x + m.y.z * o.y + m.z.z * o.z + m.origin.z};
        direction = {m.x.x * d.x + m.y.x * d.y + m.z.x * d.z, m.x.y * d.x + m.y.y * d.y + m.z.y * d.z,
                     m.x.z * d.x + m.y.z * d.y + m.z.z * d.z};
    }
};

// Which of the active lanes go into a sphere within their reach, and which leave it, as bits; at the parameters enter and leave.
struct SphereLanes {
    unsigned enters = 0, leaves = 0;
};
inline SphereLanes sphere_lanes(const RayPacket& rays, unsigned active, const Instance& instance, double radius, double* enter, double* leave) {
    SphereLanes found;
    for (int first = 0; first < packet_size; first += lane_count) {
        if (!(active >> first & 0xff)) continue;
        const LocalLanes local(rays, first, instance);
        const auto inside = geometry::inside_sphere(radius, local.origin, local.direction);
        const Lanes start = load(rays.start + first), end = load(rays.end + first);
        const auto in_reach = [&](const Lanes& t) { return (t > start) & (t <= end) & (t < std::numeric_limits<double>::infinity()); };
        const LaneMask meets = inside.enter < inside.leave;
        *reinterpret_cast<Lanes*>(enter + first) = inside.enter, *reinterpret_cast<Lanes*>(leave + first) = inside.leave;
        found.enters |= bits_of(meets & in_reach(inside.enter)) << first;
        found.leaves |= bits_of(meets & in_reach(inside.leave)) << first;
    }
    found.enters &= active, found.leaves &= active;
    return found;
}

// Which of the active lanes meet a part of a Brep, as bits; t holds the parameter of the nearest crossing in the lane's reach.
inline unsigned brep_lanes(const RayPacket& rays, unsigned active, const Instance& instance, const geometry::Brep& brep, std::uint32_t part, double* t) {
    unsigned found = 0;
    for (int first = 0; first < packet_size; first += lane_count) {
        const unsigned wanted = active >> first & 0xff;
        if (!wanted) continue;
        const LocalLanes local(rays, first, instance);
        const geometry::RayLanes lanes{local.origin, local.direction, load(rays.start + first), load(rays.end + first)};
        found |= brep.intersect(part, lanes, wanted, *reinterpret_cast<Lanes*>(t + first)) << first;
    }
    return found;
}

// Fewer rays than this meet a leaf of patches faster one by one.
inline constexpr int least_patch_rays = 3;

// As sphere_lanes, for a leaf of patches.
inline unsigned patch_lanes(const RayPacket& rays, unsigned active, const Instance& instance, const geometry::PatchLeaves& leaves, std::uint32_t leaf,
                            double* t) {
    unsigned found = 0;
    for (int first = 0; first < packet_size; first += lane_count) {
        const unsigned wanted = active >> first & 0xff;
        if (!wanted) continue;
        const LocalLanes local(rays, first, instance);
        geometry::PatchRootLanes roots;
        found |= leaves.nearest(leaf, {local.origin, local.direction, load(rays.start + first), load(rays.end + first)}, wanted, roots) << first;
        *reinterpret_cast<Lanes*>(t + first) = roots.t;
    }
    return found;
}

// The packet in the space of one mesh instance, if its rays share the axis of their views there.
struct MeshPacket {
    std::uint32_t instance = none;
    bool usable = false;
    LocalLanes half[packet_size / lane_count];
    geometry::RayViewOf<Lanes> view[packet_size / lane_count];
    geometry::RayViewRange range;  // over the active rays

    void prepare(const RayPacket& rays, unsigned active, const Instance& to, std::uint32_t index) {
        instance = index;
        int axis = -1;
        usable = true;
        for (int h = 0; h < packet_size / lane_count; ++h) {
            half[h] = LocalLanes(rays, h * lane_count, to);
            const auto& d = half[h].direction;
            const Lanes x = absolute(d.x), y = absolute(d.y), z = absolute(d.z);
            const unsigned over_y = bits_of(x > y), x_over_z = bits_of(x > z), y_over_z = bits_of(y > z), wanted = active >> (h * lane_count) & 0xff;
            // As RayView::axis_of, lane by lane.
            const unsigned on_axis[3] = {over_y & x_over_z & wanted, ~over_y & y_over_z & wanted, wanted & ~(over_y & x_over_z) & ~(~over_y & y_over_z)};
            for (int k = 0; k < 3; ++k) {
                if (!on_axis[k]) continue;
                usable = usable && (axis < 0 || axis == k);
                axis = k;
            }
        }
        if (!usable) return;
        range = {};
        for (int h = 0; h < packet_size / lane_count; ++h) {
            view[h] = geometry::RayViewOf<Lanes>(half[h].origin, half[h].direction, std::max(axis, 0));
            range.include(view[h], active >> (h * lane_count) & 0xff);
        }
    }
};

// Triangles of the cluster that some ray of the packet may hit, as bits.
inline unsigned triangles_in_reach(const MeshPacket& mesh, const TriangleCluster& cluster) {
    const auto p = mesh.range(cluster.p), q = mesh.range(cluster.q), r = mesh.range(cluster.r);
    const LaneMask out = ((p.x_low > 0.0) & (q.x_low > 0.0) & (r.x_low > 0.0)) | ((p.x_high < 0.0) & (q.x_high < 0.0) & (r.x_high < 0.0)) |
                         ((p.y_low > 0.0) & (q.y_low > 0.0) & (r.y_low > 0.0)) | ((p.y_high < 0.0) & (q.y_high < 0.0) & (r.y_high < 0.0));
    return ~bits_of(out) & ((1u << cluster.count) - 1);
}

// As hit_lanes the other way round: which of the active rays meet triangle k of the cluster, as bits; t holds the parameters.
inline unsigned triangle_lanes(const MeshPacket& mesh, const RayPacket& rays, unsigned active, const TriangleCluster& cluster, int k, double* t) {
    const auto corner = [k](const geometry::Point3<Lanes>& c) { return geometry::Point3<double>{c.x[k], c.y[k], c.z[k]}; };
    const geometry::Point3<double> p = corner(cluster.p), q = corner(cluster.q), r = corner(cluster.r);
    unsigned found = 0;
    for (int h = 0; h < packet_size / lane_count; ++h) {
        const int first = h * lane_count;
        const unsigned wanted = active >> first & 0xff;
        if (!wanted) continue;
        const auto sides = geometry::triangle_sides(p, q, r, mesh.view[h]);
        const LaneMask inside = ((sides.u >= 0.0) & (sides.v >= 0.0) & (sides.w >= 0.0)) | ((sides.u <= 0.0) & (sides.v <= 0.0) & (sides.w <= 0.0));
        unsigned lanes = bits_of(inside) & wanted;
        if (!lanes) continue;
        const Lanes parameter = geometry::triangle_parameter(sides, p, q, r, mesh.view[h], mesh.half[h].origin, mesh.half[h].direction);
        lanes &= bits_of((parameter > load(rays.start + first)) & (parameter <= load(rays.end + first)));
        for (unsigned rest = lanes; rest; rest &= rest - 1) {
            const int i = __builtin_ctz(rest);
            const auto& o = mesh.half[h].origin;
            const auto& d = mesh.half[h].direction;
            const geometry::TriangleSides<double> one{sides.u[i], sides.v[i], sides.w[i], 0, 0, 0};
            if (!confirmed(one, {p.x, p.y, p.z}, {q.x, q.y, q.z}, {r.x, r.y, r.z}, {o.x[i], o.y[i], o.z[i]}, {d.x[i], d.y[i], d.z[i]})) lanes ^= 1u << i;
        }
        *reinterpret_cast<Lanes*>(t + first) = parameter;
        found |= lanes << first;
    }
    return found;
}

// Whether many rays against one triangle at a time beat one ray against the cluster at a time.
inline bool rays_outnumber_triangles(unsigned active, const TriangleCluster& cluster) {
    const int halves = (active & 0xff ? 1 : 0) + (active >> lane_count ? 1 : 0);
    return 2 * __builtin_popcount(active) > cluster.count * halves;
}

}  // namespace crescente::accel
