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

bool comes_near(const Bounds& box, Vec3 p, double within) {
    const Vec3 off = max(box.lower - p, p - box.upper);
    return off.x <= within && off.y <= within && off.z <= within;
}

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

// Judges crossings of one line, each by what the neighbours' surfaces have near it.
class EdgeJudge {
public:
    EdgeJudge(const Brep& brep, const Ray& ray) : brep_(brep), ray_(ray) {}

    struct Crossing {  // with a leaf, near an edge or not
        std::uint32_t leaf;
        double t;
        Point2 root;
        Trimming::Located located;
        bool near_edge = true;
    };

    // A crossing that another one replaces does not count, if that one counts, or is replaced in turn. Where surfaces contradict each other, at vertices, there is doubt; then
    // it counts: where all replace each other the one on the first face does, and one that is cancelled close by replaces none but those of the face that cancels it.
    bool counts(const Crossing& crossing) const {
        constexpr std::size_t most = 8;
        Crossing found[most] = {crossing};
        std::size_t count = 1;
        bool first = true, near[most] = {true};
        for (std::size_t i = 0; i < count; ++i) {
            if (!found[i].near_edge) return false;  // it counts in any case
            Relation relations[most_relations];
            const auto end = relations + relations_of(found[i], relations);
            const auto is = [&](Relation::Kind kind) { return [kind](const Relation& r) { return r.kind == kind; }; };
            if (std::any_of(relations, end, is(Relation::cancelled))) {
                const auto by_own = [&](const Relation& r) { return r.kind == Relation::cancelled && face_of(r.by) == face_of(crossing); };
                if (i == 0 || !near[i] || std::any_of(relations, end, by_own)) return false;
                continue;
            }
            if (std::none_of(relations, end, is(Relation::replaced))) return i == 0;
            first = first && face_of(crossing) <= face_of(found[i]);
            for (const Relation* r = relations; r != end; ++r) {
                if (r->kind != Relation::replaced) continue;
                const bool known = std::any_of(found, found + count, [&](const Crossing& c) { return face_of(c) == face_of(r->by) && c.t == r->by.t; });
                if (known) continue;
                if (count == most) return true;
                near[count] = near[i] && r->near;
                found[count++] = r->by;
            }
        }
        return first;
    }

private:
    struct Hit {
        double t;
        Vec3 position, normal;
        Vec3 outward[Trimming::most_near_edges];  // along the face and across its edges, away from the face; unit length, or zero
        Vec3 body[Trimming::most_near_edges];     // along the edge to its middle; unit length, or zero
        int edges;
        double band, reach;  // reach: of what is near; more than the band where the ray grazes the face
        std::uint32_t face;
        bool strict;  // on the face's side
        bool leaves;  // the ray goes along with the normal
    };
    struct Relation {
        // none: not a neighbour here. stands: the wedge has the crossing. replaced: the neighbour has it instead. cancelled: neither has one.
        enum Kind { none, stands, replaced, cancelled } kind = none;
        int edge = -1;  // of the hit's, that the neighbour lies across; -1 where the surfaces are tangent
        Crossing by{};
        bool near = false;  // that crossing is within a few bands
    };
    static constexpr double vicinity = 32;  // in bands
    static constexpr int most_relations = 16;

    std::uint32_t face_of(const Crossing& crossing) const { return brep_.leaves_[crossing.leaf].face; }

    // The direction of a step in (u, v); zero of none.
    static Vec3 in_space(const Brep::Tangents& tangents, Point2 step) {
        const Vec3 v = tangents.along_u * step.u + tangents.along_v * step.v;
        const double size = length(v);
        return size > 0 ? v / size : Vec3{};
    }

    Hit hit_of(const Crossing& crossing) const {
        const Brep::Leaf& leaf = brep_.leaves_[crossing.leaf];
        const Brep::TrimmedFace& face = brep_.faces_[leaf.face];
        Hit hit;
        hit.t = crossing.t, hit.position = ray_.at(crossing.t), hit.face = leaf.face;
        const Brep::Tangents own = brep_.tangents(leaf, face, crossing.root, hit.position);
        Trimming::NearEdge edges[Trimming::most_near_edges];
        hit.edges = face.trimming.near_edges(crossing.located.at, metric_seen_along(ray_.direction, own.along_u, own.along_v), metric_of(own.along_u, own.along_v), edges);
        hit.strict = crossing.located.place == Place::inside;
        hit.normal = own.normal;
        hit.leaves = dot(own.normal, ray_.direction) > 0;
        hit.band = hit.reach = 0;
        for (int i = 0; i < hit.edges; ++i) {
            hit.outward[i] = in_space(own, edges[i].outward), hit.body[i] = in_space(own, edges[i].body);
            hit.band = std::max(hit.band, edges[i].band), hit.reach = std::max({hit.reach, edges[i].band, edges[i].distance});
        }
        return hit;
    }

    int relations_of(const Crossing& crossing, Relation* relations) const {
        const Hit hit = hit_of(crossing);
        if (hit.edges == 0) return 0;
        int count = 0;
        const auto leaves = static_cast<std::uint32_t>(brep_.leaves_.size());
        const std::uint32_t shell = brep_.faces_[hit.face].shell;
        for (std::uint32_t clump = 0; clump < brep_.clumps_.size(); ++clump) {
            if (!comes_near(brep_.clumps_[clump], hit.position, 2 * hit.reach)) continue;
            for (std::uint32_t other = clump * Brep::clump_size; other < std::min((clump + 1) * Brep::clump_size, leaves); ++other) {
                const Brep::Leaf& leaf = brep_.leaves_[other];
                if (leaf.face == hit.face || brep_.faces_[leaf.face].shell != shell || !comes_near(leaf.box, hit.position, 2 * hit.reach)) continue;
                const Relation relation = relation_of(hit, other);
                if (relation.kind != Relation::none && count < most_relations) relations[count++] = relation;
            }
        }
        // Where the face has a corner of more than half a turn, one of the two surfaces across its edges is enough.
        const auto reflex = [&](int i, int k) {
            constexpr double sine = 0.05;
            return i >= 0 && k >= 0 && dot(hit.outward[i], hit.body[k]) > sine && dot(hit.outward[k], hit.body[i]) > sine;
        };
        bool forgiven[most_relations] = {};
        for (int i = 0; i < count; ++i) {
            for (int k = 0; k < count; ++k) forgiven[i] = forgiven[i] || (relations[k].kind == Relation::stands && reflex(relations[i].edge, relations[k].edge));
        }
        for (int i = 0; i < count; ++i) {
            if (forgiven[i]) relations[i].kind = Relation::stands;
        }
        // Of several faces across one edge some say one thing, others another: what lies inside the loops is not cancelled then.
        const auto contradicted = [&](const Relation& one) {
            return std::any_of(relations, relations + count, [&](const Relation& r) {
                return r.edge == one.edge && r.kind != Relation::cancelled && face_of(r.by) != face_of(one.by);
            });
        };
        for (int i = 0; i < count; ++i) {
            if (hit.strict && relations[i].kind == Relation::cancelled && contradicted(relations[i])) relations[i].kind = Relation::stands;
        }
        return count;
    }

    // On the neighbour, as the ray sees its bands.
    Trimming::Located located_at(const Brep::Leaf& leaf, const Brep::TrimmedFace& face, Point2 root, Vec3 position) const {
        if (face.patches != Brep::none) return brep_.locate_patch(leaf, face, {0, root.u, root.v}, position, ray_.direction);
        return face.trimming.locate(root, [&](Point2 p) { return metric_seen_along(ray_.direction, face.surface.along_u(p), face.surface.along_v(p)); });
    }
    // The point of a neighbour next to the hit, as bands `wider` times as wide have it.
    struct Foot {
        Brep::Tangents tangents;
        Metric metric;
        Trimming::Located located;
    };
    Foot foot_on(const Brep::Leaf& leaf, const Brep::TrimmedFace& face, Point2 root, Vec3 position, double wider) const {
        const Brep::Tangents t = brep_.tangents(leaf, face, root, position);
        const double scale = 1 / wider;
        const Metric metric = metric_of(t.along_u * scale, t.along_v * scale);
        const Point2 at = face.patches == Brep::none ? root : brep_.locate_patch(leaf, face, {0, root.u, root.v}, position, {}).at;
        return {t, metric, face.trimming.locate(at, [&](Point2) { return metric; })};
    }

    // Whether the hit's face and the neighbour are the two sides of a wedge, convex (across the edge ours goes out of the neighbour's surface: turn > 0) or concave: then
    // the neighbour goes out of ours, or in, likewise. Where four faces meet at an edge, two of them may have their outsides one before the other.
    bool are_wedge(const Hit& hit, int edge, double turn, const Foot& foot, const Brep::TrimmedFace& face) const {
        constexpr double alongside = 0.2;  // sine
        Trimming::NearEdge edges[Trimming::most_near_edges];
        const Brep::Tangents& t = foot.tangents;
        const int count = face.trimming.near_edges(foot.located.at, foot.metric, metric_of(t.along_u, t.along_v), edges);
        double back = 0;
        bool common = false;  // not another edge at the same vertex
        for (int i = 0; i < count; ++i) {
            const double own = dot(hit.normal, in_space(t, edges[i].outward));
            if (std::abs(own) > std::abs(back)) back = own, common = length(cross(in_space(t, edges[i].body), hit.body[edge])) < alongside;
        }
        return back * turn >= 0 || !common;
    }

    // What another leaf near the hit has to say of it.
    Relation relation_of(const Hit& hit, std::uint32_t other) const {
        const Brep::Leaf& leaf = brep_.leaves_[other];
        const Brep::TrimmedFace& face = brep_.faces_[leaf.face];
        const PatchLeaves* patches = face.patches == Brep::none ? nullptr : &brep_.patches_[face.patches].leaves;
        Point2 root;
        Vec3 below;
        if (patches) {
            if (patches->surely_farther(leaf.patch_leaf, hit.position, 2 * hit.reach)) return {};
            const PatchRoot near = patches->locate(leaf.patch_leaf, hit.position);
            const ParameterBox range = patches->range(leaf.patch_leaf);
            if (!(near.u >= range.u0 && near.u <= range.u1 && near.v >= range.v0 && near.v <= range.v1)) return {};
            root = {near.u, near.v};
            below = patches->at(leaf.patch_leaf, near.u, near.v).position;
        } else {
            const SurfacePoint near = face.surface.nearest(hit.position);
            root = {near.u, near.v};
            below = near.position;
        }
        if (!(length(hit.position - below) <= 2 * hit.reach)) return {};
        const Foot foot = foot_on(leaf, face, root, below, hit.reach / hit.band);
        if (foot.located.place == Place::outside) return {};
        const Vec3 normal = foot.tangents.normal;
        const double beyond = dot(hit.position - below, normal);
        Relation relation;
        double turn = 0;  // positive: across the edge with this face, ours goes out of it; negative: in
        for (int i = 0; i < hit.edges; ++i) {
            if (const double own = dot(normal, hit.outward[i]); std::abs(own) > std::abs(turn)) turn = own, relation.edge = i;
        }
        // Across the common edge our face goes straight out of the other one, or in. Where it has no edge that runs so, the two meet elsewhere.
        const double sine = length(cross(normal, hit.normal));
        const bool smooth = sine < 0.05;
        if (!smooth && !(std::abs(turn) > 0.5 * sine)) return {};

        const Neighbour there = crossing_with(face, leaf.face, other, hit, smooth ? 100 : 1e4);
        const bool alike = there.crossed && there.enters != hit.leaves;
        const bool met = there.crossed && there.crossing.located.place != Place::outside, strict = there.crossed && there.crossing.located.place == Place::inside;
        relation.by = there.crossing, relation.near = there.near;
        if (smooth) {  // told twice
            relation.edge = -1;
            const bool first = strict != hit.strict ? strict : !there.crossing.near_edge || leaf.face < hit.face;
            relation.kind = met && alike && first ? Relation::replaced : Relation::stands;
            // Back to back, at a cusp: what both have beyond their edge is nothing.
            if (dot(normal, hit.normal) < 0 && met && !alike && !strict && !hit.strict) relation.kind = Relation::cancelled;
            return relation;
        }
        // Inside of the other surface at the hit? The order of the two crossings tells, the same way for both of them, however near they are.
        const double blur = 64 * eps * (max_component(abs(hit.position)) + leaf.box.largest_coordinate());
        const bool earlier = there.crossing.t != hit.t ? there.crossing.t < hit.t : leaf.face < hit.face;
        const bool within = there.crossed ? there.enters == earlier : beyond < 0;
        // That it lies on the wrong side of a surface where the ray does not meet the face is no reason to leave out what lies inside the loops.
        const bool in_doubt = hit.strict ? !met : !there.crossed && std::abs(beyond) <= blur;
        if (within == (turn > 0) || in_doubt) relation.kind = Relation::stands;
        else if (!are_wedge(hit, relation.edge, turn, foot, face)) return {};
        else if (alike) relation.kind = met || !there.near ? Relation::replaced : Relation::stands;
        else relation.kind = strict && there.near && !there.crossing.near_edge ? Relation::stands : Relation::cancelled;  // that one stands for itself
        return relation;
    }

    struct Neighbour {
        bool crossed = false, enters = false, near = false;
        Crossing crossing{};
    };
    // Where the line meets the other surface, on the face or not, next to the hit; not farther away than so many bands.
    Neighbour crossing_with(const Brep::TrimmedFace& face, std::uint32_t number, std::uint32_t leaf, const Hit& hit, double bands) const {
        const double reach = bands * hit.band / length(ray_.direction);
        const Ray line{ray_.origin, ray_.direction, hit.t - reach, hit.t + reach};
        Neighbour found;
        found.crossing.leaf = leaf;
        double distance = HUGE_VAL;
        const auto consider = [&](std::uint32_t which, double t, Point2 root) {
            if (!(std::abs(t - hit.t) < distance)) return;
            distance = std::abs(t - hit.t);
            found.crossed = true;
            found.crossing.leaf = which, found.crossing.t = t, found.crossing.root = root;
        };
        if (face.patches != Brep::none) {
            const PatchLeaves& patches = brep_.patches_[face.patches].leaves;
            const auto look = [&](std::uint32_t which) {
                PatchRoot roots[8];
                const int count = patches.roots(brep_.leaves_[which].patch_leaf, line, roots);
                for (int i = 0; i < count; ++i) consider(which, roots[i].t, {roots[i].u, roots[i].v});
            };
            for (std::uint32_t which = leaf; which < brep_.leaves_.size() && brep_.leaves_[which].face == number; ++which) look(which);
            for (std::uint32_t which = leaf; which-- > 0 && brep_.leaves_[which].face == number;) look(which);
        } else {
            Meeting meetings[AnalyticSurface::most_meetings];
            const int count = face.surface.meet(line, meetings);
            for (int i = 0; i < count; ++i) consider(leaf, meetings[i].t, face.surface.parameters(meetings[i].local));
        }
        if (!found.crossed) return found;
        Crossing& c = found.crossing;
        const Vec3 position = ray_.at(c.t);
        const Brep::Tangents there = brep_.tangents(brep_.leaves_[c.leaf], face, c.root, position);
        c.located = located_at(brep_.leaves_[c.leaf], face, c.root, position);
        c.near_edge = c.located.place != Place::inside || (c.located.near_edge && face.trimming.near_edge(c.located.at, metric_seen_along(ray_.direction, there.along_u, there.along_v)));
        found.near = distance * length(ray_.direction) <= vicinity * hit.reach;
        found.enters = dot(there.normal, ray_.direction) <= 0;
        return found;
    }

    const Brep& brep_;
    const Ray& ray_;
};

bool Brep::counts(std::uint32_t part, const Ray& ray, double t, Point2 root, const Trimming::Located& located) const {
    // Most hits in cells that an edge runs through are not near it.
    const Leaf& leaf = leaves_[part];
    const TrimmedFace& face = faces_[leaf.face];
    Vec3 along_u, along_v;
    if (face.patches == none) {
        along_u = face.surface.along_u(root), along_v = face.surface.along_v(root);
    } else {
        const Tangents own = tangents(leaf, face, root, ray.at(t));
        along_u = own.along_u, along_v = own.along_v;
    }
    if (!face.trimming.near_edge(located.at, metric_seen_along(ray.direction, along_u, along_v))) return true;
    return EdgeJudge(*this, ray).counts({part, t, root, located});
}

}  // namespace crescente::geometry
