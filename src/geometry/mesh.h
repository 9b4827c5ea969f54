// Triangle mesh with shared vertices, optional smooth normals, a material slot for each triangle, and what textures go by.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/fields.h"
#include "geometry/shape.h"

namespace crescente::geometry {

struct Mesh {
    std::vector<Vec3> positions;
    std::vector<std::array<std::uint32_t, 3>> triangles;  // indices into positions, counter-clockwise from outside
    // Normals at the corners, unit length: empty, one for each position, or one for each corner (3 x triangles).
    std::vector<std::array<float, 3>> normals;
    std::vector<std::uint16_t> slots;  // material slot of each triangle; empty: all 0
    // For textures, each empty or one for each position. Coordinates: u to the right, v down the picture, from its upper left corner. Colours: linear RGB and
    // alpha. Tangents: unit vector of growing u, and the sign of cross(normal, tangent) that points up the picture.
    std::array<std::vector<std::array<float, 2>>, 2> coordinates{};
    std::vector<std::array<float, 4>> colors{};
    std::vector<std::array<float, 4>> tangents{};

    // Of a corner (0 to 2) of a triangle; the mesh must have normals.
    Vec3 corner_normal(std::uint32_t triangle, int corner) const {
        const std::size_t i = normals.size() == 3 * triangles.size() ? 3 * std::size_t{triangle} + corner : triangles[triangle][corner];
        return {normals[i][0], normals[i][1], normals[i][2]};
    }

    Bounds bounds() const;
    std::uint32_t parts() const { return static_cast<std::uint32_t>(triangles.size()); }
    Bounds part_bounds(std::uint32_t part) const;
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    std::uint32_t slot(std::uint32_t primitive) const { return slots.empty() ? 0 : slots[primitive]; }
    static const FieldTable<Mesh>& fields();  // none: a mesh comes from a file, or as the arrays that io/ reads
};

}  // namespace crescente::geometry
