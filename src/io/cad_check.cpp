#include "io/cad_check.h"

#include <algorithm>
#include <cmath>

namespace crescente::io {
namespace {

using namespace geometry;

constexpr int highest_degree = 60;
constexpr double most_places = 1e7;

template <class... Numbers>
bool finite(Numbers... numbers) {
    return (std::isfinite(numbers) && ...);
}
bool good(Point2 p) { return finite(p.u, p.v); }
bool good(const Frame& f) { return is_finite(f.origin) && is_finite(f.x) && is_finite(f.y) && is_finite(f.z); }

bool good(const BezierPatch& p) {
    const auto degree = [](int d) { return d >= 1 && d <= highest_degree; };
    if (!degree(p.degree_u) || !degree(p.degree_v) || !finite(p.u0, p.u1, p.v0, p.v1) || p.u1 <= p.u0 || p.v1 <= p.v0) return false;
    if (p.points.size() != static_cast<std::size_t>(p.degree_u + 1) * static_cast<std::size_t>(p.degree_v + 1)) return false;
    return std::all_of(p.points.begin(), p.points.end(), [&](const ControlPoint& c) {
        return is_finite(c.weighted) && std::isfinite(c.weight) && (p.rational ? c.weight > 0 : c.weight == 1);
    });
}

struct GoodSurface {
    bool operator()(const PlaneSurface& s) const { return good(s.frame); }
    bool operator()(const CylinderSurface& s) const { return good(s.frame) && finite(s.radius) && s.radius > 0; }
    bool operator()(const ConeSurface& s) const { return good(s.frame) && finite(s.radius, s.half_angle) && std::abs(s.half_angle) < math::pi / 2; }
    bool operator()(const SphereSurface& s) const { return good(s.frame) && finite(s.radius) && s.radius > 0; }
    bool operator()(const TorusSurface& s) const { return good(s.frame) && finite(s.major, s.minor) && s.minor > 0; }
    bool operator()(const PatchSurface& s) const {
        return !s.patches.empty() && std::all_of(s.patches.begin(), s.patches.end(), [](const auto& p) { return good(p); }) && (!s.revolved || good(*s.revolved));
    }
};

struct GoodPiece {
    bool operator()(const LinePiece& p) const { return good(p.from) && good(p.to); }
    bool operator()(const ArcPiece& p) const { return good(p.center) && good(p.x) && good(p.y) && finite(p.a0, p.a1); }
    bool operator()(const BezierPiece& p) const {
        return p.points.size() >= 2 && p.points.size() <= highest_degree + 1 &&
               std::all_of(p.points.begin(), p.points.end(), [](const auto& c) { return finite(c.u, c.v, c.weight) && c.weight > 0; });
    }
};

bool good(const Mesh& mesh) {
    const bool normals = mesh.normals.empty() || mesh.normals.size() == mesh.positions.size() || mesh.normals.size() == 3 * mesh.triangles.size();
    if (!normals || (!mesh.slots.empty() && mesh.slots.size() != mesh.triangles.size())) return false;
    const auto in_range = [&](const auto& triangle) { return *std::max_element(triangle.begin(), triangle.end()) < mesh.positions.size(); };
    return std::all_of(mesh.positions.begin(), mesh.positions.end(), [](math::Vec3 p) { return is_finite(p); }) &&
           std::all_of(mesh.normals.begin(), mesh.normals.end(), [](const auto& n) { return finite(n[0], n[1], n[2]); }) &&
           std::all_of(mesh.triangles.begin(), mesh.triangles.end(), in_range);
}

// Walks down from every node once; counts the places that the roots show.
class TreeCheck {
public:
    explicit TreeCheck(const CadModel& model) : model_(model), places_(model.nodes.size(), unseen) {}

    bool good() {
        double all = 0;
        for (std::uint32_t node = 0; node < model_.nodes.size(); ++node) {
            if (!count(node)) return false;
        }
        for (const std::uint32_t root : model_.roots) {
            if (root >= model_.nodes.size()) return false;
            all += places_[root];
        }
        return all <= most_places;
    }

private:
    static constexpr double unseen = -1, open = -2;

    bool count(std::uint32_t top) {
        struct Step {
            std::uint32_t node;
            std::size_t next = 0;
        };
        std::vector<Step> way;
        const auto enter = [&](std::uint32_t node) {
            if (places_[node] == unseen) places_[node] = open, way.push_back({node});
        };
        enter(top);
        while (!way.empty()) {
            const std::uint32_t node = way.back().node;
            const auto& children = model_.nodes[node].children;
            if (way.back().next < children.size()) {
                const std::uint32_t child = children[way.back().next++];
                if (child >= model_.nodes.size() || places_[child] == open) return false;
                enter(child);
            } else {
                double sum = 1;
                for (const std::uint32_t child : children) sum += places_[child];
                if (!(sum <= most_places)) return false;
                places_[node] = sum;
                way.pop_back();
            }
        }
        return true;
    }

    const CadModel& model_;
    std::vector<double> places_;  // of the tree below, itself included
};

}  // namespace

bool holds_together(const Face& face) {
    if (!finite(face.u0, face.u1, face.v0, face.v1) || face.u1 <= face.u0 || face.v1 <= face.v0 || !std::visit(GoodSurface{}, face.surface)) return false;
    return std::all_of(face.loops.begin(), face.loops.end(), [](const Loop& loop) {
        return !loop.empty() && std::all_of(loop.begin(), loop.end(), [](const LoopEdge& edge) {
            return finite(edge.band) && edge.band >= 0 && std::visit(GoodPiece{}, edge.piece);
        });
    });
}

bool holds_together(const CadModel& model) {
    if (!finite(model.unit_metres) || model.unit_metres <= 0) return false;
    const auto good_part = [](const CadPart& part) {
        return good(part.mesh) && part.numbers.size() == part.faces.size() && std::all_of(part.faces.begin(), part.faces.end(), [](const Face& f) { return holds_together(f); });
    };
    const auto good_node = [&](const CadNode& node) {
        const auto& t = node.transform;
        return is_finite(t.x) && is_finite(t.y) && is_finite(t.z) && is_finite(t.origin) && (node.part == CadNode{}.part || node.part < model.parts.size()) &&
               std::all_of(node.colors.begin(), node.colors.end(), [&](std::uint32_t c) { return c == CadPart::no_color || c < model.colors.size(); });
    };
    const auto good_color = [](const CadColor& c) { return finite(c.rgb.r, c.rgb.g, c.rgb.b, c.alpha); };
    return std::all_of(model.parts.begin(), model.parts.end(), good_part) && std::all_of(model.nodes.begin(), model.nodes.end(), good_node) &&
           std::all_of(model.colors.begin(), model.colors.end(), good_color) && TreeCheck(model).good();
}

}  // namespace crescente::io
