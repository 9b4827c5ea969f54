#include "geometry/mesh_repair.h"

#include <algorithm>
#include <cmath>

#include "geometry/triangle.h"

namespace crescente::geometry {

MeshRepair repair(Mesh& mesh) {
    MeshRepair found;
    const std::size_t count = mesh.triangles.size();
    const auto usable = [](const std::array<float, 3>& n) { return std::isfinite(n[0]) && std::isfinite(n[1]) && std::isfinite(n[2]); };
    const bool per_position = mesh.normals.size() == mesh.positions.size(), per_corner = mesh.normals.size() == 3 * count;
    if (!mesh.normals.empty() && (!(per_position || per_corner) || !std::all_of(mesh.normals.begin(), mesh.normals.end(), usable))) {
        mesh.normals.clear();
        found.normals_dropped = true;
    }
    if (!mesh.slots.empty() && mesh.slots.size() != count) {
        mesh.slots.clear();
        found.slots_dropped = true;
    }
    // Mesh tells the two layouts of normals apart by their number alone, as here: corners where both fit.
    const bool corner_normals = !mesh.normals.empty() && per_corner;

    std::size_t kept = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const auto triangle = mesh.triangles[i];
        const auto in_range = [&](std::uint32_t k) { return k < mesh.positions.size(); };
        if (!std::all_of(triangle.begin(), triangle.end(), in_range)) {
            ++found.out_of_range;
            continue;
        }
        const Vec3 a = mesh.positions[triangle[0]], b = mesh.positions[triangle[1]], c = mesh.positions[triangle[2]];
        if (!is_finite(a) || !is_finite(b) || !is_finite(c)) {
            ++found.not_finite;
            continue;
        }
        if (!has_area(a, b, c)) {
            ++found.zero_area;
            continue;
        }
        mesh.triangles[kept] = triangle;
        if (!mesh.slots.empty()) mesh.slots[kept] = mesh.slots[i];
        if (corner_normals) std::copy_n(mesh.normals.begin() + 3 * i, 3, mesh.normals.begin() + 3 * kept);
        ++kept;
    }
    if (!corner_normals && 3 * kept == mesh.normals.size() && kept != count) {
        // One normal a position would now be taken for one a corner: say the latter outright.
        std::vector<std::array<float, 3>> corners;
        corners.reserve(3 * kept);
        for (std::size_t i = 0; i < kept; ++i) {
            for (const std::uint32_t k : mesh.triangles[i]) corners.push_back(mesh.normals[k]);
        }
        mesh.normals = std::move(corners);
    }
    mesh.triangles.resize(kept);
    if (!mesh.slots.empty()) mesh.slots.resize(kept);
    if (corner_normals) mesh.normals.resize(3 * kept);
    return found;
}

}  // namespace crescente::geometry
