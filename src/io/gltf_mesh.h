// One mesh of a glTF file: all its primitives as one triangle mesh.
#pragma once

#include <optional>
#include <vector>

#include "geometry/mesh.h"
#include "io/gltf_document.h"

namespace crescente::io {

struct GltfMesh {
    geometry::Mesh mesh;
    std::vector<std::optional<std::size_t>> materials;  // of each slot: index in the file, or none
};

// What was left out, over all meshes of a file.
struct GltfMeshCounts {
    std::size_t lines_and_points = 0, degenerate = 0, bad_normals = 0, bad_attributes = 0, morph_targets = 0;
    std::size_t corners = 0;  // read so far; held against the size of the file
};

// What is wrong is told in document.problems. Without triangles the mesh is empty.
GltfMesh read_gltf_mesh(GltfDocument& document, std::size_t which, GltfMeshCounts& counts);

}  // namespace crescente::io
