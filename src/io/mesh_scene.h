// A scene of one mesh, for formats that hold no more than that.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "geometry/mesh.h"
#include "geometry/polygon.h"
#include "io/formats.h"

namespace crescente::io {

// What a file of one mesh gives.
struct MeshContent {
    geometry::Mesh mesh;                       // normals empty: smooth ones are found, with edges where faces turn by more than 40 degrees
    std::vector<geometry::Polygon> polygons;   // faces that are not convex
    std::optional<math::Rgb> color;            // of the whole; none: the default material
    scene::Unit unit;
    bool z_up = false;                         // turned to y up
};

// Drops triangles without area (told in `warnings`), welds equal positions, finds missing normals, places the mesh in metres with y up.
// Errors (input): no triangle, coordinates that are not finite.
Expected<Loaded> scene_of(MeshContent content, const std::string& file_name, Problems warnings);

}  // namespace crescente::io
