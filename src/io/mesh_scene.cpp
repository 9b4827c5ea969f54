#include "io/mesh_scene.h"

#include "geometry/mesh_normals.h"
#include "geometry/mesh_repair.h"

namespace crescente::io {

Expected<Loaded> scene_of(MeshContent content, const std::string& file_name, Problems warnings) {
    const auto wrong = [&](std::string reason) { return failure(ErrorKind::input, {file_name, "", std::move(reason), ""}); };
    geometry::Mesh& mesh = content.mesh;
    const geometry::MeshRepair repaired = geometry::repair(mesh);
    if (repaired.not_finite > 0) return wrong(std::to_string(repaired.not_finite) + " triangles have coordinates that are not finite");
    if (repaired.out_of_range > 0) return wrong(std::to_string(repaired.out_of_range) + " triangles have vertices that are not there");
    if (repaired.zero_area > 0) {
        warnings.push_back({file_name, "", std::to_string(repaired.zero_area) + " triangles have no area and were dropped", ""});
    }
    if (mesh.triangles.empty() && content.polygons.empty()) return wrong("there is no triangle in this file");

    Loaded loaded;
    loaded.warnings = std::move(warnings);
    scene::Scene& scene = loaded.scene;
    scene.unit = content.unit;
    scene.roots.push_back({0});
    scene::Node& root = scene.nodes.emplace_back();
    root.transform = math::Affine::scaling({content.unit.metres, content.unit.metres, content.unit.metres});
    if (content.z_up) root.transform = math::Affine{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {}} * root.transform;
    if (content.color) {
        scene::PhysicalMaterial material;
        material.base_color = *content.color;
        scene.materials.push_back({"", material});
        root.materials.push_back({0});
    }
    if (!mesh.triangles.empty()) {
        geometry::weld_vertices(mesh);
        constexpr double crease_angle = 40 * math::pi / 180;
        if (mesh.normals.empty()) geometry::smooth_normals(mesh, crease_angle);
        root.shape = {0};
        scene.shapes.push_back({"", std::move(mesh)});
    }
    for (geometry::Polygon& polygon : content.polygons) {
        scene.nodes[0].children.push_back({static_cast<std::uint32_t>(scene.nodes.size())});
        scene.nodes.emplace_back().shape = {static_cast<std::uint32_t>(scene.shapes.size())};
        scene.shapes.push_back({"", std::move(polygon)});
    }
    return loaded;
}

}  // namespace crescente::io
