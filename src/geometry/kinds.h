// The table of shapes. Adding one: a file pair beside this one, and one line in each list here.
#pragma once

#include <string_view>
#include <variant>

#include "geometry/bicubic.h"
#include "geometry/box.h"
#include "geometry/brep.h"
#include "geometry/cone.h"
#include "geometry/cylinder.h"
#include "geometry/disk.h"
#include "geometry/mesh.h"
#include "geometry/nurbs.h"
#include "geometry/plane.h"
#include "geometry/polygon.h"
#include "geometry/sphere.h"
#include "geometry/swept.h"
#include "geometry/torus.h"

namespace crescente::geometry {

using Shape = std::variant<Sphere, Box, Cone, Cylinder, Torus, Disk, Plane, Polygon, Mesh, Bicubic, Nurbs, Revolution, Extrusion, Ruled, Brep>;

// Names in files, in the order of the variant.
inline constexpr std::string_view shape_names[] = {"sphere", "box", "cone", "cylinder", "torus", "disk", "plane", "polygon", "mesh", "bicubic", "nurbs",
                                                  "revolution", "extrusion", "ruled", "brep"};
static_assert(std::size(shape_names) == std::variant_size_v<Shape>);

// Derives what rays need, for shapes that need more than their description. Before a shape is traced, and again after it was changed.
inline void prepare(Shape& shape) {
    std::visit([](auto& s) {
        if constexpr (requires { s.prepare(); }) s.prepare();
    }, shape);
}

// What a hit's primitive belongs to as users count: of a brep the face, of which it is one of perhaps several leaves; of others the primitive itself.
inline std::uint32_t face_number(const Shape& shape, std::uint32_t primitive) {
    const auto* brep = std::get_if<Brep>(&shape);
    return brep ? brep->face_of(primitive) : primitive;
}

// Which of the materials of an instance a primitive has: SurfacePoint::slot, without the rest of it.
inline std::uint32_t slot(const Shape& shape, std::uint32_t primitive) {
    return std::visit([=](const auto& s) -> std::uint32_t {
        if constexpr (requires { s.slot(primitive); }) return s.slot(primitive);
        else return 0;
    }, shape);
}

// The leaves of a shape that is made of patches, part by part; null for other shapes.
inline const PatchLeaves* patch_leaves(const Shape& shape) {
    return std::visit([](const auto& s) -> const PatchLeaves* {
        if constexpr (requires { s.leaves(); }) return s.leaves();
        else return nullptr;
    }, shape);
}

inline Bounds bounds(const Shape& shape) {
    return std::visit([](const auto& s) { return s.bounds(); }, shape);
}
inline std::uint32_t parts(const Shape& shape) {
    return std::visit([](const auto& s) { return s.parts(); }, shape);
}
inline Bounds part_bounds(const Shape& shape, std::uint32_t part) {
    return std::visit([=](const auto& s) { return s.part_bounds(part); }, shape);
}
inline std::optional<ShapeHit> intersect(const Shape& shape, std::uint32_t part, const Ray& ray) {
    return std::visit([&](const auto& s) { return s.intersect(part, ray); }, shape);
}
inline SurfacePoint surface(const Shape& shape, std::uint32_t primitive, Vec3 position) {
    return std::visit([=](const auto& s) { return s.surface(primitive, position); }, shape);
}

}  // namespace crescente::geometry
