#include "raw_embree.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace crescente::bench {
namespace {

constexpr std::size_t packet = 16;
alignas(64) constexpr int all_lanes[packet] = {-1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1};

void set(float* to, math::Vec3 v) {
    for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(v[k]);
}

void attach(RTCScene scene, RTCGeometry geometry) {
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
}

void add_mesh(RTCDevice device, RTCScene scene, const geometry::Mesh& mesh, const math::Affine& to_world) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* points = static_cast<float*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), mesh.positions.size()));
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) set(points + 3 * i, to_world.point(mesh.positions[i]));
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof mesh.triangles[0], mesh.triangles.size());
    std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof mesh.triangles[0]);
    attach(scene, geometry);
}

void add_spheres(RTCDevice device, RTCScene scene, const std::vector<std::array<float, 4>>& spheres) {
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
    void* points = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, sizeof spheres[0], spheres.size());
    std::memcpy(points, spheres.data(), spheres.size() * sizeof spheres[0]);
    attach(scene, geometry);
}

}  // namespace

RawEmbree::RawEmbree(std::span<const accel::Instance> instances) : device_(rtcNewDevice("")), scene_(rtcNewScene(device_.get())) {
    std::vector<std::array<float, 4>> spheres;
    for (const accel::Instance& instance : instances) {
        if (const auto* mesh = std::get_if<geometry::Mesh>(instance.shape)) {
            add_mesh(device_.get(), scene_.get(), *mesh, instance.to_world);
        } else if (const auto* sphere = std::get_if<geometry::Sphere>(instance.shape)) {
            set(spheres.emplace_back().data(), instance.to_world.origin);
            spheres.back()[3] = static_cast<float>(sphere->radius * length(instance.to_world.x));
        } else {
            std::fprintf(stderr, "only meshes and spheres can be compared with Embree's own\n");
            std::exit(1);
        }
    }
    if (!spheres.empty()) add_spheres(device_.get(), scene_.get(), spheres);
    rtcCommitScene(scene_.get());
}

RawEmbree::Packets RawEmbree::pack(std::span<const accel::Ray> rays, bool coherent) {
    Packets packets{std::vector<RTCRayHit16>(rays.size() / packet), coherent};  // the last few rays do not matter
    for (std::size_t i = 0; i < packets.nearest.size() * packet; ++i) {
        RTCRayHit16& to = packets.nearest[i / packet];
        const accel::Ray& from = rays[i];
        const std::size_t k = i % packet;
        to.ray.org_x[k] = static_cast<float>(from.origin.x);
        to.ray.org_y[k] = static_cast<float>(from.origin.y);
        to.ray.org_z[k] = static_cast<float>(from.origin.z);
        to.ray.dir_x[k] = static_cast<float>(from.direction.x);
        to.ray.dir_y[k] = static_cast<float>(from.direction.y);
        to.ray.dir_z[k] = static_cast<float>(from.direction.z);
        to.ray.tnear[k] = static_cast<float>(from.t_min);
        to.ray.tfar[k] = static_cast<float>(from.t_max);
        to.ray.time[k] = 0;
        to.ray.mask[k] = ~0u;
        to.ray.id[k] = static_cast<unsigned>(k);
        to.ray.flags[k] = 0;
        to.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        to.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
    }
    return packets;
}

std::vector<RTCRayHit> RawEmbree::pack_singly(std::span<const accel::Ray> rays) {
    std::vector<RTCRayHit> packed(rays.size());
    for (std::size_t i = 0; i < rays.size(); ++i) {
        RTCRayHit& to = packed[i];
        set(&to.ray.org_x, rays[i].origin);
        set(&to.ray.dir_x, rays[i].direction);
        to.ray.tnear = static_cast<float>(rays[i].t_min);
        to.ray.tfar = static_cast<float>(rays[i].t_max);
        to.ray.mask = ~0u;
        to.hit.geomID = to.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    return packed;
}

std::size_t RawEmbree::nearest_singly(std::span<const RTCRayHit> rays) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    std::size_t found = 0;
    for (const RTCRayHit& packed : rays) {
        RTCRayHit ray = packed;
        rtcIntersect1(scene_.get(), &context, &ray);
        found += ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    }
    return found;
}

std::size_t RawEmbree::nearest(const Packets& packets) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (packets.coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    std::size_t found = 0;
    for (const RTCRayHit16& packed : packets.nearest) {
        RTCRayHit16 rays = packed;
        rtcIntersect16(all_lanes, scene_.get(), &context, &rays);
        for (std::size_t k = 0; k < packet; ++k) found += rays.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
    }
    return found;
}

std::size_t RawEmbree::occluded(const Packets& packets) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    if (packets.coherent) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    std::size_t found = 0;
    for (const RTCRayHit16& packed : packets.nearest) {
        RTCRay16 rays = packed.ray;
        rtcOccluded16(all_lanes, scene_.get(), &context, &rays);
        for (std::size_t k = 0; k < packet; ++k) found += rays.tfar[k] < 0;
    }
    return found;
}

}  // namespace crescente::bench
