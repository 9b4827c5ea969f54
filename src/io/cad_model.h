// A CAD model between its reader and the scene: parts of exact faces, the tree that places them, colours, and what was noticed on the way.
// Plain values; io/cad_messages.h carries them between processes and into the cache.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "geometry/face.h"
#include "geometry/mesh.h"
#include "math/color.h"
#include "math/transform.h"

namespace crescente::io {

// What a face's surface is in the file. Extrusions and revolutions that are a plane, cylinder, cone, sphere or torus become one, but count here
// as what the file says.
enum class CadSurface : std::uint8_t { plane, cylinder, cone, sphere, torus, revolution, extrusion, bspline, bezier, offset, other };
inline constexpr std::array<std::string_view, 11> cad_surface_names = {"plane",      "cylinder",  "cone",    "sphere", "torus", "revolution",
                                                                       "extrusion", "b-spline", "bezier", "offset", "other"};

struct CadColor {
    math::Rgb rgb{0.8f, 0.8f, 0.8f};  // linear Rec. 709
    float alpha = 1;                  // 0: invisible
    bool operator==(const CadColor&) const = default;
};

// Faces that move together, in millimetres, z up as in the file.
struct CadPart {
    static constexpr std::uint32_t no_color = 0xffffffff;

    std::string name;
    std::vector<geometry::Face> faces;
    std::vector<std::uint32_t> numbers;  // of the faces in the part, from 1, as messages count them
    geometry::Mesh mesh;                // faces that are shown through their tessellation; slots as in Face
    std::uint64_t unmatched_edges = 0;  // edges that bound one face only, seams and degenerate ones aside: 0 where the part is closed
};

// A place in the tree. A node that is the child of several is an instance in each of those places.
struct CadNode {
    std::string name;
    math::Affine transform;                        // to the parent's space
    std::uint32_t part = 0xffffffff;               // index, or none
    std::vector<std::uint32_t> colors;             // by the faces' slot: index, or CadPart::no_color
    std::vector<std::uint32_t> children;
    bool operator==(const CadNode&) const = default;
};

// Faces are counted once however often their part is shown, `shown` aside.
struct CadCounts {
    std::array<std::uint64_t, cad_surface_names.size()> faces{};  // by CadSurface, all of them
    std::uint64_t shown = 0;        // with every instance
    std::uint64_t exact = 0, approximated = 0, tessellated = 0, degenerate = 0, healed = 0;
    std::uint64_t patches = 0;
    double largest_tolerance = 0;   // mm, declared by edges
    double largest_gap = 0;         // mm, measured between the two sides of an edge
    bool operator==(const CadCounts&) const = default;
};

struct CadModel {
    std::string unit = "mm";      // of the file
    double unit_metres = 0.001;
    std::vector<CadPart> parts;
    std::vector<CadNode> nodes;
    std::vector<std::uint32_t> roots;
    std::vector<CadColor> colors;
    CadCounts counts;
    std::vector<std::string> referenced;  // other files that were read, as paths relative to the folder of the main file
    Problems warnings;
};

}  // namespace crescente::io
