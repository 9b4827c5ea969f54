#include "render/grain.h"

#include <cmath>

#include "render/textured_material.h"

namespace crescente::render {
namespace {

using scene::Grain;

// The directions of u and v on the surface; zero where it has no coordinates.
TexturePlace by_coordinates(const TexturePoint& point) { return places_of(scene::Texture{}, point).place[0]; }

// The axis laid onto the surface; where it stands upright on it, the next of the three axes of space.
Vec3 along_axis(Vec3 axis, Vec3 normal) {
    constexpr double upright = 0.15;
    const Vec3 ways[] = {axis, {axis.y, axis.z, axis.x}, {axis.z, axis.x, axis.y}};
    for (const Vec3 way : ways) {
        const Vec3 laid = way - normal * dot(way, normal);
        if (length(laid) > upright) return laid;
    }
    return perpendicular(normal);
}

// About the axis through the middle of the shape's box.
Vec3 around_axis(Vec3 axis, Vec3 normal, const TexturePoint& point) {
    const Bounds& box = *point.box;
    const Vec3 center = box.bounded() ? (box.lower + box.upper) * 0.5 : Vec3{};
    const Vec3 way = cross(axis, point.instance->to_local.point(point.position) - center), laid = way - normal * dot(way, normal);
    return length(laid) > 1e-6 * (length(way) + 1e-300) ? laid : Vec3{};
}

}  // namespace

Vec3 grain_direction(const scene::PhysicalMaterial& m, const std::vector<scene::TextureBinding>& bent, const TexturePoint& point) {
    const accel::Instance& instance = *point.instance;
    const auto* mesh = std::get_if<geometry::Mesh>(instance.shape);
    const bool has_coordinates = mesh && !mesh->coordinates[0].empty();
    const bool by_surface = m.grain == Grain::surface || (m.grain == Grain::automatic && has_coordinates);
    const Vec3 outward = point.inside ? -point.geometric : point.geometric;
    Vec3 right, up;
    if (by_surface && (has_coordinates || !mesh)) {
        const TexturePlace place = by_coordinates(point);
        right = place.right;
        up = cross(outward, right) * (dot(cross(outward, right), place.up) < 0 ? -1.0 : 1.0);
    } else {
        const Vec3 normal = normalize(instance.to_world.transposed(outward)), axis = normalize(m.grain_axis);
        const Vec3 way = m.grain == Grain::around ? around_axis(axis, normal, point) : along_axis(axis, normal);
        right = instance.to_world.vector(way);
        if (const double l = length(right); l > 0) right = right / l;
        up = cross(outward, right);
    }
    double x = std::cos(m.anisotropy_rotation), y = std::sin(m.anisotropy_rotation);
    for (const scene::TextureBinding& binding : bent) {
        const scene::Rgba value = texture_value(binding.texture, places_of(binding.texture, point), point);
        const double s = binding.texture.strength, dx = 1 + s * (2.0 * value.r - 2), dy = s * (2.0 * value.g - 1);
        const double turned = x * dx - y * dy;
        y = x * dy + y * dx, x = turned;
    }
    return right * x + up * y;
}

}  // namespace crescente::render
