#include "geometry/mesh_tangents.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace crescente::geometry {
namespace {

constexpr std::uint32_t none = ~0u;

// The direction of growing u times twice the area in the texture; the sign of that area is positive where u and v lie as in a picture seen from outside.
struct Gradient {
    Vec3 along_u;
    double area = 0;
};
Gradient gradient(const Mesh& mesh, const std::array<std::uint32_t, 3>& t) {
    const auto& uv = mesh.coordinates[0];
    const Vec3 e = mesh.positions[t[1]] - mesh.positions[t[0]], f = mesh.positions[t[2]] - mesh.positions[t[0]];
    // v is counted down the picture.
    const double eu = double{uv[t[1]][0]} - uv[t[0]][0], ev = double{uv[t[0]][1]} - uv[t[1]][1], fu = double{uv[t[2]][0]} - uv[t[0]][0], fv = double{uv[t[0]][1]} - uv[t[2]][1];
    const double area = eu * fv - fu * ev;
    return {(e * fv - f * ev) * (area < 0 ? -1.0 : 1.0), area};
}

double angle_at(const Mesh& mesh, const std::array<std::uint32_t, 3>& t, std::size_t corner) {
    const Vec3 p = mesh.positions[t[corner]], a = mesh.positions[t[(corner + 1) % 3]] - p, b = mesh.positions[t[(corner + 2) % 3]] - p;
    return std::atan2(length(cross(a, b)), dot(a, b));
}

template <class T>
void double_element(std::vector<T>& of, std::uint32_t i) {
    if (!of.empty()) of.push_back(T(of[i]));
}

// What the corners of triangles have in common that are one vertex.
struct Vertex {
    std::array<double, 3> position;
    std::array<float, 3> normal;
    std::array<float, 2> first, second;
    std::array<float, 4> color;

    auto operator<=>(const Vertex&) const = default;
};

// One position, with its normal and all else, for each vertex: files without indices have one for each corner.
void share_vertices(Mesh& mesh) {
    std::map<Vertex, std::uint32_t> known;
    Mesh shared;
    const auto keep = [](const auto& from, auto& to, std::uint32_t i) {
        if (!from.empty()) to.push_back(from[i]);
    };
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        auto& triangle = shared.triangles.emplace_back(mesh.triangles[t]);
        for (int k = 0; k < 3; ++k) {
            std::uint32_t& corner = triangle[static_cast<std::size_t>(k)];
            const Vec3 p = mesh.positions[corner], n = mesh.corner_normal(t, k);
            Vertex vertex{{p.x, p.y, p.z}, {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)}, mesh.coordinates[0][corner], {}, {}};
            if (!mesh.coordinates[1].empty()) vertex.second = mesh.coordinates[1][corner];
            if (!mesh.colors.empty()) vertex.color = mesh.colors[corner];
            const auto [at, is_new] = known.try_emplace(vertex, static_cast<std::uint32_t>(known.size()));
            if (is_new) {
                shared.positions.push_back(p), shared.normals.push_back(vertex.normal);
                for (std::size_t set = 0; set < 2; ++set) keep(mesh.coordinates[set], shared.coordinates[set], corner);
                keep(mesh.colors, shared.colors, corner);
            }
            corner = at->second;
        }
    }
    shared.slots = std::move(mesh.slots);
    mesh = std::move(shared);
}

// As many normals as corners would be taken for theirs.
void tell_normals_apart(Mesh& mesh) {
    if (mesh.normals.size() != 3 * mesh.triangles.size()) return;
    double_element(mesh.positions, 0), double_element(mesh.normals, 0), double_element(mesh.colors, 0);
    for (auto& set : mesh.coordinates) double_element(set, 0);
}

// Gives triangles with mirrored coordinates positions of their own.
void separate_mirrored(Mesh& mesh, const std::vector<bool>& mirrored) {
    const std::size_t count = mesh.positions.size();
    std::vector<bool> in_plain(count);
    std::vector<std::uint32_t> copy(count, none);
    const auto double_position = [&mesh](std::uint32_t i) {
        double_element(mesh.positions, i), double_element(mesh.normals, i), double_element(mesh.colors, i);
        for (auto& set : mesh.coordinates) double_element(set, i);
        return static_cast<std::uint32_t>(mesh.positions.size() - 1);
    };
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (const std::uint32_t corner : mesh.triangles[i]) in_plain[corner] = in_plain[corner] || !mirrored[i];
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        if (!mirrored[i]) continue;
        for (std::uint32_t& corner : mesh.triangles[i]) {
            if (!in_plain[corner]) continue;
            if (copy[corner] == none) copy[corner] = double_position(corner);
            corner = copy[corner];
        }
    }
}

}  // namespace

void add_tangents(Mesh& mesh) {
    if (mesh.coordinates[0].empty() || !mesh.tangents.empty() || mesh.normals.empty() || mesh.triangles.empty()) return;
    share_vertices(mesh);
    std::vector<bool> mirrored;
    for (const auto& t : mesh.triangles) mirrored.push_back(gradient(mesh, t).area < 0);
    separate_mirrored(mesh, mirrored);
    tell_normals_apart(mesh);
    std::vector<Vec3> sums(mesh.positions.size());
    std::vector<float> signs(mesh.positions.size(), 1);
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto& t = mesh.triangles[i];
        const Gradient g = gradient(mesh, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 normal = mesh.corner_normal(i, static_cast<int>(k)), laid = g.along_u - normal * dot(normal, g.along_u);
            const double size = length(laid);
            if (g.area != 0 && size > 0 && std::isfinite(size)) sums[t[k]] += laid * (angle_at(mesh, t, k) / size);
            if (mirrored[i]) signs[t[k]] = -1;
        }
    }
    mesh.tangents.resize(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const double size = length(sums[i]);
        const Vec3 t = size > 0 ? sums[i] / size : Vec3{};
        mesh.tangents[i] = {static_cast<float>(t.x), static_cast<float>(t.y), static_cast<float>(t.z), signs[i]};
    }
}

}  // namespace crescente::geometry
