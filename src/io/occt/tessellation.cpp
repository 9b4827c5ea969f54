#include "io/occt/tessellation.h"

#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Geom_Surface.hxx>
#include <Poly_Triangulation.hxx>
#include <TopLoc_Location.hxx>

#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

using math::Vec3;
using namespace math;

std::array<float, 3> as_floats(Vec3 n) { return {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)}; }

}  // namespace

void triangulate(const TopoDS_Shape& shape, double deflection) {
    constexpr double angle = 20 * math::pi / 180;
    BRepMesh_IncrementalMesh(shape, deflection, false, angle, false);
}

bool append_triangles(const TopoDS_Face& face, std::uint16_t slot, geometry::Mesh& mesh) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation)& from = BRep_Tool::Triangulation(face, location);
    if (from.IsNull() || from->NbTriangles() == 0) return false;
    const Handle(Geom_Surface) surface = BRep_Tool::Surface(face);
    const bool reversed = face.Orientation() == TopAbs_REVERSED;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    std::vector<Vec3> normals(static_cast<std::size_t>(from->NbNodes()), Vec3{});
    for (int i = 1; i <= from->NbNodes(); ++i) {
        mesh.positions.push_back(vec(from->Node(i).Transformed(location.Transformation())));
        if (surface.IsNull() || !from->HasUVNodes()) continue;
        gp_Pnt at;
        gp_Vec du, dv;
        surface->D1(from->UVNode(i).X(), from->UVNode(i).Y(), at, du, dv);
        const Vec3 n = cross(vec(du.XYZ()), vec(dv.XYZ()));
        if (length(n) > 1e-12 * length(vec(du.XYZ())) * length(vec(dv.XYZ()))) normals[static_cast<std::size_t>(i - 1)] = normalize(n) * (reversed ? -1.0 : 1.0);
    }
    for (int i = 1; i <= from->NbTriangles(); ++i) {
        int a, b, c;
        from->Triangle(i).Get(a, b, c);
        if (reversed != (location.Transformation().VectorialPart().Determinant() < 0)) std::swap(b, c);
        std::array<std::uint32_t, 3> corners{};
        int k = 0;
        for (const int node : {a, b, c}) corners[static_cast<std::size_t>(k++)] = first + static_cast<std::uint32_t>(node - 1);
        const auto& p = mesh.positions;
        const Vec3 flat = cross(p[corners[1]] - p[corners[0]], p[corners[2]] - p[corners[0]]);
        if (!(length(flat) > 0)) continue;
        for (const std::uint32_t corner : corners) {  // a pole has no normal of its own: there the triangle's serves
            const Vec3 n = normals[corner - first];
            mesh.normals.push_back(as_floats(n == Vec3{} ? normalize(flat) : n));
        }
        mesh.triangles.push_back(corners);
        mesh.slots.push_back(slot);
    }
    return true;
}

}  // namespace crescente::io::occt
