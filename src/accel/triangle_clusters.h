// A mesh cut into clusters of up to eight neighbouring triangles, laid out so that one ray is tried against all eight at once.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/narrow_phase.h"
#include "geometry/triangle.h"
#include "math/lanes.h"

struct RTCDeviceTy;

namespace crescente::accel {

inline constexpr int cluster_size = lane_count;

struct TriangleCluster {
    geometry::Point3<Lanes> p, q, r;  // corners; unused lanes repeat the first corner of the first triangle: degenerate, never hit
    std::uint32_t triangle[cluster_size];  // none in unused lanes
    int count = 0;                         // lanes that are used, the first ones
};

// Clusters of neighbours, from the leaves of a surface area hierarchy built by Embree. `device` must not be null; finite coordinates
// must be below 1e17. Triangles with a corner that is not finite are left out: they cannot be hit.
std::vector<TriangleCluster> cluster_triangles(const geometry::Mesh& mesh, RTCDeviceTy* device);

// Bounds of the cluster under a transform.
Bounds bounds(const TriangleCluster& cluster, const Affine& to_world);

// A ray in a mesh's space, with what all its triangle tests share.
struct MeshRay {
    Ray ray;
    geometry::RayView view;

    MeshRay() = default;
    explicit MeshRay(const Ray& local) : ray(local), view(local.origin, local.direction) {}
};

// Lanes whose triangle the ray meets within t_min < t <= t_max, as bits; t holds the parameters.
inline unsigned hit_lanes(const TriangleCluster& cluster, const MeshRay& local, double t_max, Lanes& t) {
    const Ray& ray = local.ray;
    const auto sides = geometry::triangle_sides(cluster.p, cluster.q, cluster.r, local.view);
    const LaneMask inside = ((sides.u >= 0.0) & (sides.v >= 0.0) & (sides.w >= 0.0)) | ((sides.u <= 0.0) & (sides.v <= 0.0) & (sides.w <= 0.0));
    unsigned lanes = bits_of(inside);
    if (!lanes) return 0;  // most clusters that are tried
    t = geometry::triangle_parameter(sides, cluster.p, cluster.q, cluster.r, local.view, geometry::point3(ray.origin), geometry::point3(ray.direction));
    lanes &= bits_of((t > ray.t_min) & (t <= t_max));
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        const auto corner = [i](const geometry::Point3<Lanes>& c) { return Vec3{c.x[i], c.y[i], c.z[i]}; };
        const geometry::TriangleSides<double> one{sides.u[i], sides.v[i], sides.w[i], 0, 0, 0};
        if (!confirmed(one, corner(cluster.p), corner(cluster.q), corner(cluster.r), ray.origin, ray.direction)) lanes ^= 1u << i;
    }
    return lanes;
}

// As nearest_in_part, for all triangles of the cluster.
inline void nearest_in_cluster(const TriangleCluster& cluster, const Instance& instance, std::uint32_t index, const MeshRay& local, Hit& hit, Sense sense) {
    Lanes t;
    for (unsigned lanes = hit_lanes(cluster, local, std::min(local.ray.t_max, hit.t), t); lanes; lanes &= lanes - 1) {
        const int lane = __builtin_ctz(lanes);
        const Hit candidate{t[lane], index, cluster.triangle[lane]};
        if (before(candidate, hit) && !is_culled(instance, candidate.primitive, local.ray, candidate.t, sense)) hit = candidate;
    }
}

}  // namespace crescente::accel
