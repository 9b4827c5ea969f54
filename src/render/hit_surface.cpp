#include "render/hit_surface.h"

#include <cstring>

#include "geometry/triangle.h"

namespace crescente::render {
namespace {

using accel::Hit;
using accel::Instance;
using geometry::Ray;

// The surface in the shape's own space carried to the world's, before it is turned to the ray.
struct Carried {
    Vec3Lanes position, geometric, shading;
    Lanes error;  // bound on the distance of position from the true surface, without the rounding of its own coordinates
    std::uint32_t slot[lane_count];

    void put(unsigned lanes, const Vec3Lanes& at, const Vec3Lanes& normal, const Vec3Lanes& shading_normal, const Lanes& bound) {
        position = blend(lanes, at, position), geometric = blend(lanes, normal, geometric), shading = blend(lanes, shading_normal, shading);
        error = blend(lanes, bound, error);
    }
};

struct RayLanes {
    Vec3Lanes origin, direction;
    Lanes t;

    RayLanes(const Ray* rays, const Hit* hits, unsigned found) {
        Lanes rows[lane_count];
        const int first = __builtin_ctz(found);
        for (int i = 0; i < lane_count; ++i) {
            const int from = found >> i & 1 ? i : first;
            std::memcpy(&rows[i], &rays[from], sizeof(Lanes));
            t[i] = hits[from].t;
        }
        transpose(rows);
        origin = {rows[0], rows[1], rows[2]};
        direction = {rows[3], rows[4], rows[5]};
    }
};

constexpr double epsilon = std::numeric_limits<double>::epsilon();

Vec3Lanes columns(const Affine& m, const Vec3Lanes& v) {
    return {m.x.x * v.x + m.y.x * v.y + m.z.x * v.z, m.x.y * v.x + m.y.y * v.y + m.z.y * v.z, m.x.z * v.x + m.y.z * v.y + m.z.z * v.z};
}
Vec3Lanes rows(const Affine& m, const Vec3Lanes& v) {
    return {m.x.x * v.x + m.x.y * v.y + m.x.z * v.z, m.y.x * v.x + m.y.y * v.y + m.y.z * v.z, m.z.x * v.x + m.z.y * v.y + m.z.z * v.z};
}

// Lanes that met one mesh in one place.
void at_mesh(const Instance& instance, const geometry::Mesh& mesh, const RayLanes& rays, const Hit* hits, unsigned lanes, Carried& to) {
    Vec3Lanes corners[3], normals[3];
    const int first = __builtin_ctz(lanes);
    for (int i = 0; i < lane_count; ++i) {
        const std::uint32_t triangle = hits[lanes >> i & 1 ? i : first].primitive;
        for (int k = 0; k < 3; ++k) {
            set_lane(corners[k], i, mesh.positions[mesh.triangles[triangle][k]]);
            if (!mesh.normals.empty()) set_lane(normals[k], i, mesh.corner_normal(triangle, k));
        }
    }
    const Affine &in = instance.to_local, &out = instance.to_world;
    const Vec3Lanes shift = broadcast(in.origin), place = broadcast(out.origin);
    const Vec3Lanes origin = (instance.translation ? rays.origin : columns(in, rays.origin)) + shift;
    const Vec3Lanes direction = instance.translation ? rays.direction : columns(in, rays.direction);
    const auto at = geometry::triangle_surface(corners[0], corners[1], corners[2], origin + direction * rays.t);
    Vec3Lanes shading = at.normal, position = at.position, geometric = at.normal;
    Lanes error = at.error;
    if (!mesh.normals.empty()) shading = geometry::interpolated_normal(normals[0], normals[1], normals[2], at.u, at.v, at.normal);
    if (!instance.translation) {
        position = columns(out, position);
        geometric = normalize(rows(in, geometric));
        shading = normalize(rows(in, shading));
        error *= instance.stretch;
    }
    if (!instance.identity) {
        position = position + place;
        error += 16 * epsilon * max_component(abs(out.origin));
    }
    to.put(lanes, position, geometric, shading, error);
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        to.slot[i] = mesh.slot(hits[i].primitive);
    }
}

// Lanes that met spheres which are only moved.
void at_spheres(const World& world, const RayLanes& rays, const Hit* hits, unsigned lanes, Carried& to) {
    Vec3Lanes center = rays.origin;
    Lanes radius = Lanes{} + 1.0;
    for (unsigned rest = lanes; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        const Instance& instance = world.instances[hits[i].instance];
        set_lane(center, i, instance.to_world.origin);
        radius[i] = std::get<geometry::Sphere>(*instance.shape).radius;
        to.slot[i] = 0;
    }
    const Vec3Lanes normal = geometry::sphere_normal((rays.origin - center) + rays.direction * rays.t);
    to.put(lanes, normal * radius + center, normal, normal, 4 * epsilon * radius + 16 * epsilon * largest_component(center));
}

// Any other shape.
void at_shape(const Instance& instance, const Ray& ray, const Hit& hit, int lane, Carried& to) {
    const Ray local = accel::to_local(instance, ray);
    const geometry::SurfacePoint surface = geometry::surface(*instance.shape, hit.primitive, local.at(hit.t));
    Vec3 position = surface.position, geometric = surface.normal, shading = surface.shading_normal;
    double error = surface.error;
    if (!instance.identity) {
        position = instance.to_world.point(position);
        geometric = normalize(instance.to_local.transposed(geometric));
        shading = normalize(instance.to_local.transposed(shading));
        error = error * instance.stretch + 16 * epsilon * max_component(abs(instance.to_world.origin));
    }
    set_lane(to.position, lane, position), set_lane(to.geometric, lane, geometric), set_lane(to.shading, lane, shading);
    to.error[lane] = error;
    to.slot[lane] = surface.slot;
}

}  // namespace

SurfaceLanes surfaces_at(const World& world, const Ray* rays, const Hit* hits, unsigned found) {
    SurfaceLanes result;
    if (!found) return result;
    const RayLanes lanes(rays, hits, found);
    Carried at;
    at.position = at.geometric = at.shading = lanes.direction, at.error = Lanes{};  // numbers in the lanes without a hit
    unsigned spheres = 0;
    for (unsigned rest = found; rest;) {
        const int i = __builtin_ctz(rest);
        const Instance& instance = world.instances[hits[i].instance];
        unsigned taken = 1u << i;
        if (const auto* mesh = std::get_if<geometry::Mesh>(instance.shape)) {
            for (int k = i + 1; k < lane_count; ++k) {
                if (rest >> k & 1 && hits[k].instance == hits[i].instance) taken |= 1u << k;
            }
            at_mesh(instance, *mesh, lanes, hits, taken, at);
        } else if (instance.translation && std::holds_alternative<geometry::Sphere>(*instance.shape)) {
            spheres |= taken;
        } else {
            at_shape(instance, rays[i], hits[i], i, at);
        }
        rest &= ~taken;
    }
    if (spheres) at_spheres(world, lanes, hits, spheres, at);

    // Several times the bound: a ray must start so far off that its own intersection with the same surface, with the rounding of that
    // computation, lies behind it.
    result.offset = 16.0 * (at.error + 16 * epsilon * largest_component(at.position));
    result.position = at.position;
    const LaneMask inside = dot(at.geometric, lanes.direction) > 0.0;
    result.inside = bits_of(inside) & found;
    result.geometric = select(inside, -at.geometric, at.geometric);
    Vec3Lanes& shading = result.shading;
    shading = select(dot(at.shading, result.geometric) < 0.0, -at.shading, at.shading);
    // An interpolated normal may turn from the viewer at silhouettes; bring it back to just visible.
    const Lanes facing = -dot(shading, lanes.direction);
    const LaneMask turned = facing < 1e-4;
    if (bits_of(turned) & found) shading = select(turned, normalize(shading - lanes.direction * (1e-4 - facing)), shading);
    for (unsigned rest = found; rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        result.material[i] = world.material(hits[i].instance, at.slot[i]);
    }
    return result;
}

}  // namespace crescente::render
