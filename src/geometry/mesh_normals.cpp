#include "geometry/mesh_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace crescente::geometry {
namespace {

Vec3 area_normal(const Mesh& mesh, std::size_t triangle) {
    const auto& t = mesh.triangles[triangle];
    const Vec3 a = mesh.positions[t[0]];
    return cross(mesh.positions[t[1]] - a, mesh.positions[t[2]] - a);
}

Vec3 unit_or_zero(Vec3 v) {
    const double l = length(v);
    return l > 0 && std::isfinite(l) ? v / l : Vec3{};
}

// Angle of the triangle at its corner, in radians.
double corner_angle(const Mesh& mesh, std::size_t corner) {
    const auto& t = mesh.triangles[corner / 3];
    const std::size_t k = corner % 3;
    const Vec3 p = mesh.positions[t[k]];
    const Vec3 a = mesh.positions[t[(k + 1) % 3]] - p, b = mesh.positions[t[(k + 2) % 3]] - p;
    return std::atan2(length(cross(a, b)), dot(a, b));
}

// Sets of corners that share a normal (union-find with path halving; the smallest index represents a set).
class CornerSets {
public:
    explicit CornerSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a), b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::uint32_t> parent_;
};

struct Edge {
    std::uint32_t low, high;  // its positions
    std::uint32_t corner;     // where it starts in its triangle

    auto key() const { return std::tie(low, high, corner); }
};

std::vector<Edge> sorted_edges(const Mesh& mesh) {
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[i][k], b = mesh.triangles[i][(k + 1) % 3];
            edges.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(3 * i + k)});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) { return a.key() < b.key(); });
    return edges;
}

std::uint32_t next_corner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

}  // namespace

void weld_vertices(Mesh& mesh) {
    if (!mesh.normals.empty() && mesh.normals.size() != 3 * mesh.triangles.size()) {
        std::vector<std::array<float, 3>> corners;
        corners.reserve(3 * mesh.triangles.size());
        for (const auto& t : mesh.triangles) {
            for (const std::uint32_t i : t) corners.push_back(mesh.normals[i]);
        }
        mesh.normals = std::move(corners);
    }
    // Equal positions become neighbours; not-a-number has no place in an order, so those go last and stay apart.
    std::vector<std::uint32_t> order(mesh.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t i) {
        const Vec3& p = mesh.positions[i];
        return std::tie(p.x, p.y, p.z);
    };
    const auto nan = [&](std::uint32_t i) {
        const Vec3& p = mesh.positions[i];
        return std::isnan(p.x) || std::isnan(p.y) || std::isnan(p.z);
    };
    const auto numbers_end = std::stable_partition(order.begin(), order.end(), [&](std::uint32_t i) { return !nan(i); });
    std::stable_sort(order.begin(), numbers_end, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> same(mesh.positions.size());
    for (std::size_t i = 0; i < order.size(); ++i) {
        const bool equal = i > 0 && key(order[i - 1]) == key(order[i]);
        same[order[i]] = equal ? same[order[i - 1]] : order[i];
    }
    constexpr std::uint32_t unused = ~0u;
    std::vector<std::uint32_t> place(mesh.positions.size(), unused);
    std::vector<Vec3> positions;
    for (auto& t : mesh.triangles) {
        for (std::uint32_t& i : t) {
            std::uint32_t& p = place[same[i]];
            if (p == unused) {
                p = static_cast<std::uint32_t>(positions.size());
                positions.push_back(mesh.positions[i]);
            }
            i = p;
        }
    }
    mesh.positions = std::move(positions);
}

void smooth_normals(Mesh& mesh, double crease_angle) {
    const std::size_t corners = 3 * mesh.triangles.size();
    std::vector<Vec3> faces(mesh.triangles.size());
    for (std::size_t i = 0; i < faces.size(); ++i) faces[i] = unit_or_zero(area_normal(mesh, i));

    CornerSets sets(corners);
    const double least_cosine = std::cos(crease_angle) - 1e-12;  // an angle equal to the limit is smooth despite rounding
    const std::vector<Edge> edges = sorted_edges(mesh);
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t end = i + 1;
        while (end < edges.size() && edges[end].low == edges[i].low && edges[end].high == edges[i].high) ++end;
        if (end - i == 2 && edges[i].low != edges[i].high) {
            const std::uint32_t a = edges[i].corner, b = edges[i + 1].corner;
            const bool opposed = mesh.triangles[a / 3][a % 3] != mesh.triangles[b / 3][b % 3];  // as neighbours of one orientation are
            if (opposed && dot(faces[a / 3], faces[b / 3]) >= least_cosine) {
                sets.join(a, next_corner(b));
                sets.join(next_corner(a), b);
            }
        }
        i = end;
    }

    std::vector<Vec3> sums(corners);
    for (std::size_t c = 0; c < corners; ++c) sums[sets.find(static_cast<std::uint32_t>(c))] += faces[c / 3] * corner_angle(mesh, c);
    const auto normal_at = [&](std::size_t c) {
        const Vec3 n = unit_or_zero(sums[sets.find(static_cast<std::uint32_t>(c))]);
        const Vec3 used = n == Vec3{} ? faces[c / 3] : n;
        return std::array<float, 3>{static_cast<float>(used.x), static_cast<float>(used.y), static_cast<float>(used.z)};
    };

    // One set at each position? Then a normal a position says the same in a sixth of the memory.
    constexpr std::uint32_t none = ~0u;
    std::vector<std::uint32_t> set_of(mesh.positions.size(), none);
    bool sharp = mesh.positions.size() == corners;  // that many normals would be taken for those of corners
    for (std::size_t c = 0; c < corners && !sharp; ++c) {
        const std::uint32_t position = mesh.triangles[c / 3][c % 3], set = sets.find(static_cast<std::uint32_t>(c));
        if (set_of[position] == none) set_of[position] = set;
        sharp = set_of[position] != set;
    }
    mesh.normals.clear();
    mesh.normals.resize(sharp ? corners : mesh.positions.size());
    for (std::size_t c = 0; c < corners; ++c) mesh.normals[sharp ? c : mesh.triangles[c / 3][c % 3]] = normal_at(c);
}

}  // namespace crescente::geometry
