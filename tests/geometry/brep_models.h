// Closed solids as trimmed faces, built by hand, each with its true distance function in long double.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "geometry/brep.h"
#include "geometry/shape_check.h"

namespace crescente::geometry::test {

using L = long double;

// Where a model stands: its own coordinates p become origin + scale (x p.x + y p.y + z p.z).
struct Placing {
    Frame frame;
    double scale = 1;

    Frame at(Vec3 origin, Vec3 x, Vec3 y, Vec3 z) const {
        const auto turn = [&](Vec3 v) { return frame.x * v.x + frame.y * v.y + frame.z * v.z; };
        return {point(origin), turn(x), turn(y), turn(z)};
    }
    Frame at(Vec3 origin) const { return at(origin, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}); }
    Vec3 point(Vec3 p) const { return frame.origin + (frame.x * p.x + frame.y * p.y + frame.z * p.z) * scale; }
    Exact back(Exact p) const {
        const L x = p.x - frame.origin.x, y = p.y - frame.origin.y, z = p.z - frame.origin.z;
        const auto along = [&](Vec3 a) { return (x * a.x + y * a.y + z * a.z) / scale; };
        return {along(frame.x), along(frame.y), along(frame.z)};
    }
};

inline Placing placing(double scale, Vec3 origin = {}, std::uint64_t turned = 0) {
    Placing p;
    p.scale = scale;
    p.frame.origin = origin;
    if (turned) {
        Random random(turned);
        p.frame.z = random.direction();
        p.frame.x = normalize(exact_cross(p.frame.z, random.direction()));
        p.frame.y = cross(p.frame.z, p.frame.x);
    }
    return p;
}

inline Loop polygon_loop(const std::vector<Point2>& corners, double band) {
    Loop loop;
    for (std::size_t i = 0; i < corners.size(); ++i) loop.push_back({LinePiece{corners[i], corners[(i + 1) % corners.size()]}, band});
    return loop;
}
inline Loop rectangle_loop(double u0, double u1, double v0, double v1, double band) { return polygon_loop({{u0, v0}, {u1, v0}, {u1, v1}, {u0, v1}}, band); }
inline Loop circle_loop(Point2 center, double radius, double band) {
    return {{ArcPiece{center, {radius, 0}, {0, radius}, 0, 2 * pi}, band}};
}
inline void set_box(Face& face) {
    face.u0 = face.v0 = HUGE_VAL, face.u1 = face.v1 = -HUGE_VAL;
    for (const Loop& loop : face.loops) {
        for (const LoopEdge& edge : loop) {
            for (int i = 0; i <= 64; ++i) {
                Point2 p;
                if (const auto* line = std::get_if<LinePiece>(&edge.piece)) p = i % 2 ? line->from : line->to;
                else if (const auto* arc = std::get_if<ArcPiece>(&edge.piece)) p = evaluate(edge.piece, arc->a0 + (arc->a1 - arc->a0) * i / 64).at;
                else p = evaluate(edge.piece, i / 64.0).at;
                face.u0 = std::min(face.u0, p.u), face.u1 = std::max(face.u1, p.u), face.v0 = std::min(face.v0, p.v), face.v1 = std::max(face.v1, p.v);
            }
        }
    }
}
inline Face trimmed(FaceSurface surface, std::vector<Loop> loops, bool reversed = false) {
    Face face;
    face.surface = std::move(surface), face.loops = std::move(loops), face.reversed = reversed;
    set_box(face);
    return face;
}

struct Model {
    std::string name;
    std::vector<Face> faces;
    std::function<L(Exact)> distance;  // in the model's own coordinates: negative inside; exact near the surface
    std::vector<std::function<Vec3(double)>> edges;  // points of shared edges for a share from 0 to 1, in own coordinates
    Placing place;
    double size = 2;  // half the largest edge of its box, in own units, about
};

inline L length2(L a, L b) { return std::sqrt(a * a + b * b); }

inline void add_box_faces(Model& m, Vec3 lower, Vec3 upper, double band, const std::vector<Loop>& holes_below = {}, const std::vector<Loop>& holes_above = {}) {
    const double s = m.place.scale;
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool above : {false, true}) {
            Vec3 x, y, z, origin;
            const int i = (axis + 1) % 3, j = (axis + 2) % 3;
            x[i] = 1, y[j] = 1, z[axis] = 1;
            origin[axis] = above ? upper[axis] : lower[axis];
            std::vector<Loop> loops{rectangle_loop(s * lower[i], s * upper[i], s * lower[j], s * upper[j], band)};
            if (axis == 2) {
                for (const Loop& hole : above ? holes_above : holes_below) loops.push_back(hole);
            }
            m.faces.push_back(trimmed(PlaneSurface{m.place.at(origin, x, y, z)}, loops, !above));
        }
    }
    for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < 4; ++k) {
            m.edges.push_back([=](double share) {
                Vec3 p;
                p[axis] = lower[axis] + share * (upper[axis] - lower[axis]);
                p[(axis + 1) % 3] = (k & 1 ? upper : lower)[(axis + 1) % 3], p[(axis + 2) % 3] = (k & 2 ? upper : lower)[(axis + 2) % 3];
                return p;
            });
        }
    }
}
inline L box_distance(Exact p, Vec3 lower, Vec3 upper) {
    const L a = std::max((L)lower.x - p.x, p.x - upper.x), b = std::max((L)lower.y - p.y, p.y - upper.y);
    return std::max({a, b, std::max((L)lower.z - p.z, p.z - upper.z)});
}
inline void add_circle_edge(Model& m, Vec3 center, double radius) {
    m.edges.push_back([=](double share) { return center + Vec3{radius * std::cos(2 * pi * share), radius * std::sin(2 * pi * share), 0}; });
}

inline Model box_model(Placing place, double band) {
    Model m{"box", {}, {}, {}, place, 1};
    const Vec3 lower{-1, -0.5, -0.75}, upper{0.8, 0.5, 0.25};
    add_box_faces(m, lower, upper, band);
    m.distance = [=](Exact p) { return box_distance(p, lower, upper); };
    return m;
}

// A plate with a round hole.
inline Model plate_model(Placing place, double band) {
    Model m{"plate", {}, {}, {}, place, 1};
    const Vec3 lower{-1, -0.75, -0.25}, upper{1, 0.75, 0.25};
    const double s = place.scale, r = 0.4;
    const Point2 c{0.2, -0.1};
    const Loop hole = circle_loop({s * c.u, s * c.v}, s * r, band);
    add_box_faces(m, lower, upper, band, {hole}, {hole});
    m.faces.push_back(trimmed(CylinderSurface{place.at({c.u, c.v, 0}), s * r}, {rectangle_loop(0, 2 * pi, s * lower.z, s * upper.z, band)}, true));
    m.distance = [=](Exact p) { return std::max(box_distance(p, lower, upper), r - length2(p.x - c.u, p.y - c.v)); };
    for (const double z : {lower.z, upper.z}) add_circle_edge(m, {c.u, c.v, z}, r);
    return m;
}

// A truncated cone, or one up to its apex.
inline Model cone_model(Placing place, double band, bool pointed) {
    Model m{pointed ? "pointed cone" : "cone", {}, {}, {}, place, 1};
    const double s = place.scale, base = 0.9, top = pointed ? 0 : 0.3, height = 1.2, angle = std::atan2(top - base, height), slant = std::hypot(base - top, height);
    m.faces.push_back(trimmed(ConeSurface{place.at({0, 0, 0}), s * base, angle}, {rectangle_loop(0, 2 * pi, 0, s * slant, band)}));
    m.faces.push_back(trimmed(PlaneSurface{place.at({0, 0, 0})}, {circle_loop({}, s * base, band)}, true));
    add_circle_edge(m, {0, 0, 0}, base);
    if (!pointed) {
        m.faces.push_back(trimmed(PlaneSurface{place.at({0, 0, height})}, {circle_loop({}, s * top, band)}));
        add_circle_edge(m, {0, 0, height}, top);
    }
    m.distance = [=](Exact p) {
        const L k = ((L)top - base) / height;
        return std::max({(length2(p.x, p.y) - (base + k * p.z)) / std::sqrt(1 + k * k), -p.z, p.z - height});
    };
    return m;
}

// Part of a ball above a plane: its sphere has a pole inside and a cut below.
inline Model dome_model(Placing place, double band) {
    Model m{"dome", {}, {}, {}, place, 1};
    const double s = place.scale, cut = -0.3, r = std::sqrt(1 - cut * cut), v0 = std::asin(cut);
    m.faces.push_back(trimmed(SphereSurface{place.at({}), s}, {rectangle_loop(-pi, pi, v0, pi / 2, band)}));
    m.faces.push_back(trimmed(PlaneSurface{place.at({0, 0, cut})}, {circle_loop({}, s * r, band)}, true));
    add_circle_edge(m, {0, 0, cut}, r);
    m.distance = [=](Exact p) { return std::max(std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z) - 1, cut - p.z); };
    return m;
}

inline Model ring_model(Placing place, double) {
    Model m{"ring", {}, {}, {}, place, 1};
    const double s = place.scale;
    Face face;
    face.surface = TorusSurface{place.at({}), 0.8 * s, 0.2 * s};
    face.u0 = 0, face.u1 = 2 * pi, face.v0 = -pi, face.v1 = pi;
    m.faces.push_back(face);
    m.distance = [=](Exact p) { return length2(length2(p.x, p.y) - (L)0.8, p.z) - (L)0.2; };
    return m;
}

// A rod whose lower end is rounded by a torus' quarter: cylinder, torus and planes that are tangent where they meet.
inline Model rod_model(Placing place, double band) {
    Model m{"rod", {}, {}, {}, place, 1};
    const double s = place.scale, r = 0.5, f = 0.2, height = 1;
    m.faces.push_back(trimmed(CylinderSurface{place.at({}), s * r}, {rectangle_loop(0, 2 * pi, s * f, s * height, band)}));
    m.faces.push_back(trimmed(TorusSurface{place.at({0, 0, f}), s * (r - f), s * f}, {rectangle_loop(0, 2 * pi, -pi / 2, 0, band)}));
    m.faces.push_back(trimmed(PlaneSurface{place.at({})}, {circle_loop({}, s * (r - f), band)}, true));
    m.faces.push_back(trimmed(PlaneSurface{place.at({0, 0, height})}, {circle_loop({}, s * r, band)}));
    add_circle_edge(m, {0, 0, f}, r), add_circle_edge(m, {0, 0, 0}, r - f), add_circle_edge(m, {0, 0, height}, r);
    m.distance = [=](Exact p) {
        const L rho = length2(p.x, p.y);
        const L side = rho - r, low = -p.z, high = p.z - height;
        const L round = rho > r - f && p.z < f ? length2(rho - ((L)r - f), p.z - f) - f : std::max(side, low);
        return std::max(round, high);
    };
    return m;
}

// A box with one edge rounded by a quarter of a cylinder; the plates at its ends are bounded by an arc each.
inline Model fillet_model(Placing place, double band) {
    Model m{"fillet", {}, {}, {}, place, 1};
    const double s = place.scale, f = 0.3;  // the box is [-1, 1] x [-1, 1] x [-0.5, 0.5]; rounded where x = y = 1
    const auto plane = [&](Vec3 origin, Vec3 x, Vec3 y, Vec3 z, double u0, double u1, double v0, double v1) {
        m.faces.push_back(trimmed(PlaneSurface{place.at(origin, x, y, z)}, {rectangle_loop(s * u0, s * u1, s * v0, s * v1, band)}));
    };
    plane({-1, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}, -0.5, 0.5, -1, 1);
    plane({0, -1, 0}, {1, 0, 0}, {0, 0, 1}, {0, -1, 0}, -1, 1, -0.5, 0.5);
    plane({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 0}, -1, 1 - f, -0.5, 0.5);
    plane({0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, -0.5, 0.5, -1, 1 - f);
    for (const double z : {-0.5, 0.5}) {
        const Loop outline{{LinePiece{{-s, -s}, {s, -s}}, band},
                           {LinePiece{{s, -s}, {s, s * (1 - f)}}, band},
                           {ArcPiece{{s * (1 - f), s * (1 - f)}, {s * f, 0}, {0, s * f}, 0, pi / 2}, band},
                           {LinePiece{{s * (1 - f), s}, {-s, s}}, band},
                           {LinePiece{{-s, s}, {-s, -s}}, band}};
        m.faces.push_back(trimmed(PlaneSurface{place.at({0, 0, z})}, {outline}, z < 0));
        m.edges.push_back([=](double share) { return Vec3{1 - f + f * std::cos(share * pi / 2), 1 - f + f * std::sin(share * pi / 2), z}; });
        m.edges.push_back([=](double share) { return Vec3{-1 + share * (2 - f), 1, z}; });
        m.edges.push_back([=](double share) { return Vec3{-1 + share * 2, -1, z}; });
    }
    m.edges.push_back([=](double share) { return Vec3{1, 1 - f, -0.5 + share}; });
    m.edges.push_back([=](double share) { return Vec3{1 - f, 1, -0.5 + share}; });
    m.faces.push_back(trimmed(CylinderSurface{place.at({1 - f, 1 - f, 0}), s * f}, {rectangle_loop(0, pi / 2, -0.5 * s, 0.5 * s, band)}));
    m.distance = [=](Exact p) {
        const L x = p.x - (1 - (L)f), y = p.y - (1 - (L)f);
        const L corner = x > 0 && y > 0 ? length2(x, y) - f : std::max(p.x - 1, p.y - 1);
        return std::max({corner, -1 - p.x, -1 - p.y, std::abs(p.z) - (L)0.5});
    };
    return m;
}

// Like the cone, but on the negative nappe in a left-handed frame: the same solid, told another way. (S_u x S_v then leads inside.)
inline Model odd_cone_model(Placing place, double band) {
    Model m = cone_model(place, band, false);
    m.name = "cone of odd frame";
    const double s = place.scale, base = 0.9, top = 0.3, height = 1.2, angle = std::atan2(base - top, height), apex = height * base / (base - top);
    // From the apex, v runs down along -z to negative radii, and the frame's y is turned over.
    const Frame frame = place.at({0, 0, apex}, {1, 0, 0}, {0, -1, 0}, {0, 0, 1});
    const double from = -apex / std::cos(angle), to = -(apex - height) / std::cos(angle);
    m.faces[0] = trimmed(ConeSurface{frame, 0, angle}, {rectangle_loop(-1, 2 * pi - 1, s * from, s * to, band)}, true);
    return m;
}

// A wall of revolution about z as four rational patches a row: the profile's homogeneous points (distance from the axis, height, weight) turned by
// quarters. Covers u from 0 to `turn`, quarter by quarter, and v from 0 to 1.
inline PatchSurface turned(const Placing& place, Vec3 origin, const std::vector<Vec3>& profile, double turn) {
    PatchSurface surface;
    const double root = std::sqrt(0.5), corner[5][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    for (int quarter = 0; quarter < 4; ++quarter) {
        BezierPatch patch;
        patch.degree_u = 2, patch.degree_v = static_cast<int>(profile.size()) - 1, patch.rational = true;
        patch.u0 = turn * quarter / 4, patch.u1 = turn * (quarter + 1) / 4;
        for (int i = 0; i < 3; ++i) {
            const double* a = corner[quarter];
            const double* b = corner[quarter + 1];
            const double x = i == 0 ? a[0] : i == 2 ? b[0] : a[0] + b[0], y = i == 0 ? a[1] : i == 2 ? b[1] : a[1] + b[1];
            for (const Vec3 p : profile) {
                const double w = p.z * (i == 1 ? root : 1);
                patch.points.push_back({place.point(origin + Vec3{x * p.x, y * p.x, p.y}) * w, w});
            }
        }
        surface.patches.push_back(patch);
    }
    return surface;
}

// The plate with its hole's wall as patches: with u as the patches have it, or as the angle.
inline Model patch_plate_model(Placing place, double band, bool revolved) {
    Model m = plate_model(place, band);
    m.name = revolved ? "plate with a revolved hole" : "plate with a hole of patches";
    const Vec3 origin{0.2, -0.1, 0};
    const double r = 0.4, turn = revolved ? 2 * pi : 4;
    PatchSurface wall = turned(place, origin, {{r, -0.25, 1}, {r, 0.25, 1}}, turn);
    if (revolved) wall.revolved = place.at(origin);
    m.faces.back() = trimmed(wall, {rectangle_loop(0, turn, 0, 1, band)}, true);
    m.size = 1.4;
    return m;
}

// The dome, its ball made of patches with a pole; what lies below the cut is trimmed off, at a height that is no border of patches.
inline Model patch_dome_model(Placing place, double band) {
    Model m = dome_model(place, band);
    m.name = "dome of patches";
    const double root = std::sqrt(0.5);
    // Quarters of the meridian: from the south pole to the equator, and on to the north pole.
    PatchSurface ball;
    for (const bool north : {false, true}) {
        const std::vector<Vec3> low{{0, -1, 1}, {1, -1, root}, {1, 0, 1}}, high{{1, 0, 1}, {1, 1, root}, {0, 1, 1}};
        PatchSurface half = turned(place, {}, north ? high : low, 2 * pi);
        for (BezierPatch& patch : half.patches) patch.v0 += north, patch.v1 += north, ball.patches.push_back(patch);
    }
    ball.revolved = place.at({});
    // The meridian's quarter is ((1 - s)^2 (0, -1) + 2 s (1 - s) root (1, -1) + s^2 (1, 0)) / weight: where its height is the cut.
    const double cut = -0.3;
    double low = 0, high = 1;
    for (int i = 0; i < 100; ++i) {
        const double s = 0.5 * (low + high), a = (1 - s) * (1 - s), b = 2 * s * (1 - s) * root, c = s * s;
        (-(a + b) / (a + b + c) < cut ? low : high) = s;
    }
    m.faces[0] = trimmed(ball, {rectangle_loop(0, 2 * pi, low, 2, band)});
    return m;
}

inline std::vector<Model> patch_models(Placing place, double band) {
    return {patch_plate_model(place, band, false), patch_plate_model(place, band, true), patch_dome_model(place, band)};
}

inline std::vector<Model> models(Placing place, double band) {
    return {box_model(place, band),  plate_model(place, band), cone_model(place, band, false), cone_model(place, band, true),
            dome_model(place, band), ring_model(place, band),  rod_model(place, band),         fillet_model(place, band), odd_cone_model(place, band)};
}

}  // namespace crescente::geometry::test
