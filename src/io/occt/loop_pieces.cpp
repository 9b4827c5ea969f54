#include "io/occt/loop_pieces.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace crescente::io::occt {
namespace {

using namespace geometry;

Point2 operator+(Point2 a, Point2 b) { return {a.u + b.u, a.v + b.v}; }
Point2 operator*(Point2 a, double s) { return {a.u * s, a.v * s}; }
double distance(Point2 a, Point2 b) { return std::hypot(a.u - b.u, a.v - b.v); }

Point2 arc_point(const ArcPiece& arc, double angle) { return arc.center + arc.x * std::cos(angle) + arc.y * std::sin(angle); }

// De Casteljau on the homogeneous points.
Point2 bezier_point(const BezierPiece& piece, double s) {
    auto points = piece.points;
    for (std::size_t n = points.size() - 1; n > 0; --n) {
        for (std::size_t i = 0; i < n; ++i) {
            auto &a = points[i], &b = points[i + 1];
            a = {a.u + s * (b.u - a.u), a.v + s * (b.v - a.v), a.weight + s * (b.weight - a.weight)};
        }
    }
    return {points[0].u / points[0].weight, points[0].v / points[0].weight};
}

// The cubic through four points of the curve at equal steps.
BezierPiece cubic_through(const Point2 (&p)[4]) {
    const Point2 one = (p[0] * -5 + p[1] * 18 + p[2] * -9 + p[3] * 2) * (1.0 / 6), two = (p[0] * 2 + p[1] * -9 + p[2] * 18 + p[3] * -5) * (1.0 / 6);
    return {{{p[0].u, p[0].v, 1}, {one.u, one.v, 1}, {two.u, two.v, 1}, {p[3].u, p[3].v, 1}}};
}

void fit(const std::function<Point2(double)>& curve, double from, double to, double tolerance, int halvings_left, std::vector<LoopPiece>& pieces) {
    const auto at = [&](double s) { return curve(from + (to - from) * s); };
    const Point2 through[4] = {at(0), at(1.0 / 3), at(2.0 / 3), at(1)};
    const BezierPiece cubic = cubic_through(through);
    double error = 0;
    for (const double s : {1.0 / 6, 0.5, 5.0 / 6}) error = std::max(error, distance(bezier_point(cubic, s), at(s)));
    if (error <= tolerance || halvings_left == 0) {
        pieces.push_back(cubic);
        return;
    }
    const double middle = (from + to) / 2;
    fit(curve, from, middle, tolerance, halvings_left - 1, pieces);
    fit(curve, middle, to, tolerance, halvings_left - 1, pieces);
}

LoopPiece affinely_mapped(const LoopPiece& piece, const ParameterMap& map) {
    if (const auto* line = std::get_if<LinePiece>(&piece)) return LinePiece{map(line->from), map(line->to)};
    const Point2 zero = map({0, 0});
    const auto vector = [&](Point2 p) {
        const Point2 end = map(p);
        return Point2{end.u - zero.u, end.v - zero.v};
    };
    if (const auto* arc = std::get_if<ArcPiece>(&piece)) return ArcPiece{map(arc->center), vector(arc->x), vector(arc->y), arc->a0, arc->a1};
    BezierPiece bezier = std::get<BezierPiece>(piece);
    for (auto& c : bezier.points) {
        const Point2 p = map({c.u / c.weight, c.v / c.weight});
        c = {p.u * c.weight, p.v * c.weight, c.weight};
    }
    return bezier;
}

}  // namespace

Point2 point_on(const LoopPiece& piece, double s) {
    if (const auto* line = std::get_if<LinePiece>(&piece)) return s == 0 ? line->from : s == 1 ? line->to : line->from * (1 - s) + line->to * s;
    if (const auto* arc = std::get_if<ArcPiece>(&piece)) return arc_point(*arc, s == 1 ? arc->a1 : arc->a0 + (arc->a1 - arc->a0) * s);
    return bezier_point(std::get<BezierPiece>(piece), s);
}

LoopPiece reversed(const LoopPiece& piece) {
    if (const auto* line = std::get_if<LinePiece>(&piece)) return LinePiece{line->to, line->from};
    if (const auto* arc = std::get_if<ArcPiece>(&piece)) return ArcPiece{arc->center, arc->x, arc->y, arc->a1, arc->a0};
    BezierPiece bezier = std::get<BezierPiece>(piece);
    std::reverse(bezier.points.begin(), bezier.points.end());
    return bezier;
}

void Box2::grow(Point2 p) { u0 = std::min(u0, p.u), u1 = std::max(u1, p.u), v0 = std::min(v0, p.v), v1 = std::max(v1, p.v); }

void grow(Box2& box, const LoopPiece& piece) {
    if (const auto* bezier = std::get_if<BezierPiece>(&piece)) {
        for (const auto& c : bezier->points) box.grow({c.u / c.weight, c.v / c.weight});
        return;
    }
    box.grow(point_on(piece, 0)), box.grow(point_on(piece, 1));
    const auto* arc = std::get_if<ArcPiece>(&piece);
    if (!arc) return;
    const auto [low, high] = std::minmax(arc->a0, arc->a1);
    for (const double extreme : {std::atan2(arc->y.u, arc->x.u), std::atan2(arc->y.v, arc->x.v)}) {  // where the tangent stands still in u, in v
        for (double a = extreme + std::ceil((low - extreme) / math::pi) * math::pi; a <= high; a += math::pi) box.grow(arc_point(*arc, a));
    }
}

ParameterMap affine_map(double uu, double uv, double u, double vu, double vv, double v) {
    return {ParameterMap::Kind::affine, [=](Point2 p) { return Point2{uu * p.u + uv * p.v + u, vu * p.u + vv * p.v + v}; }};
}

std::vector<LoopPiece> mapped(const LoopPiece& piece, const ParameterMap& map, double tolerance) {
    using Kind = ParameterMap::Kind;
    if (map.kind == Kind::identity) return {piece};
    if (map.kind == Kind::affine) return {affinely_mapped(piece, map)};
    if (const auto* line = std::get_if<LinePiece>(&piece)) {
        constexpr double straight = 1e-12;  // relative to the parameters: what a constant parameter may stray
        const auto constant = [](double a, double b) { return std::abs(a - b) <= straight * (1 + std::abs(a)); };
        const bool constant_u = constant(line->from.u, line->to.u), constant_v = constant(line->from.v, line->to.v);
        if (constant_u || (constant_v && map.kind == Kind::separable)) return {LinePiece{map(line->from), map(line->to)}};
        if (constant_v) {
            const Point2 zero = map({0, line->from.v}), quarter = map({math::pi / 2, line->from.v});
            return {ArcPiece{{}, zero, quarter, line->from.u, line->to.u}};
        }
    }
    std::vector<LoopPiece> pieces;
    constexpr int most_halvings = 10;
    fit([&](double s) { return map(point_on(piece, s)); }, 0, 1, tolerance, most_halvings, pieces);
    return pieces;
}

}  // namespace crescente::io::occt
