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
    const auto& triangle = triangles[primitive];
    const Vec3 a = positions[triangle[0]], b = positions[triangle[1]], c = positions[triangle[2]];
    const Vec3 ab = b - a, ac = c - a, ap = position - a;
    const Vec3 normal = exact_cross(ab, ac);
    const double area2 = dot(normal, normal);
    SurfacePoint point;
    point.normal = normal / std::sqrt(area2);
    point.position = position - point.normal * dot(point.normal, ap);
    // Rounding of the coordinates, and of the edges: the latter tilts the normal, the more the narrower the triangle.
    const double tilt = std::sqrt(dot(ab, ab) * dot(ac, ac) / area2);
    const double largest = std::max({max_component(abs(a)), max_component(abs(b)), max_component(abs(c))});
    point.error = std::numeric_limits<double>::epsilon() * (8 * largest + 4 * tilt * length(ap));
    point.u = std::clamp(dot(cross(ap, ac), normal) / area2, 0.0, 1.0);
    point.v = std::clamp(dot(cross(ab, ap), normal) / area2, 0.0, 1.0 - point.u);
    point.shading_normal = point.normal;
    if (!normals.empty()) {
        const bool per_corner = normals.size() == 3 * triangles.size();
        const double weights[3] = {1.0 - point.u - point.v, point.u, point.v};
        Vec3 sum;
        for (int k = 0; k < 3; ++k) {
            const auto& n = normals[per_corner ? 3 * std::size_t{primitive} + k : triangle[k]];
            sum += Vec3{n[0], n[1], n[2]} * weights[k];
        }
        const double l = length(sum);
        if (l > 0 && std::isfinite(l)) point.shading_normal = sum / l;
    }
    point.slot = slots.empty() ? 0 : slots[primitive];
    return point;
}

const FieldTable<Mesh>& Mesh::fields() {
    static const FieldTable<Mesh> table;
    return table;
}

}  // namespace crescente::geometry
