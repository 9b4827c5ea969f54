// Where faces of a Brep meet: of the two crossings that a ray may have with the neighbours at one edge, those count that a solid has.
//
// Faces end in curves that do not quite agree: there are slits and overlaps as wide as the bands. A face's surface goes on beyond its edge by the band, so
// that nothing passes through a slit. What has gone beyond the neighbour's surface is then more than the solid has, be it inside the loops or in the
// band, and does not count if the neighbour has the crossing in its place: near the edge the solid is the wedge between the two surfaces themselves. Where
// they are tangent there is no wedge but one surface told twice; then strict hits go first, and after them the lower face.
// See docs/decisions/0006-bands-and-edges.md.
#include <algorithm>
#include <cmath>

#include "geometry/brep.h"

namespace crescente::geometry {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

bool holds(const Bounds& box, Vec3 p) {
    return p.x >= box.lower.x && p.x <= box.upper.x && p.y >= box.lower.y && p.y <= box.upper.y && p.z >= box.lower.z && p.z <= box.upper.z;
}

Metric metric_of(Vec3 along_u, Vec3 along_v) { return {dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)}; }

}  // namespace

Brep::Tangents Brep::tangents(const Leaf& leaf, const TrimmedFace& face, Point2 root, Vec3 position) const {
    Tangents t;
    if (face.patches == none) {
        t = {face.surface.along_u(root), face.surface.along_v(root), face.surface.normal(root)};
    } else {
        const Patches& patches = patches_[face.patches];
        const PatchPoint p = patches.leaves.at(leaf.patch_leaf, root.u, root.v);
        t = {p.along_u, p.along_v, p.normal};
        if (patches.plain.revolved) {
            const Frame& axis = *patches.plain.revolved;
            const Vec3 off = position - axis.origin;
            t.along_u = axis.y * dot(off, axis.x) - axis.x * dot(off, axis.y);
        }
    }
    if (face.reversed) t.normal = -t.normal;
    return t;
}

// `root`: the parameters of the surface itself, of the patches where it is made of such.
bool Brep::counts(std::uint32_t part, const Ray& ray, double t, Point2 root, const Trimming::Located& located, int depth) const {
    const Leaf& leaf = leaves_[part];
    const TrimmedFace& face = faces_[leaf.face];
    EdgeHit hit;
    hit.t = t, hit.position = ray.at(t), hit.face = leaf.face;
    const Tangents own = tangents(leaf, face, root, hit.position);
    Trimming::NearEdge edges[Trimming::most_near_edges];
    hit.edges = face.trimming.near_edges(located.at, metric_of(own.along_u, own.along_v), edges);
    if (hit.edges == 0) return true;
    hit.strict = located.place == Place::inside;
    hit.normal = own.normal;
    hit.leaves = dot(own.normal, ray.direction) > 0;
    hit.band = 0;
    for (int i = 0; i < hit.edges; ++i) {
        const Vec3 outward = own.along_u * edges[i].outward.u + own.along_v * edges[i].outward.v;
        const double size = length(outward);
        hit.outward[i] = size > 0 ? outward / size : Vec3{};
        hit.band = std::max(hit.band, edges[i].band);
    }
    const auto count = static_cast<std::uint32_t>(leaves_.size());
    for (std::uint32_t clump = 0; clump < clumps_.size(); ++clump) {
        if (!holds(clumps_[clump], hit.position)) continue;
        for (std::uint32_t other = clump * clump_size; other < std::min((clump + 1) * clump_size, count); ++other) {
            if (leaves_[other].face != leaf.face && holds(leaves_[other].box, hit.position) && gives_way(hit, other, ray, depth)) return false;
        }
    }
    return true;
}

// Whether the crossing does not count because of what another leaf has near it.
bool Brep::gives_way(const EdgeHit& hit, std::uint32_t other, const Ray& ray, int depth) const {
    const Leaf& leaf = leaves_[other];
    const TrimmedFace& face = faces_[leaf.face];
    const PatchLeaves* patches = face.patches == none ? nullptr : &patches_[face.patches].leaves;
    const auto located_at = [&](Point2 root, Vec3 position) {
        if (patches) return locate_patch(leaf, face, {0, root.u, root.v}, position);
        return face.trimming.locate(root, [&](Point2 p) { return face.surface.metric(p); });
    };

    // How far the hit lies beyond the other surface, on its outer side.
    Point2 foot;
    Vec3 below;
    if (patches) {
        const PatchRoot near = patches->locate(leaf.patch_leaf, hit.position);
        const ParameterBox range = patches->range(leaf.patch_leaf);
        if (!(near.u >= range.u0 && near.u <= range.u1 && near.v >= range.v0 && near.v <= range.v1)) return false;
        foot = {near.u, near.v};
        below = patches->at(leaf.patch_leaf, near.u, near.v).position;
    } else {
        const SurfacePoint near = face.surface.nearest(hit.position);
        foot = {near.u, near.v};
        below = near.position;
    }
    if (!(length(hit.position - below) <= 2 * hit.band) || located_at(foot, below).place == Place::outside) return false;
    const Vec3 normal = tangents(leaf, face, foot, below).normal;
    const double beyond = dot(hit.position - below, normal);
    double turn = 0;  // positive: across the edge with this face, ours goes out of it; negative: in
    for (int i = 0; i < hit.edges; ++i) {
        if (const double own = dot(normal, hit.outward[i]); std::abs(own) > std::abs(turn)) turn = own;
    }

    // Where the ray meets the other surface instead.
    // Across the common edge our face goes straight out of the other one, or in. Where it has no edge that runs so, the two meet elsewhere.
    const double sine = length(cross(normal, hit.normal));
    const bool smooth = sine < 0.05;
    if (!smooth && !(std::abs(turn) > 0.5 * sine)) return false;
    const double reach = (smooth ? 100 : 1e4) * hit.band / length(ray.direction);
    const Ray line{ray.origin, ray.direction, hit.t - reach, hit.t + reach};
    bool met = false, strict = false, near_edge = false, alike = false;
    double distance = HUGE_VAL, instead_t = 0;
    Point2 instead_root;
    Trimming::Located instead;
    const auto consider = [&](double t, Point2 root) {
        if (!(std::abs(t - hit.t) < distance)) return;
        const Vec3 position = ray.at(t);
        const Trimming::Located located = located_at(root, position);
        const Tangents there = tangents(leaf, face, root, position);
        distance = std::abs(t - hit.t);
        instead_t = t, instead_root = root, instead = located;
        met = located.place != Place::outside, strict = located.place == Place::inside;
        near_edge = !strict || (located.near_edge && face.trimming.near_edge(located.at, metric_of(there.along_u, there.along_v)));
        alike = (dot(there.normal, ray.direction) > 0) == hit.leaves;
    };
    if (patches) {
        PatchRoot roots[8];
        const int count = patches->roots(leaf.patch_leaf, line, roots);
        for (int i = 0; i < count; ++i) consider(roots[i].t, {roots[i].u, roots[i].v});
    } else {
        Meeting meetings[AnalyticSurface::most_meetings];
        const int count = face.surface.meet(line, meetings);
        for (int i = 0; i < count; ++i) consider(meetings[i].t, face.surface.parameters(meetings[i].local));
    }

    // That other crossing may itself give way, at a vertex to a third face's, which must not give way to this one: a crossing too many rather than none.
    constexpr int deepest = 2;
    const auto has_it = [&] { return !near_edge || depth == deepest || counts(other, ray, instead_t, instead_root, instead, depth + 1); };
    const double blur = 64 * eps * (max_component(abs(hit.position)) + leaf.box.largest_coordinate());
    if (smooth || std::abs(beyond) <= blur) {  // told twice
        if (!met || !alike) return false;
        const bool first = strict != hit.strict ? strict : !near_edge || leaf.face < hit.face;
        return first && has_it();
    }
    if ((beyond > 0) != (turn > 0)) return false;
    if (met && alike) return has_it();
    return !(strict && !near_edge);  // neither the one nor the other, unless that one stands for itself
}

}  // namespace crescente::geometry
