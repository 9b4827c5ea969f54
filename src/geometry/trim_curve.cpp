#include "geometry/trim_curve.h"

#include <algorithm>
#include <cmath>

#include "math/bracketed_root.h"

namespace crescente::geometry {
namespace {

// Value and derivative of a rational Bézier curve by de Casteljau's scheme on homogeneous points (Farin 2002, "Curves and Surfaces for CAGD", 13.5).
CurvePoint evaluate_bezier(const BezierPiece& curve, double t) {
    constexpr std::size_t few = 32;
    BezierPiece::Control fixed[few];
    std::vector<BezierPiece::Control> many;
    const std::size_t count = curve.points.size();
    BezierPiece::Control* p = fixed;
    if (count > few) many.resize(count), p = many.data();
    std::copy(curve.points.begin(), curve.points.end(), p);
    for (std::size_t n = count - 1; n > 1; --n) {
        for (std::size_t i = 0; i < n; ++i) {
            p[i] = {p[i].u + t * (p[i + 1].u - p[i].u), p[i].v + t * (p[i + 1].v - p[i].v), p[i].weight + t * (p[i + 1].weight - p[i].weight)};
        }
    }
    const double degree = static_cast<double>(count - 1);
    const BezierPiece::Control d{p[1].u - p[0].u, p[1].v - p[0].v, p[1].weight - p[0].weight};
    const double w = p[0].weight + t * d.weight;
    const Point2 at{(p[0].u + t * d.u) / w, (p[0].v + t * d.v) / w};
    return {at, {degree * (d.u - at.u * d.weight) / w, degree * (d.v - at.v * d.weight) / w}};
}

double choose(int n, int k) {
    double c = 1;
    for (int i = 1; i <= k; ++i) c = c * (n - k + i) / i;
    return c;
}

// The coefficients of the product of two polynomials in Bernstein form (Farouki, Rajan 1988, "Algorithms for polynomials in Bernstein form").
std::vector<double> product(const std::vector<double>& a, const std::vector<double>& b) {
    const int m = static_cast<int>(a.size()) - 1, n = static_cast<int>(b.size()) - 1;
    std::vector<double> c(a.size() + b.size() - 1);
    for (int i = 0; i <= m; ++i) {
        for (int j = 0; j <= n; ++j) c[i + j] += choose(m, i) * choose(n, j) / choose(m + n, i + j) * a[i] * b[j];
    }
    return c;
}

// Roots inside (t0, t1) of a polynomial given in Bernstein form there, by variation diminishing: where the coefficients do not change sign there is no
// root. An interval is halved until it has at most one change, and that one is bracketed by halving. Appended in ascending order.
void roots(std::vector<double> c, double t0, double t1, int depth, std::vector<double>& found) {
    int changes = 0;
    double last = 0;
    for (const double value : c) {
        if (value == 0) continue;
        changes += last != 0 && (value < 0) != (last < 0);
        last = value;
    }
    if (changes == 0) return;
    if (depth == 50) {
        if (found.empty() || found.back() < t0) found.push_back(0.5 * (t0 + t1));
        return;
    }
    const double middle = 0.5 * (t0 + t1);
    std::vector<double> left(c.size()), right(c.size());
    for (std::size_t n = c.size(); n > 0; --n) {
        left[c.size() - n] = c[0];
        right[n - 1] = c[n - 1];
        for (std::size_t i = 0; i + 1 < n; ++i) c[i] = 0.5 * (c[i] + c[i + 1]);
    }
    roots(std::move(left), t0, middle, depth + 1, found);
    if (right[0] == 0 && (found.empty() || found.back() < middle)) found.push_back(middle);
    roots(std::move(right), middle, t1, depth + 1, found);
}

// Where one coordinate of the curve turns: zeros of P'W - P W'.
void add_turns(const BezierPiece& curve, double BezierPiece::Control::*coordinate, std::vector<double>& found) {
    const std::size_t degree = curve.points.size() - 1;
    std::vector<double> p, w, dp, dw;
    double size = 0;
    for (std::size_t i = 0; i <= degree; ++i) {
        p.push_back(curve.points[i].*coordinate), w.push_back(curve.points[i].weight);
        if (i > 0) dp.push_back(p[i] - p[i - 1]), dw.push_back(w[i] - w[i - 1]);
        size = std::max(size, std::abs(p[i] * w[i]));
    }
    std::vector<double> turn = product(dp, w);
    const std::vector<double> other = product(p, dw);
    for (std::size_t i = 0; i < turn.size(); ++i) {
        turn[i] -= other[i];
        if (std::abs(turn[i]) <= 1e-14 * size) turn[i] = 0;  // what rounding makes of a line along an axis
    }
    std::vector<double> own;
    roots(std::move(turn), 0, 1, 0, own);
    found.insert(found.end(), own.begin(), own.end());
}

}  // namespace

CurvePoint evaluate(const LoopPiece& curve, double t) {
    if (const auto* arc = std::get_if<ArcPiece>(&curve)) {
        const double c = std::cos(t), s = std::sin(t);
        return {{arc->center.u + c * arc->x.u + s * arc->y.u, arc->center.v + c * arc->x.v + s * arc->y.v},
                {c * arc->y.u - s * arc->x.u, c * arc->y.v - s * arc->x.v}};
    }
    return evaluate_bezier(std::get<BezierPiece>(curve), t);
}

Point2 first_point(const LoopPiece& piece) {
    if (const auto* line = std::get_if<LinePiece>(&piece)) return line->from;
    if (const auto* arc = std::get_if<ArcPiece>(&piece)) return evaluate(piece, arc->a0).at;
    const auto& p = std::get<BezierPiece>(piece).points.front();
    return {p.u / p.weight, p.v / p.weight};
}

Point2 last_point(const LoopPiece& piece) {
    if (const auto* line = std::get_if<LinePiece>(&piece)) return line->to;
    if (const auto* arc = std::get_if<ArcPiece>(&piece)) return evaluate(piece, arc->a1).at;
    const auto& p = std::get<BezierPiece>(piece).points.back();
    return {p.u / p.weight, p.v / p.weight};
}

std::vector<double> monotone_stops(const LoopPiece& curve) {
    std::vector<double> stops;
    if (const auto* arc = std::get_if<ArcPiece>(&curve)) {
        // u turns where its phase is a multiple of pi; v likewise.
        const double low = std::min(arc->a0, arc->a1), high = std::max(arc->a0, arc->a1), tiny = 1e-12 * (high - low);
        stops = {low, high};
        for (const double phase : {std::atan2(arc->y.u, arc->x.u), std::atan2(arc->y.v, arc->x.v)}) {
            for (double a = phase + pi * std::ceil((low - phase) / pi); a < high; a += pi) {
                if (a > low + tiny && a < high - tiny) stops.push_back(a);
            }
        }
        std::sort(stops.begin(), stops.end());
        stops.erase(std::unique(stops.begin(), stops.end(), [=](double a, double b) { return b - a <= tiny; }), stops.end());
        stops.back() = high;
        if (arc->a0 > arc->a1) std::reverse(stops.begin(), stops.end());
        return stops;
    }
    stops = {0, 1};
    const auto& bezier = std::get<BezierPiece>(curve);
    add_turns(bezier, &BezierPiece::Control::u, stops);
    add_turns(bezier, &BezierPiece::Control::v, stops);
    std::sort(stops.begin(), stops.end());
    stops.erase(std::unique(stops.begin(), stops.end(), [](double a, double b) { return b - a <= 1e-12; }), stops.end());
    stops.back() = 1;
    return stops;
}

namespace {

// One coordinate of a monotone stretch where the other has a value: a bracketed root, in the curve's parameter.
double other_coordinate(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve, double value, double Point2::*known,
                        double Point2::*wanted) {
    const double a = piece.from.*known, b = piece.to.*known, from = piece.from.*wanted, to = piece.to.*wanted;
    const auto [least, most] = std::minmax(from, to);
    if (a == b || value <= std::min(a, b)) return a <= b ? from : to;
    if (value >= std::max(a, b)) return a <= b ? to : from;
    const double share = (value - a) / (b - a);
    if (piece.is_line()) return std::clamp(from + share * (to - from), least, most);
    const auto [low, high] = std::minmax(stretch->t0, stretch->t1);
    const auto f = [&](double t) -> ValueAndSlope {
        const CurvePoint p = evaluate(*curve, t);
        return {p.at.*known - value, p.slope.*known};
    };
    const bool rising = (b > a) == (stretch->t1 > stretch->t0);
    const double t = bracketed_root(f, low, high, rising, stretch->t0 + share * (stretch->t1 - stretch->t0));
    return std::clamp(evaluate(*curve, t).at.*wanted, least, most);
}

}  // namespace

double u_at(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve, double v) {
    return other_coordinate(piece, stretch, curve, v, &Point2::v, &Point2::u);
}
double v_at(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve, double u) {
    return other_coordinate(piece, stretch, curve, u, &Point2::u, &Point2::v);
}

CurvePoint middle_of(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve) {
    if (!piece.is_line()) return evaluate(*curve, 0.5 * (stretch->t0 + stretch->t1));
    return {{0.5 * (piece.from.u + piece.to.u), 0.5 * (piece.from.v + piece.to.v)}, {piece.to.u - piece.from.u, piece.to.v - piece.from.v}};
}

namespace {

// Control points of the part of a Bézier piece between two parameters: both ends are cut off by de Casteljau's scheme.
std::vector<BezierPiece::Control> part_of(const BezierPiece& curve, double t0, double t1) {
    std::vector<BezierPiece::Control> p = curve.points;
    const auto mix = [](BezierPiece::Control a, BezierPiece::Control b, double t) {
        return BezierPiece::Control{a.u + t * (b.u - a.u), a.v + t * (b.v - a.v), a.weight + t * (b.weight - a.weight)};
    };
    const auto keep_before = [&](double t) {
        for (std::size_t n = 1; n < p.size(); ++n) {
            for (std::size_t i = p.size() - 1; i >= n; --i) p[i] = mix(p[i - 1], p[i], t);
        }
    };
    keep_before(t1);
    std::reverse(p.begin(), p.end());
    keep_before(t1 > 0 ? 1 - t0 / t1 : 0);
    return p;
}

}  // namespace

void measure_bulge(const MonotonePiece& piece, CurveStretch& stretch, const LoopPiece& curve) {
    const Point2 chord{piece.to.u - piece.from.u, piece.to.v - piece.from.v};
    const double length2 = chord.u * chord.u + chord.v * chord.v;
    double low = 0, high = 0;
    const auto include = [&](Point2 p) {
        const double bulge = (chord.u * (p.v - piece.from.v) - chord.v * (p.u - piece.from.u)) / length2;
        low = std::min(low, bulge), high = std::max(high, bulge);
    };
    if (const auto* bezier = std::get_if<BezierPiece>(&curve)) {
        const auto [t0, t1] = std::minmax(stretch.t0, stretch.t1);
        for (const auto& p : part_of(*bezier, t0, t1)) include({p.u / p.weight, p.v / p.weight});
    } else {  // the corners of its box, ends before they were welded included
        const Point2 first = evaluate(curve, stretch.t0).at, last = evaluate(curve, stretch.t1).at;
        const auto [u0, u1] = std::minmax({piece.from.u, piece.to.u, first.u, last.u});
        const auto [v0, v1] = std::minmax({piece.from.v, piece.to.v, first.v, last.v});
        for (const double u : {u0, u1}) include({u, v0}), include({u, v1});
    }
    // Outward by a unit at least, for rounding.
    low = std::floor(low / CurveStretch::bulge_unit) - 1, high = std::ceil(high / CurveStretch::bulge_unit) + 1;
    const bool fits = low > -CurveStretch::no_bulge && high < CurveStretch::no_bulge;
    stretch.low = static_cast<std::int16_t>(fits ? low : 0), stretch.high = static_cast<std::int16_t>(fits ? high : CurveStretch::no_bulge);
}

bool surely_farther(const MonotonePiece& piece, const CurveStretch& stretch, const LoopPiece& curve, Point2 p, const Metric& metric, double distance) {
    constexpr double more = 1 + 1e-6;  // than rounding
    const double uu = metric.uu, uv = metric.uv, vv = metric.vv, determinant = (uu * vv - uv * uv) - 1e-9 * uu * vv, distance2 = distance * distance * more;
    if (!(determinant > 0)) return false;
    // Off the strip about the chord: by Cauchy-Schwarz for the metric, a linear function with gradient n changes by at most sqrt(n G^-1 n) a unit of length.
    const Point2 chord{piece.to.u - piece.from.u, piece.to.v - piece.from.v};
    const double bulge = chord.u * (p.v - piece.from.v) - chord.v * (p.u - piece.from.u), unit = CurveStretch::bulge_unit * (chord.u * chord.u + chord.v * chord.v);
    const double off = std::max(stretch.low * unit - bulge, bulge - stretch.high * unit);
    if (stretch.high != CurveStretch::no_bulge && off > 0 && off * off * determinant > distance2 * (vv * chord.v * chord.v + 2 * uv * chord.u * chord.v + uu * chord.u * chord.u)) return true;
    const auto* arc = std::get_if<ArcPiece>(&curve);
    if (!arc) return false;
    const auto near = [&](Point2 q) {  // the ends are welded, perhaps off the ellipse
        const double u = q.u - p.u, v = q.v - p.v;
        return uu * u * u + 2 * uv * u * v + vv * v * v <= distance2;
    };
    if (near(piece.from) || near(piece.to)) return false;
    // Off the ellipse: where it is the unit circle, lengths are shorter by its least half axis at most, whose square is not less than det / trace.
    const double area = arc->x.u * arc->y.v - arc->x.v * arc->y.u;
    const Point2 d{p.u - arc->center.u, p.v - arc->center.v};
    const double a = d.u * arc->y.v - d.v * arc->y.u, b = arc->x.u * d.v - arc->x.v * d.u;
    const double apart = std::abs(std::sqrt(a * a + b * b) - std::abs(area)) - 1e-9 * std::abs(area);  // times the area
    const double trace = uu * (arc->x.u * arc->x.u + arc->y.u * arc->y.u) + 2 * uv * (arc->x.u * arc->x.v + arc->y.u * arc->y.v) +
                         vv * (arc->x.v * arc->x.v + arc->y.v * arc->y.v);
    return apart > 0 && apart * apart * determinant > distance2 * trace;
}

NearestPoint nearest_point(const MonotonePiece& piece, const CurveStretch* stretch, const LoopPiece* curve, Point2 p, const Metric& metric) {
    const auto inner = [&](Point2 a, Point2 b) { return metric.uu * a.u * b.u + metric.uv * (a.u * b.v + a.v * b.u) + metric.vv * a.v * b.v; };
    const auto from_p = [&](Point2 q) { return Point2{q.u - p.u, q.v - p.v}; };
    const Point2 chord{piece.to.u - piece.from.u, piece.to.v - piece.from.v};
    const Point2 start = from_p(piece.from), end = from_p(piece.to);
    if (piece.is_line()) {
        const double length2 = inner(chord, chord);
        const double share = length2 > 0 ? std::clamp(-inner(start, chord) / length2, 0.0, 1.0) : 0;
        const Point2 at{piece.from.u + share * chord.u, piece.from.v + share * chord.v}, off = from_p(at);
        return {at, chord, inner(off, off)};
    }
    NearestPoint best{piece.from, evaluate(*curve, stretch->t0).slope, inner(start, start)};
    if (const double d = inner(end, end); d < best.distance2) best = {piece.to, evaluate(*curve, stretch->t1).slope, d};
    // Half the slope of the squared distance; its own slope without the curvature's share, which the safeguard of the root forgives.
    const auto f = [&](double t) -> ValueAndSlope {
        const CurvePoint c = evaluate(*curve, t);
        return {inner(from_p(c.at), c.slope), inner(c.slope, c.slope)};
    };
    // The foot of the perpendicular next to the nearest of a few points.
    constexpr int shares = 8;
    const auto parameter = [&](int k) { return k == 0 ? stretch->t0 : k == shares ? stretch->t1 : stretch->t0 + (stretch->t1 - stretch->t0) * k / shares; };
    int nearest = best.at == piece.from ? 0 : shares;
    double least = best.distance2;
    for (int k = 1; k < shares; ++k) {
        const Point2 off = from_p(evaluate(*curve, parameter(k)).at);
        if (const double d = inner(off, off); d < least) least = d, nearest = k;
    }
    const double one = parameter(std::max(nearest - 1, 0)), other = parameter(std::min(nearest + 1, shares));
    const double low = std::min(one, other), high = std::max(one, other);
    const double falling = f(low).value, rising = f(high).value;
    if (falling < 0 && rising > 0) {
        const CurvePoint c = evaluate(*curve, bracketed_root(f, low, high, true, low + (high - low) * (falling / (falling - rising))));
        const Point2 off = from_p(c.at);
        if (const double d = inner(off, off); d < best.distance2) best = {c.at, c.slope, d};
    }
    return best;
}

}  // namespace crescente::geometry
