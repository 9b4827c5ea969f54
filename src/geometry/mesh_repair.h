// Makes a mesh from a file safe to trace, and says what was wrong with it.
#pragma once

#include <cstddef>

#include "geometry/mesh.h"

namespace crescente::geometry {

// What was removed; each triangle is counted once, for the first reason in this order.
struct MeshRepair {
    std::size_t out_of_range = 0;   // triangles with an index that no position has
    std::size_t not_finite = 0;     // triangles with a corner that is infinite or not a number
    std::size_t zero_area = 0;      // triangles whose corners are on one line
    bool normals_dropped = false;   // normals whose number fits neither positions nor corners, or that are not finite
    bool slots_dropped = false;     // slots whose number is not that of the triangles

    std::size_t triangles() const { return out_of_range + not_finite + zero_area; }
};

// Removes the triangles that cannot be traced, with their slots and normals; order and positions of the rest stay.
MeshRepair repair(Mesh& mesh);

}  // namespace crescente::geometry
