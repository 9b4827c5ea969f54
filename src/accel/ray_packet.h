// Sixteen rays by component, tried against one shape eight at a time.
#pragma once

#include "accel/triangle_clusters.h"
#include "geometry/sphere.h"

namespace crescente::accel {

inline constexpr int packet_size = 16;

inline Lanes load(const double* values) { return *reinterpret_cast<const Lanes*>(values); }

// Lanes that are not set hold anything; masks say which count.
struct RayPacket {
    alignas(64) double ox[packet_size], oy[packet_size], oz[packet_size], dx[packet_size], dy[packet_size], dz[packet_size];
    alignas(64) double start[packet_size], end[packet_size];  // end: the nearer of t_max and the hit so far

    void set(int lane, const Ray& ray, double nearest) {
        ox[lane] = ray.origin.x, oy[lane] = ray.origin.y, oz[lane] = ray.origin.z;
        dx[lane] = ray.direction.x, dy[lane] = ray.direction.y, dz[lane] = ray.direction.z;
        start[lane] = ray.t_min, end[lane] = nearest;
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

// Which of the active lanes meet a sphere, as bits; t holds the parameter of the nearest crossing in the lane's reach.
inline unsigned sphere_lanes(const RayPacket& rays, unsigned active, const Instance& instance, double radius, double* t) {
    unsigned found = 0;
    for (int first = 0; first < packet_size; first += lane_count) {
        const LocalLanes local(rays, first, instance);
        const auto [enter, leave] = geometry::inside_sphere(radius, local.origin, local.direction);
        const Lanes start = load(rays.start + first), end = load(rays.end + first);
        const LaneMask enters = (enter > start) & (enter <= end), leaves = (leave > start) & (leave <= end);
        *reinterpret_cast<Lanes*>(t + first) = enters ? enter : leave;
        found |= bits_of((enter < leave) & (enters | leaves)) << first;
    }
    found &= active;
    for (unsigned rest = found; rest; rest &= rest - 1) {
        const int lane = __builtin_ctz(rest);
        if (!std::isfinite(t[lane])) found ^= 1u << lane;
    }
    return found;
}

// The packet in the space of one mesh instance, if its rays share the axis of their views there.
struct MeshPacket {
    std::uint32_t instance = none;
    bool usable = false;
    LocalLanes half[packet_size / lane_count];
    geometry::RayViewOf<Lanes> view[packet_size / lane_count];

    void prepare(const RayPacket& rays, unsigned active, const Instance& to, std::uint32_t index) {
        instance = index;
        int axis = -1;
        usable = true;
        for (int h = 0; h < packet_size / lane_count; ++h) {
            half[h] = LocalLanes(rays, h * lane_count, to);
            for (int i = 0; i < lane_count; ++i) {
                if (!(active >> (h * lane_count + i) & 1)) continue;
                const auto& d = half[h].direction;
                const int own = geometry::RayView::axis_of({d.x[i], d.y[i], d.z[i]});
                usable = usable && (axis < 0 || axis == own);
                axis = own;
            }
        }
        for (int h = 0; h < packet_size / lane_count && usable; ++h) {
            view[h] = geometry::RayViewOf<Lanes>(half[h].origin, half[h].direction, std::max(axis, 0));
        }
    }
};

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
