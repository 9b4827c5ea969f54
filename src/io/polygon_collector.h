// Gathers the faces of a file, given one by one as rings of points, into few shapes: convex faces become triangles of one mesh for each
// material, the others stay polygons.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/polygon.h"

namespace crescente::io {

// Whether a fan of triangles from the first point covers the ring, seen along its mean normal; up to the rounding of printed numbers.
bool is_convex(std::span<const geometry::Vec3> ring);

class PolygonCollector {
public:
    // A ring of at least three points. `normals`: one for each point, or empty for a flat face; of any length, zero takes the face's.
    // Faces without area are dropped and counted. A face that is neither convex nor planar is flattened onto its mean plane and
    // counted; one with normals that is not convex loses them and is counted.
    void add(std::span<const geometry::Vec3> points, std::span<const geometry::Vec3> normals);

    geometry::Mesh flat;                       // triangles without normals
    geometry::Mesh smooth;                     // triangles with a normal at each corner
    std::vector<geometry::Polygon> polygons;   // what is not convex
    std::size_t without_area = 0, not_planar = 0, normals_lost = 0;

};

}  // namespace crescente::io
