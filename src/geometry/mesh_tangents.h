// Tangents of meshes that come with texture coordinates, but without tangents.
#pragma once

#include "geometry/mesh.h"

namespace crescente::geometry {

// Gives every position the direction in which u grows, as smooth as the normals: of the triangles about it, each laid into the plane of the vertex's normal and weighed by its angle there,
// with those whose coordinates are mirrored apart, whose positions are doubled (what Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited", and his MikkTSpace do, without
// their order of operations: not to the bit). Corners that are alike become one vertex first, so that files without indices get smooth tangents too. Does nothing unless the mesh has coordinates of set 0 and normals, and no tangents. Where coordinates do not change, the tangent is zero.
void add_tangents(Mesh& mesh);

}  // namespace crescente::geometry
