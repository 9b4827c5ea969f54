#include "io/polygon_collector.h"

namespace crescente::io {
namespace {

using geometry::Vec3;
using math::cross;
using math::dot;

// Twice the vector area of the ring (Newell; Sutherland, Sproull and Schumacker 1974): its direction is the normal.
Vec3 vector_area(std::span<const Vec3> ring) {
    Vec3 sum;
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) sum += cross(ring[i] - ring[0], ring[i + 1] - ring[0]);
    return sum;
}

// Every corner turns left, and from the first point the others are swept once.
bool is_convex_about(std::span<const Vec3> ring, Vec3 area) {
    const std::size_t n = ring.size();
    if (n == 3) return true;
    const double tolerance = -1e-6 * dot(area, area);
    double swept = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 a = ring[i], b = ring[(i + 1) % n], c = ring[(i + 2) % n];
        if (dot(cross(b - a, c - b), area) < tolerance) return false;
        if (i == 0 || i + 1 == n) continue;
        const Vec3 p = a - ring[0], q = b - ring[0];
        const double turn = dot(cross(p, q), area);
        if (turn < tolerance) return false;  // a star
        swept += std::atan2(turn / length(area), dot(p, q));
    }
    return swept < math::pi + 1e-6;
}

bool is_planar(std::span<const Vec3> ring, Vec3 normal) {
    double extent = 0, deviation = 0;
    for (const Vec3 p : ring) {
        extent = std::max(extent, length(p - ring[0]));
        deviation = std::max(deviation, std::abs(dot(p - ring[0], normal)));
    }
    return deviation <= 1e-4 * extent;
}

geometry::Polygon flattened(std::span<const Vec3> ring, Vec3 normal) {
    Vec3 centre;
    for (const Vec3 p : ring) centre += p / static_cast<double>(ring.size());
    geometry::Polygon polygon;
    auto& loop = polygon.loops.emplace_back();
    loop.reserve(ring.size());
    for (const Vec3 p : ring) loop.push_back(p - normal * dot(p - centre, normal));
    return polygon;
}

bool has_area(Vec3 area) {
    const double squared = dot(area, area);
    return squared > 0 && std::isfinite(squared);
}

void add_corner_normal(geometry::Mesh& mesh, Vec3 normal, Vec3 face) {
    const double l = length(normal);
    const Vec3 unit = l > 0 && std::isfinite(l) ? normal / l : normalize(face);
    mesh.normals.push_back({static_cast<float>(unit.x), static_cast<float>(unit.y), static_cast<float>(unit.z)});
}

}  // namespace

bool is_convex(std::span<const Vec3> ring) { return is_convex_about(ring, vector_area(ring)); }

void PolygonCollector::add(std::span<const Vec3> points, std::span<const Vec3> normals) {
    const Vec3 area = vector_area(points);
    if (!has_area(area)) {
        ++without_area;
        return;
    }
    if (!is_convex_about(points, area)) {
        const Vec3 normal = normalize(area);
        if (!is_planar(points, normal)) ++not_planar;
        if (!normals.empty()) ++normals_lost;
        polygons.push_back(flattened(points, normal));
        return;
    }
    geometry::Mesh& mesh = normals.empty() ? flat : smooth;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), points.begin(), points.end());
    for (std::uint32_t i = 1; i + 1 < points.size(); ++i) {
        const Vec3 face = cross(points[i] - points[0], points[i + 1] - points[0]);
        if (!has_area(face)) continue;  // points in a row: the other triangles of the fan cover the face
        mesh.triangles.push_back({first, first + i, first + i + 1});
        if (normals.empty()) continue;
        for (const std::uint32_t corner : {0u, i, i + 1}) add_corner_normal(mesh, normals[corner], face);
    }
}

}  // namespace crescente::io
