#include "geometry/brep.h"

#include <algorithm>
#include <cmath>

#include "geometry/convex.h"

namespace crescente::geometry {
namespace {

// The points of a plane face's loops: tighter than the box of their parameters where the plane lies askew.
Bounds plane_bounds(const AnalyticSurface& plane, const Trimming& trimming) {
    Bounds box;
    const auto include = [&](Point2 p) { box.include(plane.position(p)); };
    trimming.for_each_piece([&](const MonotonePiece& piece, const LoopPiece* curve) {
        include(piece.from), include(piece.to);
        if (piece.is_line()) return;
        if (const auto* arc = std::get_if<ArcPiece>(curve)) {
            // The monotone stretch lies between its chord and the tangents at its ends: in the box of its ends, and in the ellipse's own.
            const Vec3 center = plane.position(arc->center), origin = plane.position({0, 0});
            const Vec3 x = plane.position(arc->x) - origin, y = plane.position(arc->y) - origin;
            Bounds rectangle;
            for (const double u : {piece.from.u, piece.to.u}) {
                for (const double v : {piece.from.v, piece.to.v}) rectangle.include(plane.position({u, v}));
            }
            const Vec3 reach{std::hypot(x.x, y.x), std::hypot(x.y, y.y), std::hypot(x.z, y.z)};
            box.include({max(rectangle.lower, center - reach), min(rectangle.upper, center + reach)});
        } else {
            for (const auto& p : std::get<BezierPiece>(*curve).points) include({p.u / p.weight, p.v / p.weight});
        }
    });
    return box;
}

Bounds grown(const Bounds& box, double by) {
    const Vec3 margin{by, by, by};
    return {box.lower - margin, box.upper + margin};
}

}  // namespace

Brep::Brep(std::span<const Face> faces, std::vector<FaceProblem>& problems) {
    for (std::uint32_t i = 0; i < faces.size(); ++i) {
        if (const auto added = add(faces[i]); !added) {
            std::string reason;
            for (const Problem& p : added.error().problems) reason += (reason.empty() ? "" : "; ") + (p.place.empty() ? "" : p.place + ": ") + p.reason;
            problems.push_back({i, reason});
        }
    }
    faces_.shrink_to_fit();
    leaves_.shrink_to_fit();
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
        if (i % clump_size == 0) clumps_.emplace_back();
        clumps_.back().include(leaves_[i].box);
        bounds_.include(leaves_[i].box);
    }
}

Expected<Brep> Brep::make(std::span<const Face> faces) {
    std::vector<FaceProblem> problems;
    Brep brep(faces, problems);
    if (problems.empty()) return brep;
    Error error{ErrorKind::input, {}};
    for (const FaceProblem& p : problems) error.problems.push_back({"", "face " + std::to_string(p.face), p.reason, ""});
    return tl::unexpected(std::move(error));
}

Expected<void> Brep::add(const Face& face) {
    if (const auto* patches = std::get_if<PatchSurface>(&face.surface)) return add_patches(face, *patches);
    return add_analytic(face);
}

Expected<void> Brep::add_analytic(const Face& face) {
    auto surface = AnalyticSurface::make(face.surface);
    if (!surface) return tl::unexpected(surface.error());
    auto trimming = Trimming::make(face, surface->period(), [&](const ParameterBox& box) { return surface->least_steps(box); });
    if (!trimming) return tl::unexpected(trimming.error());
    Bounds box = surface->kind() == AnalyticSurface::Kind::plane ? plane_bounds(*surface, *trimming) : surface->bounds(trimming->box());
    if (!box.bounded() || box.largest_coordinate() > 1e30) return failure(ErrorKind::input, {"", "", "a face without bounds", ""});
    surface->set_center(box.center());
    box = grown(box, grazing_reach * trimming->widest_band() + 4 * surface->error(box));
    const auto index = static_cast<std::uint32_t>(faces_.size());
    faces_.push_back({std::move(*surface), none, face.reversed, face.slot, face.shell, std::move(*trimming)});
    leaves_.push_back({box, index, 0});
    return {};
}

Face Brep::face(std::uint32_t index) const {
    const TrimmedFace& from = faces_[index];
    const ParameterBox& box = from.trimming.box();
    Face face;
    if (from.patches == none) {
        face.surface = from.surface.plain();
    } else {
        face.surface = patches_[from.patches].plain;
    }
    face.u0 = box.u0, face.u1 = box.u1, face.v0 = box.v0, face.v1 = box.v1;
    face.loops = from.trimming.loops();
    face.reversed = from.reversed, face.slot = from.slot, face.shell = from.shell;
    return face;
}

// Whether a point of an analytic face's surface is a hit of the face.
bool Brep::belongs(std::uint32_t part, const TrimmedFace& face, const Ray& ray, const Meeting& meeting) const {
    const Point2 root = face.surface.parameters(meeting.local);
    const auto located = face.trimming.locate(root, [&](Point2 p) { return metric_seen_along(ray.direction, face.surface.along_u(p), face.surface.along_v(p)); });
    return located.place != Place::outside && (!located.near_edge || counts(part, ray, meeting.t, root, located));
}

std::optional<ShapeHit> Brep::intersect(std::uint32_t part, const Ray& ray) const {
    const Leaf& leaf = leaves_[part];
    const TrimmedFace& face = faces_[leaf.face];
    if (face.patches != none) return meet_patch(part, face, ray);
    Meeting meetings[AnalyticSurface::most_meetings];
    const int count = face.surface.meet(ray, meetings);
    for (int i = 0; i < count; ++i) {
        if (belongs(part, face, ray, meetings[i])) return ShapeHit{meetings[i].t, part};
    }
    return std::nullopt;
}

unsigned Brep::intersect(std::uint32_t part, const RayLanes& rays, unsigned active, Lanes& t) const {
    const Leaf& leaf = leaves_[part];
    const TrimmedFace& face = faces_[leaf.face];
    const auto &o = rays.origin, &d = rays.direction;
    const auto ray_of = [&](int lane) {
        return Ray{{o.x[lane], o.y[lane], o.z[lane]}, {d.x[lane], d.y[lane], d.z[lane]}, rays.t_min[lane], rays.t_max[lane]};
    };
    unsigned found = 0;
    const auto alone = [&](int lane) {
        if (const auto hit = intersect(part, ray_of(lane))) t[lane] = hit->t, found |= 1u << lane;
    };
    if (face.patches != none) {
        // Where the nearest root is trimmed off, others may not be.
        PatchRootLanes roots;
        for (unsigned rest = patches_[face.patches].leaves.nearest(leaf.patch_leaf, rays, active, roots); rest; rest &= rest - 1) {
            const int lane = __builtin_ctz(rest);
            const PatchRoot root{roots.t[lane], roots.u[lane], roots.v[lane]};
            const Ray ray = ray_of(lane);
            const auto located = locate_patch(leaf, face, root, ray.at(root.t), ray.direction);
            if (located.place != Place::outside && (!located.near_edge || counts(part, ray, root.t, {root.u, root.v}, located))) {
                t[lane] = root.t, found |= 1u << lane;
            } else {
                alone(lane);
            }
        }
        return found;
    }
    const AnalyticSurface& surface = face.surface;
    const auto kind = surface.kind();
    if (kind == AnalyticSurface::Kind::sphere || kind == AnalyticSurface::Kind::torus) {
        for (unsigned rest = active; rest; rest &= rest - 1) alone(__builtin_ctz(rest));
        return found;
    }
    const LocalLine<Lanes> line = surface.into_frame(o, d);
    const Lanes far = Lanes{} + infinity;
    // Lanes among `wanted` that have the root in reach and on the face.
    const auto take = [&](const Lanes& s, unsigned wanted) {
        const Lanes at = line.shift + s;
        const unsigned reached = bits_of((at > rays.t_min) & (at <= rays.t_max) & (at < far)) & wanted;
        if (!reached) return;
        const Lanes x = fused_multiply_add(line.direction.x, s, line.origin.x), y = fused_multiply_add(line.direction.y, s, line.origin.y);
        const Lanes z = fused_multiply_add(line.direction.z, s, line.origin.z);
        const auto [u, v] = surface.unrolled(Point3<Lanes>{x, y, z});
        const Trimming::Sorted sorted = face.trimming.sort(u, v, reached);
        if (sorted.inside) t = blend(sorted.inside, at, t), found |= sorted.inside;
        for (unsigned open = sorted.open; open; open &= open - 1) {
            const int lane = __builtin_ctz(open);
            if (belongs(part, face, ray_of(lane), {at[lane], {x[lane], y[lane], z[lane]}})) t[lane] = at[lane], found |= 1u << lane;
        }
    };
    if (kind == AnalyticSurface::Kind::plane) {
        take(meet_plane(line), active);
    } else {
        const auto [first, second] = cone_roots(line, surface.radius(), surface.slope());
        take(first, active);
        take(second, active & ~found);
    }
    return found;
}

SurfacePoint Brep::surface(std::uint32_t primitive, Vec3 position) const {
    const Leaf& leaf = leaves_[primitive];
    const TrimmedFace& face = faces_[leaf.face];
    SurfacePoint point;
    if (face.patches != none) {
        point = patch_surface(leaf, face, position);
    } else {
        point = face.surface.nearest(position);
        point.error = face.surface.error(leaf.box);
        const Point2 at = face.trimming.locate({point.u, point.v}, [&](Point2 p) { return face.surface.metric(p); }).at;
        point.u = at.u, point.v = at.v;
    }
    if (face.reversed) point.normal = -point.normal, point.shading_normal = -point.shading_normal;
    point.slot = slot(primitive);
    return point;
}

std::size_t Brep::bytes() const {
    std::size_t total = sizeof *this + faces_.capacity() * sizeof(TrimmedFace) + leaves_.capacity() * sizeof(Leaf) + patches_.capacity() * sizeof(Patches) +
                        clumps_.capacity() * sizeof(Bounds);
    for (const TrimmedFace& face : faces_) total += face.trimming.bytes() - sizeof(Trimming);
    for (const Patches& p : patches_) {
        total += p.leaves.bytes() - sizeof(PatchLeaves) + p.plain.patches.capacity() * sizeof(BezierPatch);
        for (const BezierPatch& patch : p.plain.patches) total += patch.points.capacity() * sizeof(ControlPoint);
    }
    return total;
}

const FieldTable<Brep>& Brep::fields() {
    static const FieldTable<Brep> table;
    return table;
}

}  // namespace crescente::geometry
