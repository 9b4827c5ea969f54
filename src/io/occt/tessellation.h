// Faces as triangles.
#pragma once

#include <cstdint>

#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>

#include "geometry/mesh.h"

namespace crescente::io::occt {

// Triangulates every face of the shape (BRepMesh_IncrementalMesh) to stray from it by at most `deflection`, mm, and 20 degrees between neighbours.
void triangulate(const TopoDS_Shape& shape, double deflection);

// Appends the triangles of a face that was triangulated, with the normals of its surface at their corners; false if it has none.
bool append_triangles(const TopoDS_Face& face, std::uint16_t slot, geometry::Mesh& mesh);

}  // namespace crescente::io::occt
