// The default accelerator. Embree traverses float boxes; every hit is computed by the narrow phase in double, for triangles eight at
// a time. (Wald et al. 2014, "Embree: A Kernel Framework for Efficient CPU Ray Tracing".)
//
// Why no hit is lost although Embree's rays and boxes are float: coordinates are taken about the scene's centre, and a ray that starts
// far away is moved up to the scene first, so that all coordinates that matter are at most `reach` times the scene's radius R. The float
// ray then strays from the double ray by a few units of 2^-24 R, and all boxes are grown by more than that (box_margin). The
// end of the float ray is kept behind the nearest double hit by the same margin. See docs/decisions/0001-double-narrow-phase.md.
#include <unordered_map>

#include <embree3/rtcore.h>

#include "accel/accelerator.h"
#include "accel/float_bounds.h"
#include "accel/parts.h"
#include "accel/ray_packet.h"
#include "accel/triangle_clusters.h"

namespace crescente::accel {
namespace {

constexpr int packet = packet_size;
constexpr double reach = 4;                    // farthest origin in scene radii, in each coordinate
constexpr double float_unit = 1.0 / (1 << 24);  // half an ulp of float, relative
constexpr double box_margin = 64 * float_unit;  // of the scene's radius
constexpr double largest_coordinate = 1e16;     // what goes further, Embree does not see; its own limit is 1.8e18, in either space

bool fits(const Bounds& box) { return box.bounded() && box.largest_coordinate() < largest_coordinate; }

// Whether all instances of a shape may refer to one copy of its boxes: where these outweigh what an instance takes.
bool may_share(const geometry::Shape& shape) { return std::holds_alternative<geometry::Mesh>(shape) || geometry::parts(shape) > 8; }

// Whether Embree may carry rays into the shape's space, in float: not if the transform distorts so much that the error would exceed the
// margin of the boxes, or if coordinates there would leave Embree's range.
bool may_instance(const Instance& instance, double scene_radius) {
    const auto norm = [](const Affine& m) { return std::sqrt(dot(m.x, m.x) + dot(m.y, m.y) + dot(m.z, m.z)); };
    const double shrinks = norm(instance.to_local), grows = norm(instance.to_world);
    return shrinks * grows < 100 && shrinks < 1e12 && grows < 1e12 && shrinks * scene_radius < largest_coordinate;
}

using Clusters = std::shared_ptr<const std::vector<TriangleCluster>>;  // of a mesh, wherever it stands

// A primitive of Embree's: either a cluster of a mesh or one part of any other shape.
struct Primitive {
    std::uint32_t instance;
    std::uint32_t part;
    const TriangleCluster* cluster;  // or null
};

// What one Embree geometry refers to. Sets of instanced shapes name no instance: Embree tells which one it is in.
struct PrimitiveSet {
    std::vector<Primitive> primitives;
    std::vector<RTCBounds> bounds;
};

struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
};
using Device = std::unique_ptr<RTCDeviceTy, Release>;
using Scene = std::unique_ptr<RTCSceneTy, Release>;

// Embree takes components below 1e-18 for +1e-18 in its reciprocals, but sorts coherent rays by their true signs: a small negative one
// would be traversed backwards.
Lanes without_tiny(const Lanes& component) { return absolute(component) < 1e-17 ? Lanes{} : component; }

void store(double* to, const Lanes& values) { *reinterpret_cast<Lanes*>(to) = values; }

void to_float(float* to, const Lanes& values) {
    using Floats = float __attribute__((vector_size(lane_count * sizeof(float))));
    *reinterpret_cast<Floats*>(to) = __builtin_convertvector(values, Floats);
}

template <bool shadows>
using EmbreeRays = std::conditional_t<shadows, RTCRay16, RTCRayHit16>;
RTCRay16& rays_of(RTCRay16& rays) { return rays; }
RTCRay16& rays_of(RTCRayHit16& rays) { return rays.ray; }

// Embree may try a primitive several times for the same ray: coherent packets are traversed once for each octant of their directions.
void drop_repeated(std::vector<Crossing>& crossings, std::size_t first) {
    const auto begin = crossings.begin() + static_cast<std::ptrdiff_t>(first);
    const auto order = [](const Crossing& a, const Crossing& b) { return a.ray != b.ray ? a.ray < b.ray : before(a.hit, b.hit); };
    std::sort(begin, crossings.end(), order);
    crossings.erase(std::unique(begin, crossings.end(), [&](const auto& a, const auto& b) { return !order(a, b) && !order(b, a); }), crossings.end());
}

class Embree;

// One call of Embree; the callbacks find it by the context's address.
struct Query {
    RTCIntersectContext context;  // first, so that its address is the query's
    const Embree* accelerator;
    const Ray* rays;               // of the packet
    Hit* hits;
    float* farther;                // float minus double parameter of each ray: where its float origin was moved
    std::uint32_t first_ray;       // index of the packet's first ray in the batch
    std::vector<Crossing>* crossings;
    TestCounts counts;
    // The ray in the space of the mesh instance that was last tried, for each lane.
    std::uint32_t local_instance[packet];
    MeshRay local[packet];
    RayPacket packet_rays;   // the same rays by component
    MeshPacket mesh_packet;  // all of them in the space of the mesh instance that was last tried

    unsigned active = 0;     // lanes that are traced at all
};

unsigned bits_of_lanes(const int* valid) {
#if defined(__AVX512F__)
    const __m512i lanes = _mm512_loadu_si512(valid);
    return _mm512_test_epi32_mask(lanes, lanes);
#else
    unsigned bits = 0;
    for (int lane = 0; lane < packet; ++lane) bits |= valid[lane] ? 1u << lane : 0u;
    return bits;
#endif
}

class Embree final : public Accelerator {
public:
    explicit Embree(std::span<const Instance> instances) : instances_(instances) {}

    // Takes what is known of meshes, those too that are not shown now.
    void take_clusters(const Embree& before, std::span<const geometry::Shape* const> reshaped);
    Expected<void> build();
    void nearest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, TestCounts& counts) const override;
    void shadow(std::span<const Ray> rays, std::span<Hit> occluders, std::vector<Crossing>& crossings, Coherence coherence,
                TestCounts& counts) const override;
    std::size_t bytes() const override;

    void try_nearest(const RTCIntersectFunctionNArguments& arguments) const;
    void try_shadow(const RTCOccludedFunctionNArguments& arguments) const;

private:
    template <bool shadows>
    void trace_packet(Query& query, EmbreeRays<shadows>& embree_rays, int count) const;
    bool move_up(const Ray& ray, double& to, float& moved, double& x, double& y, double& z, double& from) const;
    template <bool shadows>
    void trace(std::span<const Ray> rays, std::span<Hit> hits, std::vector<Crossing>* crossings, Coherence coherence, TestCounts& counts) const;
    bool clip(const Ray& ray, double& from, double& to) const;
    bool try_packet(Query& query, const Primitive& primitive, std::uint32_t index, const int* valid, Sense sense,
                    auto&& visit) const;
    const MeshRay& mesh_ray(Query& query, unsigned lane, std::uint32_t instance) const;
    void attach(RTCScene scene, PrimitiveSet& set);
    const std::vector<TriangleCluster>& clusters_of(const geometry::Shape& shape, const geometry::Mesh& mesh);
    std::uint32_t instance_of(const RTCIntersectContext& context, const Primitive& primitive) const {
        const unsigned geometry = context.instID[0];
        return geometry == RTC_INVALID_GEOMETRY_ID ? primitive.instance : instance_of_geometry_[geometry];
    }

    std::span<const Instance> instances_;
    Device device_;
    std::vector<std::unique_ptr<PrimitiveSet>> sets_;
    std::unordered_map<const geometry::Shape*, Clusters> clusters_;
    std::vector<Scene> prototypes_;  // scenes of shapes that are shown several times
    Scene scene_;
    std::vector<std::uint32_t> instance_of_geometry_;  // by Embree geometry id of the top scene
    std::vector<std::uint32_t> unbounded_;             // instances that no box holds: tried for every ray
    Vec3 center_;
    double radius_ = 0;      // half the largest edge of the scene's box
    Bounds box_;             // of all that is bounded, grown
    bool empty_ = true;
};

const std::vector<TriangleCluster>& Embree::clusters_of(const geometry::Shape& shape, const geometry::Mesh& mesh) {
    Clusters& clusters = clusters_[&shape];
    if (!clusters) clusters = std::make_shared<const std::vector<TriangleCluster>>(cluster_triangles(mesh, device_.get()));
    return *clusters;
}

void Embree::take_clusters(const Embree& before, std::span<const geometry::Shape* const> reshaped) {
    clusters_ = before.clusters_;
    for (const geometry::Shape* shape : reshaped) clusters_.erase(shape);
}

Expected<void> Embree::build() {
    // Not told how many threads: Embree would cap oneTBB for the whole process, other sessions included.
    device_.reset(rtcNewDevice(""));
    if (!device_) return failure(ErrorKind::resource, {"", "", "Embree cannot be started on this machine", ""});

    std::vector<Bounds> boxes(instances_.size());
    for (std::uint32_t i = 0; i < instances_.size(); ++i) {
        if (!has_inverse(instances_[i])) continue;
        const Bounds own = geometry::bounds(*instances_[i].shape);
        boxes[i] = transform(instances_[i].to_world, own);
        if (boxes[i].empty()) continue;
        if (fits(boxes[i]) && fits(own)) {
            box_.include(boxes[i]);
        } else {
            boxes[i] = {};
            unbounded_.push_back(i);
        }
    }
    std::vector<std::pair<const geometry::Shape*, std::vector<std::uint32_t>>> shared;  // shapes that may be stored once and their instances, in order
    {
        std::vector<std::pair<const geometry::Shape*, std::uint32_t>> large;
        for (std::uint32_t i = 0; i < instances_.size(); ++i) {
            if (!boxes[i].empty() && may_share(*instances_[i].shape)) large.emplace_back(instances_[i].shape, i);
        }
        std::stable_sort(large.begin(), large.end(), [](const auto& a, const auto& b) { return std::less<>{}(a.first, b.first); });
        for (const auto& [shape, i] : large) {
            if (shared.empty() || shared.back().first != shape) shared.push_back({shape, {}});
            shared.back().second.push_back(i);
        }
    }

    empty_ = box_.empty();
    if (empty_) return {};
    center_ = box_.center();
    radius_ = 0.5 * max_component(box_.diagonal());
    // A scene of one point, or one so far out that its own extent drowns in the coordinates' precision.
    radius_ = std::max(radius_, 1e-12 * box_.largest_coordinate() + 1e-300);
    const double margin = box_margin * radius_;
    const Vec3 grown = Vec3{1, 1, 1} * margin;
    box_ = {box_.lower - grown, box_.upper + grown};

    scene_.reset(rtcNewScene(device_.get()));
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
    PrimitiveSet& flat = *sets_.emplace_back(std::make_unique<PrimitiveSet>());
    // Boxes of all parts of a shape that is no mesh, seen from `origin`; instance none: in the shape's own space.
    const auto add_parts = [](PrimitiveSet& set, const geometry::Shape& shape, std::uint32_t instance, const Affine& place, Vec3 origin, double grow) {
        const std::uint32_t parts = geometry::parts(shape);
        for (std::uint32_t part = 0; part < parts; ++part) {
            const Bounds box = transform(place, geometry::part_bounds(shape, part));
            if (box.empty()) continue;
            set.primitives.push_back({instance, part, nullptr});
            set.bounds.push_back(float_bounds(box, origin, grow));
        }
    };
    for (std::uint32_t i = 0; i < instances_.size(); ++i) {
        const geometry::Shape& shape = *instances_[i].shape;
        if (!boxes[i].empty() && !may_share(shape)) add_parts(flat, shape, i, instances_[i].to_world, center_, margin);
    }
    struct Placed {
        RTCScene prototype;
        Vec3 origin;
        std::uint32_t instance;
    };
    std::vector<Placed> placed;
    for (const auto& [shape, users] : shared) {
        const auto* mesh = std::get_if<geometry::Mesh>(shape);
        std::span<const TriangleCluster> clusters;
        if (mesh) clusters = clusters_of(*shape, *mesh);
        if (mesh && clusters.empty()) continue;
        std::vector<std::uint32_t> instanced, flattened;  // flattened: each with boxes of its own; the clusters are shared
        for (const std::uint32_t i : users) (users.size() > 1 && may_instance(instances_[i], radius_) ? instanced : flattened).push_back(i);
        const auto add_clusters = [&](PrimitiveSet& set, std::uint32_t instance, const Affine& place, Vec3 origin, double grow) {
            for (const TriangleCluster& cluster : clusters) {
                set.primitives.push_back({instance, 0, &cluster});
                set.bounds.push_back(float_bounds(bounds(cluster, place), origin, grow));
            }
        };
        for (const std::uint32_t i : flattened) {
            if (mesh) add_clusters(flat, i, instances_[i].to_world, center_, margin);
            else add_parts(flat, *shape, i, instances_[i].to_world, center_, margin);
        }
        if (instanced.empty()) continue;
        // In the shape's own space Embree's ray strays further: by the errors of the world ray and of the transform, both in
        // float, carried into that space.
        PrimitiveSet& set = *sets_.emplace_back(std::make_unique<PrimitiveSet>());
        const Bounds own = geometry::bounds(*shape);
        double local_margin = 0;
        for (const std::uint32_t i : instanced) {
            const Affine& m = instances_[i].to_local;
            const double stretch = std::max({length(m.x), length(m.y), length(m.z)}) * 1.7320508075688773;
            local_margin = std::max(local_margin, 4 * margin * stretch);
        }
        local_margin += box_margin * max_component(own.diagonal());
        if (mesh) add_clusters(set, none, Affine{}, own.center(), local_margin);
        else add_parts(set, *shape, none, Affine{}, own.center(), local_margin);
        RTCScene prototype = prototypes_.emplace_back(rtcNewScene(device_.get())).get();
        rtcSetSceneFlags(prototype, RTC_SCENE_FLAG_ROBUST);
        attach(prototype, set);
        rtcCommitScene(prototype);
        for (const std::uint32_t i : instanced) placed.push_back({prototype, own.center(), i});
    }
    instance_of_geometry_.push_back(none);  // geometry 0: the flat set
    attach(scene_.get(), flat);
    for (const auto& [prototype, origin, i] : placed) {
        RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, prototype);
        const Affine& m = instances_[i].to_world;
        const Vec3 place = m.point(origin) - center_;
        const float columns[12] = {float(m.x.x), float(m.x.y), float(m.x.z), float(m.y.x), float(m.y.y), float(m.y.z),
                                   float(m.z.x), float(m.z.y), float(m.z.z), float(place.x), float(place.y), float(place.z)};
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(geometry);
        rtcAttachGeometryByID(scene_.get(), geometry, static_cast<unsigned>(instance_of_geometry_.size()));
        rtcReleaseGeometry(geometry);
        instance_of_geometry_.push_back(i);
    }
    rtcCommitScene(scene_.get());
    for (auto& set : sets_) set->bounds = {};
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE) {
        return failure(ErrorKind::resource, {"", "", "Embree could not build the acceleration structure: not enough memory", ""});
    }
    return {};
}

void Embree::attach(RTCScene scene, PrimitiveSet& set) {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(set.primitives.size()));
    rtcSetGeometryUserData(geometry, &set);
    rtcSetGeometryBoundsFunction(
        geometry,
        [](const RTCBoundsFunctionArguments* a) { *a->bounds_o = static_cast<PrimitiveSet*>(a->geometryUserPtr)->bounds[a->primID]; }, nullptr);
    rtcSetGeometryIntersectFunction(geometry, [](const RTCIntersectFunctionNArguments* a) {
        reinterpret_cast<const Query*>(a->context)->accelerator->try_nearest(*a);
    });
    rtcSetGeometryOccludedFunction(geometry, [](const RTCOccludedFunctionNArguments* a) {
        reinterpret_cast<const Query*>(a->context)->accelerator->try_shadow(*a);
    });
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, 0);
    rtcReleaseGeometry(geometry);
}

const MeshRay& Embree::mesh_ray(Query& query, unsigned lane, std::uint32_t instance) const {
    if (query.local_instance[lane] != instance) {
        query.local_instance[lane] = instance;
        query.local[lane] = MeshRay(to_local(instances_[instance], query.rays[lane]));
    }
    return query.local[lane];
}

// Tries a sphere, a cluster or a part of a Brep against a whole packet, and calls visit(lane, hit) for each crossing within the lane's reach. False if one
// ray at a time is better, or the only way; then nothing was done.
bool Embree::try_packet(Query& query, const Primitive& primitive, std::uint32_t index, const int* valid, Sense sense,
                        auto&& visit) const {
    const Instance& instance = instances_[index];
    const unsigned active = bits_of_lanes(valid);
    alignas(64) double t[packet];
    const auto meet = [&](unsigned lane, const Hit& hit) {
        if (instance.one_sided.empty() || !is_culled(instance, hit.primitive, to_local(instance, query.rays[lane]), hit.t, sense)) visit(lane, hit);
    };
    if (primitive.cluster) {
        const TriangleCluster& cluster = *primitive.cluster;
        if (!rays_outnumber_triangles(active, cluster)) return false;
        if (query.mesh_packet.instance != index) query.mesh_packet.prepare(query.packet_rays, query.active, instance, index);
        if (!query.mesh_packet.usable) return false;
        const unsigned in_reach = triangles_in_reach(query.mesh_packet, cluster);
        for (unsigned triangles = in_reach; triangles; triangles &= triangles - 1) {
            const int k = __builtin_ctz(triangles);
            for (unsigned lanes = triangle_lanes(query.mesh_packet, query.packet_rays, active, cluster, k, t); lanes; lanes &= lanes - 1) {
                const auto lane = static_cast<unsigned>(__builtin_ctz(lanes));
                meet(lane, Hit{t[lane], index, cluster.triangle[k]});
            }
        }
        query.counts.shape_tests += static_cast<unsigned>(__builtin_popcount(in_reach)) * packet;
        return true;
    }
    if (const auto* brep = std::get_if<geometry::Brep>(instance.shape)) {
        constexpr int few = 2;  // rays, which are cheaper one by one
        if (__builtin_popcount(active) <= few || !instance.one_sided.empty()) return false;  // behind a crossing that is culled there may be another
        for (unsigned lanes = brep_lanes(query.packet_rays, active, instance, *brep, primitive.part, t); lanes; lanes &= lanes - 1) {
            const auto lane = static_cast<unsigned>(__builtin_ctz(lanes));
            visit(lane, Hit{t[lane], index, primitive.part});
        }
        query.counts.shape_tests += static_cast<unsigned>(__builtin_popcount(active));
        return true;
    }
    const auto* sphere = std::get_if<geometry::Sphere>(instance.shape);
    if (!sphere) {
        const geometry::PatchLeaves* leaves = geometry::patch_leaves(*instance.shape);
        if (!leaves || __builtin_popcount(active) < least_patch_rays || !instance.one_sided.empty()) return false;
        for (unsigned lanes = patch_lanes(query.packet_rays, active, instance, *leaves, primitive.part, t); lanes; lanes &= lanes - 1) {
            const auto lane = static_cast<unsigned>(__builtin_ctz(lanes));
            visit(lane, Hit{t[lane], index, primitive.part});
        }
        query.counts.shape_tests += packet;
        return true;
    }
    alignas(64) double leave[packet];
    const SphereLanes crossed = sphere_lanes(query.packet_rays, active, instance, sphere->radius, t, leave);
    const bool both = sense == Sense::light && !instance.opaque;
    const auto visit_all = [&](unsigned lanes, const double* at) {
        for (; lanes; lanes &= lanes - 1) {
            const auto lane = static_cast<unsigned>(__builtin_ctz(lanes));
            meet(lane, Hit{at[lane], index, 0});
        }
    };
    visit_all(crossed.enters, t);
    visit_all(both ? crossed.leaves : crossed.leaves & ~crossed.enters, leave);
    query.counts.shape_tests += packet;
    return true;
}

void Embree::try_nearest(const RTCIntersectFunctionNArguments& arguments) const {
    Query& query = *reinterpret_cast<Query*>(arguments.context);
    const auto& set = *static_cast<const PrimitiveSet*>(arguments.geometryUserPtr);
    const Primitive primitive = set.primitives[arguments.primID];
    const std::uint32_t index = instance_of(query.context, primitive);
    const Instance& instance = instances_[index];
    RTCRayN* rays = RTCRayHitN_RayN(arguments.rayhit, arguments.N);
    RTCHitN* hits = RTCRayHitN_HitN(arguments.rayhit, arguments.N);
    const auto update = [&](unsigned i, unsigned lane, const Hit& hit) {
        query.hits[lane] = hit;
        query.packet_rays.end[lane] = hit.t;
        const double end = hit.t - query.farther[lane];
        RTCRayN_tfar(rays, arguments.N, i) = static_cast<float>(end + box_margin * (4 * radius_ + 5 * std::abs(end)));  // more than its rounding
        RTCHitN_geomID(hits, arguments.N, i) = 0;
    };
    const auto nearer = [&](unsigned lane, const Hit& hit) {
        if (before(hit, query.hits[lane])) update(lane, lane, hit);
    };
    if (arguments.N == packet && try_packet(query, primitive, index, arguments.valid, Sense::eye, nearer)) return;
    for (unsigned i = 0; i < arguments.N; ++i) {
        if (!arguments.valid[i]) continue;
        const unsigned lane = RTCRayN_id(rays, arguments.N, i);
        Hit hit = query.hits[lane];
        if (primitive.cluster) {
            nearest_in_cluster(*primitive.cluster, instance, index, mesh_ray(query, lane, index), hit, Sense::eye);
            query.counts.shape_tests += cluster_size;
        } else {
            nearest_in_part(instance, index, primitive.part, to_local(instance, query.rays[lane]), hit);
            ++query.counts.shape_tests;
        }
        if (before(hit, query.hits[lane])) update(i, lane, hit);
    }
}

void Embree::try_shadow(const RTCOccludedFunctionNArguments& arguments) const {
    Query& query = *reinterpret_cast<Query*>(arguments.context);
    const auto& set = *static_cast<const PrimitiveSet*>(arguments.geometryUserPtr);
    const Primitive primitive = set.primitives[arguments.primID];
    const std::uint32_t index = instance_of(query.context, primitive);
    const Instance& instance = instances_[index];
    // What is not opaque may be crossed several times, what has one side only the second time: one ray at a time, but for spheres and triangles.
    const bool in_packets = instance.one_sided.empty() && (instance.opaque || std::holds_alternative<geometry::Sphere>(*instance.shape));
    if (arguments.N == packet && (in_packets || primitive.cluster)) {
        const auto block_or_cross = [&](unsigned lane, const Hit& hit) {
            if (instance.opaque) {
                query.hits[lane] = hit;
                RTCRayN_tfar(arguments.ray, arguments.N, lane) = -INFINITY;
            } else {
                query.crossings->push_back({query.first_ray + lane, hit});
            }
        };
        if (try_packet(query, primitive, index, arguments.valid, Sense::light, block_or_cross)) return;
    }
    for (unsigned i = 0; i < arguments.N; ++i) {
        if (!arguments.valid[i]) continue;
        const unsigned lane = RTCRayN_id(arguments.ray, arguments.N, i);
        const Ray& ray = query.rays[lane];
        query.counts.shape_tests += primitive.cluster ? cluster_size : 1;
        if (instance.opaque) {
            Hit& hit = query.hits[lane];
            if (primitive.cluster) {
                nearest_in_cluster(*primitive.cluster, instance, index, mesh_ray(query, lane, index), hit, Sense::light);
            } else {
                nearest_in_part(instance, index, primitive.part, to_local(instance, ray), hit, Sense::light);
            }
            if (hit.found()) RTCRayN_tfar(arguments.ray, arguments.N, i) = -INFINITY;
        } else if (primitive.cluster) {
            Lanes t;
            const TriangleCluster& cluster = *primitive.cluster;
            for (unsigned lanes = hit_lanes(cluster, mesh_ray(query, lane, index), ray.t_max, t); lanes; lanes &= lanes - 1) {
                const int k = __builtin_ctz(lanes);
                if (is_culled(instance, cluster.triangle[k], mesh_ray(query, lane, index).ray, t[k], Sense::light)) continue;
                query.crossings->push_back({query.first_ray + lane, {t[k], index, cluster.triangle[k]}});
            }
        } else {
            all_in_part(instance, index, primitive.part, to_local(instance, ray), query.first_ray + lane, *query.crossings);
        }
    }
}

// The part of the ray inside the grown box of the scene, by slabs.
bool Embree::clip(const Ray& ray, double& from, double& to) const {
    from = ray.t_min, to = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const double o = ray.origin[axis], d = ray.direction[axis];
        if (d == 0) {
            if (o < box_.lower[axis] || o > box_.upper[axis]) return false;
            continue;
        }
        const double a = (box_.lower[axis] - o) / d, b = (box_.upper[axis] - o) / d;
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to;
}

template <bool shadows>
void Embree::trace_packet(Query& query, EmbreeRays<shadows>& embree_rays, int count) const {
    alignas(64) int valid[packet];
    alignas(64) float moved[packet] = {};
    auto& ray = rays_of(embree_rays);
    RayPacket& rays = query.packet_rays;
    rays.load_rays(query.rays, count);
    query.farther = moved;
    query.active = (1u << count) - 1;
    query.mesh_packet.instance = none;
    std::fill_n(query.local_instance, packet, none);
    for (int lane = 0; lane < count && !unbounded_.empty(); ++lane) {
        rays.end[lane] = std::min(rays.end[lane], query.hits[lane].t);
        if (shadows && query.hits[lane].found()) query.active &= ~(1u << lane);  // an unbounded shape is in the way already
    }
    // Rays about the scene's centre, with their reach.
    alignas(64) double x[packet], y[packet], z[packet], from[packet], to[packet];
    for (int first = 0; first < packet; first += lane_count) {
        const Lanes dx = load(rays.dx + first), dy = load(rays.dy + first), dz = load(rays.dz + first);
        const Lanes cx = load(rays.ox + first) - center_.x, cy = load(rays.oy + first) - center_.y, cz = load(rays.oz + first) - center_.z;
        const Lanes start = load(rays.start + first), end = load(rays.end + first);
        const auto exceeds = [](const Lanes& a, const Lanes& b, const Lanes& c, double most) {
            return !((absolute(a) <= most) & (absolute(b) <= most) & (absolute(c) <= most));
        };
        const LaneMask empty = !(start < end), wild = exceeds(dx, dy, dz, largest_coordinate) | exceeds(cx, cy, cz, largest_coordinate);
        const LaneMask far = exceeds(cx, cy, cz, reach * radius_) | (start < 0.0);
        store(x + first, cx), store(y + first, cy), store(z + first, cz), store(from + first, start), store(to + first, end);
        query.active &= ~(bits_of(empty | exceeds(dx, dy, dz, largest_coordinate)) << first);
        for (unsigned lanes = bits_of(far | wild) & query.active >> first; lanes; lanes &= lanes - 1) {
            const int lane = first + __builtin_ctz(lanes);
            if (!move_up(query.rays[lane], to[lane], moved[lane], x[lane], y[lane], z[lane], from[lane])) query.active &= ~(1u << lane);
        }
        to_float(ray.org_x + first, load(x + first)), to_float(ray.org_y + first, load(y + first)), to_float(ray.org_z + first, load(z + first));
        to_float(ray.dir_x + first, without_tiny(dx)), to_float(ray.dir_y + first, without_tiny(dy)), to_float(ray.dir_z + first, without_tiny(dz));
        const double margin = 4 * box_margin * radius_;
        const Lanes near = load(from + first) - margin, far_end = load(to + first);
        to_float(ray.tnear + first, near > 0.0 ? near : Lanes{});
        to_float(ray.tfar + first, far_end + (margin + 5 * box_margin * absolute(far_end)));  // more than its rounding
    }
    for (int lane = 0; lane < packet; ++lane) valid[lane] = -static_cast<int>(query.active >> lane & 1);
    if constexpr (shadows) {
        rtcOccluded16(valid, scene_.get(), &query.context, &embree_rays);
    } else {
        for (int lane = 0; lane < packet; ++lane) embree_rays.hit.geomID[lane] = embree_rays.hit.instID[0][lane] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect16(valid, scene_.get(), &query.context, &embree_rays);
    }
}

// Moves the start of a ray that begins far from the scene, or before its origin, up to the scene: by `moved`, which shortens from and to.
// x, y, z become its origin about the scene's centre. False if it misses the scene, or if Embree could not take it.
bool Embree::move_up(const Ray& ray, double& to, float& moved, double& x, double& y, double& z, double& from) const {
    double enter, leave;
    if (!is_finite(ray.origin) || !clip(ray, enter, leave)) return false;
    const double grown = enter - 2 * radius_;  // well before the box: the exact place does not matter
    moved = grown > 0 || ray.t_min < 0 ? round_down(grown) : 0.0f;
    const Vec3 origin = ray.at(moved) - center_;
    x = origin.x, y = origin.y, z = origin.z;
    from -= moved, to -= moved;
    return max_component(abs(origin)) <= largest_coordinate;
}

template <bool shadows>
void Embree::trace(std::span<const Ray> rays, std::span<Hit> hits, std::vector<Crossing>* crossings, Coherence coherence, TestCounts& counts) const {
    Query query;
    rtcInitIntersectContext(&query.context);
    // Not with instances: in their space without_tiny() does not hold.
    if (coherence == Coherence::coherent && prototypes_.empty()) query.context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    query.accelerator = this;
    query.crossings = crossings;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        hits[i] = {};
        for (const std::uint32_t k : unbounded_) {
            const Instance& instance = instances_[k];
            const Ray local = to_local(instance, rays[i]);
            for (std::uint32_t part = 0; part < geometry::parts(*instance.shape); ++part) {
                ++query.counts.shape_tests;
                if (!shadows || instance.opaque) {
                    nearest_in_part(instance, k, part, local, hits[i], shadows ? Sense::light : Sense::eye);
                } else {
                    all_in_part(instance, k, part, local, static_cast<std::uint32_t>(i), *crossings);
                }
            }
        }
    }
    if (!empty_) {
        EmbreeRays<shadows> embree_rays;
        for (int lane = 0; lane < packet; ++lane) {
            auto& ray = rays_of(embree_rays);
            ray.time[lane] = 0, ray.mask[lane] = ~0u, ray.id[lane] = static_cast<unsigned>(lane), ray.flags[lane] = 0;
        }
        // Packets also for incoherent rays: single ones were 8 % faster on the sphereflake, but 14 % slower in glass.
        for (std::size_t first = 0; first < rays.size(); first += packet) {
            query.rays = rays.data() + first;
            query.hits = hits.data() + first;
            query.first_ray = static_cast<std::uint32_t>(first);
            const std::size_t first_crossing = shadows ? crossings->size() : 0;
            trace_packet<shadows>(query, embree_rays, static_cast<int>(std::min<std::size_t>(packet, rays.size() - first)));
            if constexpr (shadows) {
                if (crossings->size() > first_crossing) drop_repeated(*crossings, first_crossing);
            }
        }
    }
    counts += query.counts;
}

void Embree::nearest(std::span<const Ray> rays, std::span<Hit> hits, Coherence coherence, TestCounts& counts) const {
    trace<false>(rays, hits, nullptr, coherence, counts);
}

void Embree::shadow(std::span<const Ray> rays, std::span<Hit> occluders, std::vector<Crossing>& crossings, Coherence coherence,
                    TestCounts& counts) const {
    trace<true>(rays, occluders, &crossings, coherence, counts);
}

std::size_t Embree::bytes() const {
    std::size_t total = 0;
    for (const auto& set : sets_) total += set->primitives.capacity() * sizeof(Primitive);
    for (const auto& [shape, clusters] : clusters_) total += clusters->capacity() * sizeof(TriangleCluster);
    return total;
}

}  // namespace

Expected<std::unique_ptr<Accelerator>> make_embree(std::span<const Instance> instances, const Accelerator* before, std::span<const geometry::Shape* const> reshaped) {
    auto embree = std::make_unique<Embree>(instances);
    if (const auto* same_kind = dynamic_cast<const Embree*>(before)) embree->take_clusters(*same_kind, reshaped);
    if (auto built = embree->build(); !built) return tl::unexpected(built.error());
    return embree;
}

}  // namespace crescente::accel
