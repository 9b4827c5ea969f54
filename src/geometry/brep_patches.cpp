// Faces of a Brep on spline surfaces.
#include <algorithm>
#include <cmath>

#include "geometry/bernstein.h"
#include "geometry/brep.h"

namespace crescente::geometry {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// About how far a step in u and v goes at least on each patch, by the sides of its control net. Half of that is taken, since the net is not the surface. A
// net that is folded or shrinks to a point somewhere would make bands as wide as the patch, mostly where the face is not: there is a floor.
struct PatchSteps {
    ParameterBox box;
    Point2 step;
};

PatchSteps patch_steps(const BezierPatch& patch, const Frame* axis) {
    const auto place = [&](int i, int j) { return patch.at(i, j).weighted / patch.at(i, j).weight; };
    const double per_u = patch.degree_u / (patch.u1 - patch.u0), per_v = patch.degree_v / (patch.v1 - patch.v0);
    double least_u = infinity, least_v = infinity, least_sine = 1, least_radius = infinity, sum_u = 0, sum_v = 0;
    for (int i = 0; i <= patch.degree_u; ++i) {
        for (int j = 0; j <= patch.degree_v; ++j) {
            const Vec3 p = place(i, j);
            const Vec3 along_u = i < patch.degree_u ? place(i + 1, j) - p : p - place(i - 1, j), along_v = j < patch.degree_v ? place(i, j + 1) - p : p - place(i, j - 1);
            const double a = length(along_u), b = length(along_v);
            least_u = std::min(least_u, a), least_v = std::min(least_v, b);
            sum_u += a, sum_v += b;
            if (a > 0 && b > 0) least_sine = std::min(least_sine, length(cross(along_u, along_v)) / (a * b));
            if (axis) least_radius = std::min(least_radius, length(cross(p - axis->origin, axis->z)));
        }
    }
    constexpr double floor = 0.02, floor_of_sine = 0.2;
    const double count = static_cast<double>(patch.points.size());
    least_u = std::max(least_u, floor * sum_u / count), least_v = std::max(least_v, floor * sum_v / count), least_sine = std::max(least_sine, floor_of_sine);
    const ParameterBox box{std::min(patch.u0, patch.u1), std::max(patch.u0, patch.u1), std::min(patch.v0, patch.v1), std::max(patch.v0, patch.v1)};
    if (axis) return {box, {0.5 * least_radius, 0.5 * least_v * per_v}};
    return {box, {0.5 * least_sine * least_u * per_u, 0.5 * least_sine * least_v * per_v}};
}

bool sound(const BezierPatch& patch) {
    const int p = patch.degree_u, q = patch.degree_v;
    if (p < 1 || q < 1 || p > max_patch_degree || q > max_patch_degree || patch.points.size() != std::size_t(p + 1) * (q + 1)) return false;
    if (!std::isfinite(patch.u0) || !std::isfinite(patch.u1) || !std::isfinite(patch.v0) || !std::isfinite(patch.v1)) return false;
    return std::all_of(patch.points.begin(), patch.points.end(), [](const ControlPoint& c) {
        return c.weight > 0 && std::isfinite(c.weight) && is_finite(c.weighted) && is_finite(c.weighted / c.weight);
    });
}

// Angle about the axis, from -pi to pi.
double angle(const Frame& axis, Vec3 position) {
    const Vec3 p = position - axis.origin;
    return std::atan2(dot(p, axis.y), dot(p, axis.x));
}

}  // namespace

Expected<void> Brep::add_patches(const Face& face, const PatchSurface& surface) {
    if (surface.patches.empty()) return failure(ErrorKind::input, {"", "", "a spline surface without patches", ""});
    for (std::size_t i = 0; i < surface.patches.size(); ++i) {
        if (!sound(surface.patches[i])) {
            return failure(ErrorKind::input, {"", "patch " + std::to_string(i), "a degree out of range, a weight that is not positive or numbers that are not finite", ""});
        }
    }
    const Frame* axis = surface.revolved ? &*surface.revolved : nullptr;
    std::vector<PatchSteps> steps;
    for (const BezierPatch& patch : surface.patches) steps.push_back(patch_steps(patch, axis));
    const auto least = [&](const ParameterBox& box) {
        Point2 step{infinity, infinity};
        for (const PatchSteps& s : steps) {
            const bool apart = s.box.v1 < box.v0 || s.box.v0 > box.v1 || (!axis && (s.box.u1 < box.u0 || s.box.u0 > box.u1));
            if (!apart) step = {std::min(step.u, s.step.u), std::min(step.v, s.step.v)};
        }
        return step.u < infinity ? step : Point2{0, 0};
    };
    auto trimming = Trimming::make(face, {axis ? 2 * pi : 0, 0}, least);
    if (!trimming) return tl::unexpected(trimming.error());

    // Turned about an axis, u of the patches is not the face's.
    const auto outside = [&](ParameterBox range) {
        if (axis) range.u0 = trimming->reach().u0, range.u1 = trimming->reach().u1;
        return trimming->all_outside(range);
    };
    Patches patches{surface, PatchLeaves(surface.patches, 0.5 * grazing_reach * trimming->widest_band(), outside)};
    const auto index = static_cast<std::uint32_t>(faces_.size()), set = static_cast<std::uint32_t>(patches_.size());
    const std::size_t first = leaves_.size();
    for (std::uint32_t leaf = 0; leaf < patches.leaves.count(); ++leaf) leaves_.push_back({patches.leaves.bounds(leaf), index, leaf});
    if (leaves_.size() == first) return failure(ErrorKind::input, {"", "", "loops that lie beside the surface", ""});
    faces_.push_back({{}, set, face.reversed, face.slot, face.shell, std::move(*trimming)});
    patches_.push_back(std::move(patches));
    return {};
}

// direction: of the ray that is to find the edges' bands as wide as it sees them; zero: as wide as they are.
Trimming::Located Brep::locate_patch(const Leaf& leaf, const TrimmedFace& face, const PatchRoot& root, Vec3 position, Vec3 direction) const {
    const Patches& patches = patches_[face.patches];
    const Frame* axis = patches.plain.revolved ? &*patches.plain.revolved : nullptr;
    const auto metric = [&](Point2) -> Metric {
        const Tangents t = tangents(leaf, face, {root.u, root.v}, position);
        return direction == Vec3{} ? metric_of(t.along_u, t.along_v) : metric_seen_along(direction, t.along_u, t.along_v);
    };
    return face.trimming.locate({axis ? angle(*axis, position) : root.u, root.v}, metric);
}

std::optional<ShapeHit> Brep::meet_patch(std::uint32_t part, const TrimmedFace& face, const Ray& ray) const {
    constexpr int room = 8;
    const Leaf& leaf = leaves_[part];
    PatchRoot roots[room];
    Ray rest = ray;
    while (true) {
        const int count = patches_[face.patches].leaves.roots(leaf.patch_leaf, rest, roots);
        for (int i = 0; i < count; ++i) {
            const auto located = locate_patch(leaf, face, roots[i], ray.at(roots[i].t), ray.direction);
            if (located.place == Place::outside || (located.near_edge && !counts(part, ray, roots[i].t, {roots[i].u, roots[i].v}, located))) continue;
            return ShapeHit{roots[i].t, part};
        }
        if (count < room) return std::nullopt;
        rest.t_min = roots[room - 1].t;
    }
}

SurfacePoint Brep::patch_surface(const Leaf& leaf, const TrimmedFace& face, Vec3 position) const {
    const Patches& patches = patches_[face.patches];
    SurfacePoint point = patches.leaves.surface(leaf.patch_leaf, position);
    if (patches.plain.revolved) {
        const Point2 at = locate_patch(leaf, face, {0, point.u, point.v}, point.position, {}).at;
        point.u = at.u, point.v = at.v;
    }
    return point;
}

}  // namespace crescente::geometry
