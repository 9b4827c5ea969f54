#include "geometry/mesh.h"

#include "geometry/triangle.h"

namespace crescente::geometry {

Bounds Mesh::bounds() const {
    Bounds box;
    for (const auto& triangle : triangles) {
        for (const std::uint32_t i : triangle) box.include(positions[i]);
    }
    return box;
}

Bounds Mesh::part_bounds(std::uint32_t part) const {
    Bounds box;
    for (const std::uint32_t i : triangles[part]) box.include(positions[i]);
    return box;
}

std::optional<ShapeHit> Mesh::intersect(std::uint32_t part, const Ray& ray) const {
    const auto& triangle = triangles[part];
    const Vec3 p = positions[triangle[0]], q = positions[triangle[1]], r = positions[triangle[2]];
    const RayView view(ray.origin, ray.direction);
    const TriangleSides<double> sides = triangle_sides(point3(p), point3(q), point3(r), view);
    const bool inside = (sides.u >= 0 && sides.v >= 0 && sides.w >= 0) || (sides.u <= 0 && sides.v <= 0 && sides.w <= 0);
    if (!inside) return std::nullopt;
    const double t = triangle_parameter(sides, point3(p), point3(q), point3(r), view, point3(ray.origin), point3(ray.direction));
    if (!(t > ray.t_min && t <= ray.t_max) || !confirmed(sides, p, q, r, ray.origin, ray.direction)) return std::nullopt;
    return ShapeHit{t, part};
}

SurfacePoint Mesh::surface(std::uint32_t primitive, Vec3 position) const {
    const auto& [p, q, r] = triangles[primitive];
    const auto at = triangle_surface(point3(positions[p]), point3(positions[q]), point3(positions[r]), point3(position));
    SurfacePoint point;
    point.position = vec3(at.position);
    point.normal = point.shading_normal = vec3(at.normal);
    point.error = at.error;
    point.u = at.u, point.v = at.v;
    if (!normals.empty()) {
        const auto corner = [&](int k) { return point3(corner_normal(primitive, k)); };
        point.shading_normal = vec3(interpolated_normal(corner(0), corner(1), corner(2), at.u, at.v, at.normal));
    }
    point.slot = slot(primitive);
    return point;
}

const FieldTable<Mesh>& Mesh::fields() {
    static const FieldTable<Mesh> table;
    return table;
}

}  // namespace crescente::geometry
