#include "geometry/curve.h"

#include <algorithm>
#include <cmath>

#include "geometry/bernstein.h"

namespace crescente::geometry {
namespace {

// A value of the blossom as weights of the degree + 1 control points that the span depends on (de Boor's algorithm, a parameter a level).
std::vector<double> blossom(const std::vector<double>& knots, std::size_t span, int degree, const std::vector<double>& at) {
    const auto p = static_cast<std::size_t>(degree);
    std::vector<std::vector<double>> d(p + 1, std::vector<double>(p + 1, 0));
    for (std::size_t j = 0; j <= p; ++j) d[j][j] = 1;
    for (std::size_t r = 1; r <= p; ++r) {
        for (std::size_t j = p; j >= r; --j) {
            const std::size_t i = span - p + j;
            const double low = knots[i], high = knots[i + p - r + 1], share = (at[r - 1] - low) / (high - low);
            for (std::size_t k = 0; k <= p; ++k) d[j][k] = d[j - 1][k] * (1 - share) + d[j][k] * share;
        }
    }
    return d[p];
}

std::vector<CurvePiece> spline_pieces(const Curve& curve, const std::vector<double>& knots, std::size_t count) {
    std::vector<CurvePiece> pieces;
    for (const KnotSpan& span : knot_spans(knots, curve.degree)) {
        CurvePiece& piece = pieces.emplace_back(CurvePiece{span.from, span.to, {}, !curve.weights.empty()});
        for (const auto& row : span.matrix) {
            ControlPoint sum{{}, 0};
            for (std::size_t j = 0; j < row.size(); ++j) {
                const std::size_t k = (span.first + j) % count;
                const double weight = curve.weights.empty() ? 1 : curve.weights[k];
                sum.weighted += curve.points[k] * (weight * row[j]), sum.weight += weight * row[j];
            }
            if (curve.weights.empty()) sum.weight = 1;
            piece.points.push_back(sum);
        }
    }
    return pieces;
}

// Rational quadratics of a quarter turn at most.
Expected<std::vector<CurvePiece>> arc_pieces(Vec3 from, Vec3 through, Vec3 to) {
    const Vec3 a = through - from, b = to - from, normal = cross(a, b);
    const double area2 = dot(normal, normal);
    if (!(area2 > 1e-24 * dot(a, a) * dot(b, b))) return failure(ErrorKind::input, {"", "points", "the three points of the arc are in one line", ""});
    const Vec3 center = from + (cross(normal, a) * dot(b, b) + cross(b, normal) * dot(a, a)) / (2 * area2);
    const Vec3 x = from - center;
    const double radius = length(x);
    const Vec3 unit = normalize(normal), y = cross(unit, x);
    const Vec3 end = to - center;
    double sweep = std::atan2(dot(end, y), dot(end, x));
    if (sweep <= 0) sweep += 2 * pi;
    const int count = static_cast<int>(std::ceil(sweep / (0.5 * pi) - 1e-9));
    std::vector<CurvePiece> pieces;
    for (int k = 0; k < count; ++k) {
        const double a0 = sweep * k / count, a1 = sweep * (k + 1) / count, middle = 0.5 * (a0 + a1), w = std::cos(0.5 * (a1 - a0));
        const auto on = [&](double angle) { return center + x * std::cos(angle) + y * std::sin(angle); };
        const Vec3 tip = center + (on(middle) - center) / w;
        const Vec3 first = k == 0 ? from : on(a0), last = k + 1 == count ? to : on(a1);
        pieces.push_back({a0 * radius, a1 * radius, {{first, 1}, {tip * w, w}, {last, 1}}, true});
    }
    return pieces;
}

}  // namespace

std::string knot_problem(const std::vector<double>& knots, std::size_t points, int degree) {
    const auto p = static_cast<std::size_t>(degree);
    if (points < p + 1) return "degree " + std::to_string(degree) + " needs at least " + std::to_string(p + 1) + " points, there are " + std::to_string(points);
    if (knots.size() != points + p + 1) {
        return "there are " + std::to_string(knots.size()) + " knots, must be " + std::to_string(points + p + 1) + ": as many as points, the degree and 1";
    }
    std::size_t equal = 1;
    for (std::size_t i = 0; i < knots.size(); ++i) {
        if (!std::isfinite(knots[i])) return "knot " + std::to_string(i) + " is not finite";
        if (i == 0) continue;
        if (knots[i] < knots[i - 1]) return "knot " + std::to_string(i) + " is less than the one before";
        equal = knots[i] == knots[i - 1] ? equal + 1 : 1;
        if (equal > p + 1) return "knot " + std::to_string(i) + " is repeated more than degree + 1 times";
    }
    if (!(knots[points] > knots[p])) return "the knots leave no range";
    return {};
}

std::vector<KnotSpan> knot_spans(const std::vector<double>& knots, int degree) {
    const auto p = static_cast<std::size_t>(degree);
    std::vector<KnotSpan> spans;
    for (std::size_t span = p; span + p + 1 < knots.size(); ++span) {
        const double from = knots[span], to = knots[span + 1];
        if (!(to > from)) continue;
        KnotSpan& result = spans.emplace_back(KnotSpan{from, to, span - p, {}});
        for (std::size_t k = 0; k <= p; ++k) {
            std::vector<double> at(p, from);
            std::fill(at.end() - static_cast<std::ptrdiff_t>(k), at.end(), to);
            result.matrix.push_back(blossom(knots, span, degree, at));
        }
    }
    return spans;
}

Expected<std::vector<CurvePiece>> pieces_of(const Curve& curve) {
    const auto wrong = [](const std::string& place, const std::string& reason) { return failure(ErrorKind::input, {"", place, reason, ""}); };
    const std::size_t count = curve.points.size();
    for (const Vec3 p : curve.points) {
        if (!is_finite(p)) return wrong("points", "a point is not finite");
    }
    if (!curve.weights.empty()) {
        if (curve.kind == CurveKind::polyline || curve.kind == CurveKind::arc) return wrong("weights", "this kind of curve has none");
        if (curve.weights.size() != count) {
            return wrong("weights", "there are " + std::to_string(curve.weights.size()) + " weights for " + std::to_string(count) + " points");
        }
        for (const double w : curve.weights) {
            if (!(w > 0) || !std::isfinite(w)) return wrong("weights", "weights must be positive");
        }
    }
    if (!curve.knots.empty() && curve.kind != CurveKind::nurbs) return wrong("knots", "only nurbs curves have knots");
    if (curve.closed && curve.kind != CurveKind::polyline && curve.kind != CurveKind::b_spline) return wrong("closed", "only a polyline or b_spline is closed");
    const auto p = static_cast<std::size_t>(curve.degree);
    std::vector<CurvePiece> pieces;
    switch (curve.kind) {
        case CurveKind::polyline:
            if (count < (curve.closed ? 3u : 2u)) return wrong("points", "there are too few points for a curve");
            for (std::size_t i = 0; i + 1 < count + curve.closed; ++i) {
                const double s = static_cast<double>(i);
                pieces.push_back({s, s + 1, {{curve.points[i], 1}, {curve.points[(i + 1) % count], 1}}, false});
            }
            return pieces;
        case CurveKind::bezier: {
            if (count < 2) return wrong("points", "there are too few points for a curve");
            if (count > max_patch_degree + 1) return wrong("points", "the degree is more than " + std::to_string(max_patch_degree));
            CurvePiece& piece = pieces.emplace_back();
            piece.rational = !curve.weights.empty();
            for (std::size_t i = 0; i < count; ++i) {
                const double w = curve.weights.empty() ? 1 : curve.weights[i];
                piece.points.push_back({curve.points[i] * w, w});
            }
            return pieces;
        }
        case CurveKind::b_spline: {
            if (count < p + 1) return wrong("points", "degree " + std::to_string(curve.degree) + " needs at least " + std::to_string(p + 1) + " points");
            std::vector<double> knots;
            if (curve.closed) {
                for (std::size_t i = 0; i < count + 2 * p + 1; ++i) knots.push_back(static_cast<double>(i) - static_cast<double>(p));
            } else {
                for (std::size_t i = 0; i < count + p + 1; ++i) knots.push_back(static_cast<double>(std::clamp(i, p, count) - p));
            }
            return spline_pieces(curve, knots, count);
        }
        case CurveKind::nurbs:
            if (const std::string problem = knot_problem(curve.knots, count, curve.degree); !problem.empty()) return wrong("knots", problem);
            return spline_pieces(curve, curve.knots, count);
        case CurveKind::arc: break;
    }
    if (count != 3) return wrong("points", "an arc has three points: its ends, and one between");
    return arc_pieces(curve.points[0], curve.points[1], curve.points[2]);
}

void raise_degree(CurvePiece& piece, std::size_t to) {
    while (piece.points.size() < to + 1) {
        const std::size_t n = piece.points.size();  // the new degree
        std::vector<ControlPoint> raised{piece.points.front()};
        for (std::size_t i = 1; i < n; ++i) raised.push_back(between(piece.points[i], piece.points[i - 1], static_cast<double>(i) / static_cast<double>(n)));
        raised.push_back(piece.points.back());
        piece.points = std::move(raised);
    }
}

CurvePiece cut_off(CurvePiece& piece, double s) {
    CurvePiece behind = piece;
    cut(piece.points.data(), behind.points.data(), static_cast<int>(piece.points.size()), 1, (s - piece.s0) / (piece.s1 - piece.s0));
    piece.s1 = behind.s0 = s;
    return behind;
}

const FieldTable<Curve>& Curve::fields() {
    static const FieldTable<Curve> table{
        field(&Curve::kind, {"kind", FieldType::choice, "", 0, 4, "What the points mean", {"polyline", "bezier", "b_spline", "nurbs", "arc"}}),
        field(&Curve::degree, {"degree", FieldType::integer, "", 1, max_patch_degree, "Of b_spline and nurbs"}),
        field(&Curve::closed, {"closed", FieldType::boolean, "", -unbounded, unbounded, "Whether a polyline or b_spline returns to its beginning"}),
    };
    return table;
}

}  // namespace crescente::geometry
