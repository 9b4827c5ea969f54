// Shared vertices and smooth normals for meshes from formats that know neither (STL).
#pragma once

#include "geometry/mesh.h"

namespace crescente::geometry {

// Makes one position of all that are equal to the bit (0 and -0 are equal), in the order of first use; positions that no
// triangle uses are dropped. Normals for each position become normals for each corner. Indices must be in range (mesh_repair.h).
void weld_vertices(Mesh& mesh);

// Replaces the normals: faces that share an edge at which their normals differ by at most crease_angle (radians, 0 to pi) look
// like one smooth surface, others meet in a sharp edge, as do faces at an edge of three or more, or of contrary orientation. A
// normal is the mean of its smooth neighbours at the vertex, weighted by their angles there (Thürmer, Wüthrich 1998, "Computing
// Vertex Normals from Polygonal Facets"). One normal is kept for each position if no edge is sharp, else one for each corner.
// Weld first. Indices must be in range; at most 2^32 / 3 triangles.
void smooth_normals(Mesh& mesh, double crease_angle);

}  // namespace crescente::geometry
