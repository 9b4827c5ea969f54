#include "accel/triangle_clusters.h"

#include <mutex>

#include <embree3/rtcore.h>

#include "accel/float_bounds.h"

namespace crescente::accel {
namespace {

struct Leaves {
    const geometry::Mesh& mesh;
    std::vector<TriangleCluster>& clusters;
    std::mutex mutex;  // Embree builds subtrees in parallel
};

TriangleCluster make_cluster(const geometry::Mesh& mesh, const RTCBuildPrimitive* primitives, std::size_t count) {
    TriangleCluster cluster;
    cluster.count = static_cast<int>(count);
    const Vec3 filler = mesh.positions[mesh.triangles[primitives[0].primID][0]];
    for (int lane = 0; lane < cluster_size; ++lane) {
        const bool used = static_cast<std::size_t>(lane) < count;
        cluster.triangle[lane] = used ? primitives[lane].primID : none;
        geometry::Point3<Lanes>* corners[3] = {&cluster.p, &cluster.q, &cluster.r};
        for (int k = 0; k < 3; ++k) {
            const Vec3 v = used ? mesh.positions[mesh.triangles[cluster.triangle[lane]][k]] : filler;
            corners[k]->x[lane] = v.x, corners[k]->y[lane] = v.y, corners[k]->z[lane] = v.z;
        }
    }
    return cluster;
}

}  // namespace

std::vector<TriangleCluster> cluster_triangles(const geometry::Mesh& mesh, RTCDevice device) {
    std::vector<TriangleCluster> clusters;
    const Vec3 center = mesh.bounds().center();
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(mesh.parts());
    for (std::uint32_t i = 0; i < mesh.parts(); ++i) {
        const auto& [a, b, c] = mesh.triangles[i];
        if (!is_finite(mesh.positions[a]) || !is_finite(mesh.positions[b]) || !is_finite(mesh.positions[c])) continue;  // never hit
        const RTCBounds box = float_bounds(mesh.part_bounds(i), center, 0);
        primitives.push_back({box.lower_x, box.lower_y, box.lower_z, 0, box.upper_x, box.upper_y, box.upper_z, i});
    }
    const std::size_t count = primitives.size();
    if (count == 0) return clusters;
    clusters.reserve(count / (cluster_size - 2) + 1);

    Leaves leaves{mesh, clusters, {}};
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.byteSize = sizeof arguments;
    arguments.buildQuality = RTC_BUILD_QUALITY_MEDIUM;
    arguments.maxBranchingFactor = 2;
    arguments.maxDepth = 64;
    arguments.sahBlockSize = cluster_size;
    arguments.minLeafSize = 1;
    arguments.maxLeafSize = cluster_size;
    arguments.traversalCost = 1;
    arguments.intersectionCost = 0.2f;
    arguments.bvh = rtcNewBVH(device);
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = count;
    arguments.userPtr = &leaves;
    // Only the leaves are wanted; inner nodes are placeholders.
    arguments.createNode = [](RTCThreadLocalAllocator allocator, unsigned, void*) { return rtcThreadLocalAlloc(allocator, 16, 16); };
    arguments.setNodeChildren = [](void*, void**, unsigned, void*) {};
    arguments.setNodeBounds = [](void*, const RTCBounds**, unsigned, void*) {};
    arguments.createLeaf = [](RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* p, std::size_t n, void* user) {
        Leaves& to = *static_cast<Leaves*>(user);
        for (std::size_t first = 0; first < n; first += cluster_size) {  // a leaf at the depth limit may be larger
            const TriangleCluster cluster = make_cluster(to.mesh, p + first, std::min<std::size_t>(cluster_size, n - first));
            const std::lock_guard lock(to.mutex);
            to.clusters.push_back(cluster);
        }
        return rtcThreadLocalAlloc(allocator, 16, 16);
    };
    rtcBuildBVH(&arguments);
    rtcReleaseBVH(arguments.bvh);
    return clusters;
}

Bounds bounds(const TriangleCluster& cluster, const Affine& to_world) {
    Bounds box;
    for (int lane = 0; lane < cluster_size; ++lane) {
        for (const auto* corner : {&cluster.p, &cluster.q, &cluster.r}) {
            box.include(to_world.point({corner->x[lane], corner->y[lane], corner->z[lane]}));
        }
    }
    return box;
}

}  // namespace crescente::accel
