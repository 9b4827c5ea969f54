#include "geometry/swept.h"

#include <algorithm>
#include <cmath>

#include "geometry/bernstein.h"
#include "math/transform.h"

namespace crescente::geometry {
namespace {

// The pieces of curves one after another, with parameters that go on.
Expected<std::vector<CurvePiece>> pieces_of(const std::vector<Curve>& curves, const std::string& name) {
    if (curves.empty()) return failure(ErrorKind::input, {"", name, "there is no curve", ""});
    std::vector<CurvePiece> all;
    for (std::size_t k = 0; k < curves.size(); ++k) {
        auto pieces = pieces_of(curves[k]);
        if (!pieces) {
            for (Problem& problem : pieces.error().problems) problem.place = name + "/" + std::to_string(k) + "/" + problem.place;
            return tl::unexpected(pieces.error());
        }
        const double shift = all.empty() ? 0 : all.back().s1 - pieces->front().s0;
        for (CurvePiece& piece : *pieces) {
            piece.s0 += shift, piece.s1 += shift;
            all.push_back(std::move(piece));
        }
    }
    return all;
}

int degree_of(const CurvePiece& piece) { return static_cast<int>(piece.points.size()) - 1; }

// An affine map and its derivative by the angle.
struct Motion {
    Affine at, slope;
};

Affine scaled(const Affine& m, double s) { return {m.x * s, m.y * s, m.z * s, m.origin * s}; }
Affine sum(const Affine& a, const Affine& b) { return {a.x + b.x, a.y + b.y, a.z + b.z, a.origin + b.origin}; }
// Derivatives of products: linear parts and origins as of 4 x 4 matrices whose last row is 0 0 0 1 or, for derivatives, 0.
Affine linear_times(const Affine& slope, const Affine& m) { return {slope.vector(m.x), slope.vector(m.y), slope.vector(m.z), slope.point(m.origin)}; }
Affine times_slope(const Affine& m, const Affine& slope) { return {m.vector(slope.x), m.vector(slope.y), m.vector(slope.z), m.vector(slope.origin)}; }

Motion product(const Motion& a, const Motion& b) { return {a.at * b.at, sum(linear_times(a.slope, b.at), times_slope(a.at, b.slope))}; }

constexpr Affine nothing{{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};

Motion about_z(double angle, double rate) {
    const double c = std::cos(angle), s = std::sin(angle);
    Motion m{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}, {}}, nothing};
    m.slope = {Vec3{-s, c, 0} * rate, Vec3{-c, -s, 0} * rate, {}, {}};
    return m;
}

Motion about_y(double angle) {  // x towards -z
    const double c = std::cos(angle), s = std::sin(angle);
    return {{{c, 0, -s}, {0, 1, 0}, {s, 0, c}, {}}, {{-s, 0, -c}, {}, {c, 0, -s}, {}}};
}

Motion moved(Vec3 by, Vec3 rate) { return {Affine::translation(by), {{}, {}, {}, rate}}; }

// The factor at knot i of the directrix and its slope, a cubic Hermite spline with the slopes of Catmull and Rom.
struct Factor {
    double value, slope;
};

Factor directrix_at(const std::vector<double>& factors, bool closes, double share, double sweep) {
    if (factors.empty()) return {1, 0};
    const auto n = static_cast<std::ptrdiff_t>(factors.size());
    if (n == 1) return {factors[0], 0};
    const std::ptrdiff_t steps = closes ? n : n - 1;
    const double place = share * static_cast<double>(steps), step = sweep / static_cast<double>(steps);
    const std::ptrdiff_t k = std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(std::floor(place)), 0, steps - 1);
    const auto value = [&](std::ptrdiff_t i) { return factors[static_cast<std::size_t>(closes ? (i + n) % n : std::clamp<std::ptrdiff_t>(i, 0, n - 1))]; };
    const auto slope = [&](std::ptrdiff_t i) {
        const bool inner = closes || (i > 0 && i < n - 1);
        return (value(i + 1) - value(i - 1)) / (inner ? 2 : 1);
    };
    const double s = place - static_cast<double>(k), a = value(k), b = value(k + 1), da = slope(k), db = slope(k + 1);
    const double c2 = 3 * (b - a) - 2 * da - db, c3 = 2 * (a - b) + da + db;
    return {a + s * (da + s * (c2 + s * c3)), (da + s * (2 * c2 + s * 3 * c3)) / step};
}

}  // namespace

Expected<std::vector<BezierPatch>> Revolution::patches() const {
    const auto wrong = [](const std::string& place, const std::string& reason) { return failure(ErrorKind::input, {"", place, reason, ""}); };
    const auto pieces = pieces_of(profile, "profile");
    if (!pieces) return tl::unexpected(pieces.error());
    if (!(std::abs(sweep) > 1e-9) || std::abs(sweep) > 1000 * pi) return wrong("sweep", "must not be 0, nor more than 500 turns");
    for (const double number : {start, twist, pitch, pivot.x, pivot.y}) {
        if (!std::isfinite(number)) return wrong("profile", "numbers must be finite");
    }
    for (const double factor : directrix) {
        if (!(factor >= 0) || !std::isfinite(factor)) return wrong("directrix", "factors must not be negative");
    }
    std::vector<BezierPatch> result;
    const bool circle = twist == 0 && pitch == 0 && directrix.size() <= 1;
    if (circle) {
        const double factor = directrix.empty() ? 1 : directrix[0];
        const int count = std::max(1, static_cast<int>(std::ceil(std::abs(sweep) / (0.5 * pi) - 1e-9)));
        for (int k = 0; k < count; ++k) {
            const double a0 = start + sweep * k / count, a1 = start + sweep * (k + 1) / count, w = std::cos(0.5 * (a1 - a0));
            // A full turn ends where it begins, to the bit.
            const bool closes = k + 1 == count && std::abs(std::abs(sweep) - 2 * pi) < 1e-12;
            const Affine turns[] = {about_y(a0).at, about_y(0.5 * (a0 + a1)).at, about_y(closes ? start : a1).at};
            for (const CurvePiece& piece : *pieces) {
                BezierPatch& patch = result.emplace_back(BezierPatch{2, degree_of(piece), true, a0, a1, piece.s0, piece.s1, {}});
                for (int i = 0; i < 3; ++i) {
                    for (const ControlPoint& c : piece.points) {
                        // The middle point lies out by 1 / w, and has the weight w: out times weight is 1.
                        Vec3 out = turns[i].vector({c.weighted.x * factor, 0, c.weighted.z * factor});
                        out.y = c.weighted.y * (i == 1 ? w : 1);
                        patch.points.push_back({out, c.weight * (i == 1 ? w : 1)});
                    }
                }
            }
        }
        return result;
    }
    const bool closes = std::abs(std::abs(sweep) - 2 * pi) < 1e-12;
    const auto steps_of = [](double turn) { return static_cast<int>(std::ceil(std::abs(turn) / (pi / 24) - 1e-9)); };
    int count = std::max({1, steps_of(sweep), steps_of(twist)});
    if (count > 100000) return wrong("twist", "is more than can be made");
    if (directrix.size() > 1) {  // steps end at the directrix's own points
        const int own = static_cast<int>(directrix.size()) - (closes ? 0 : 1);
        count = own * std::max(1, (count + own - 1) / own);
    }
    const auto motion_at = [&](int k) {
        const double share = static_cast<double>(k) / count, angle = sweep * share;
        const Factor factor = directrix_at(directrix, closes, share, sweep);
        const Vec3 center{pivot.x, pivot.y, 0};
        const Motion turned = product(moved(center, {}), product(about_z(twist * share, twist / sweep), moved(-center, {})));
        Motion out{Affine::scaling({factor.value, 1, factor.value}), {{factor.slope, 0, 0}, {}, {0, 0, factor.slope}, {}}};
        const Motion risen = moved({0, pitch * angle / (2 * pi), 0}, {0, pitch / (2 * pi), 0});
        return product(risen, product(about_y(start + angle), product(out, turned)));
    };
    const double step = sweep / count;
    Motion before = motion_at(0);
    const bool whole = closes && pitch == 0 && twist == 0;
    for (int k = 0; k < count; ++k) {
        const Motion after = whole && k + 1 == count ? motion_at(0) : motion_at(k + 1);
        const Affine maps[] = {before.at, sum(before.at, scaled(before.slope, step / 3)), sum(after.at, scaled(after.slope, -step / 3)), after.at};
        for (const CurvePiece& piece : *pieces) {
            BezierPatch& patch = result.emplace_back(
                BezierPatch{3, degree_of(piece), piece.rational, start + step * k, start + step * (k + 1), piece.s0, piece.s1, {}});
            for (const Affine& map : maps) {
                for (const ControlPoint& c : piece.points) patch.points.push_back({map.vector(c.weighted) + map.origin * c.weight, c.weight});
            }
        }
        before = after;
    }
    return result;
}

const FieldTable<Revolution>& Revolution::fields() {
    static const FieldTable<Revolution> table{
        field(&Revolution::start, {"start", FieldType::angle, "deg", -unbounded, unbounded, "Where the turn begins, from x towards -z"}),
        field(&Revolution::sweep, {"sweep", FieldType::angle, "deg", -180000, 180000, "How far the profile is turned about y"}),
        field(&Revolution::twist, {"twist", FieldType::angle, "deg", -unbounded, unbounded, "How far the profile turns in its own plane meanwhile"}),
        field(&Revolution::pitch, {"pitch", FieldType::number, "m", -unbounded, unbounded, "How far it rises in a full turn"}),
        field(&Revolution::pivot, {"pivot", FieldType::vector, "m", -unbounded, unbounded, "What it twists about, in its plane"}),
    };
    return table;
}

Expected<std::vector<BezierPatch>> Extrusion::patches() const {
    const auto pieces = pieces_of(profile, "profile");
    if (!pieces) return tl::unexpected(pieces.error());
    if (!is_finite(direction) || !(length(direction) > 0)) return failure(ErrorKind::input, {"", "direction", "has no length", ""});
    std::vector<BezierPatch> result;
    for (const CurvePiece& piece : *pieces) {
        BezierPatch& patch = result.emplace_back(BezierPatch{degree_of(piece), 1, piece.rational, piece.s0, piece.s1, 0, 1, {}});
        for (const ControlPoint& c : piece.points) {
            patch.points.push_back(c);
            patch.points.push_back({c.weighted + direction * c.weight, c.weight});
        }
    }
    return result;
}

const FieldTable<Extrusion>& Extrusion::fields() {
    static const FieldTable<Extrusion> table{
        field(&Extrusion::direction, {"direction", FieldType::vector, "m", -unbounded, unbounded, "How far the profile is moved"}),
    };
    return table;
}

Expected<std::vector<BezierPatch>> Ruled::patches() const {
    auto first = pieces_of(from, "from"), second = pieces_of(to, "to");
    if (!first) return tl::unexpected(first.error());
    if (!second) return tl::unexpected(second.error());
    // Both over [0, 1], cut wherever one of them has an end.
    const auto normalise = [](std::vector<CurvePiece>& pieces, std::vector<double>& ends) {
        const double low = pieces.front().s0, range = pieces.back().s1 - low;
        for (CurvePiece& piece : pieces) {
            piece.s0 = (piece.s0 - low) / range, piece.s1 = (piece.s1 - low) / range;
            ends.push_back(piece.s1);
        }
    };
    std::vector<double> ends;
    normalise(*first, ends), normalise(*second, ends);
    std::sort(ends.begin(), ends.end());
    const auto cut_at = [&](std::vector<CurvePiece>& pieces) {
        constexpr double same = 1e-12;
        std::vector<CurvePiece> result;
        for (CurvePiece& piece : pieces) {
            double last = piece.s0;
            for (const double s : ends) {
                if (s < last + same || s > piece.s1 - same) continue;
                CurvePiece behind = cut_off(piece, s);
                result.push_back(std::move(piece));
                piece = std::move(behind);
                last = s;
            }
            result.push_back(std::move(piece));
        }
        pieces = std::move(result);
    };
    cut_at(*first), cut_at(*second);
    std::vector<BezierPatch> result;
    for (std::size_t k = 0; k < std::min(first->size(), second->size()); ++k) {
        CurvePiece &a = (*first)[k], &b = (*second)[k];
        raise_degree(a, b.points.size() - 1), raise_degree(b, a.points.size() - 1);
        // Lines between points at the same parameter, also where the weights differ: each curve's share of a point is its part of the weights.
        BezierPatch& patch = result.emplace_back(BezierPatch{degree_of(a), 1, a.rational || b.rational, a.s0, a.s1, 0, 1, {}});
        for (std::size_t i = 0; i < a.points.size(); ++i) patch.points.push_back(a.points[i]), patch.points.push_back(b.points[i]);
    }
    return result;
}

const FieldTable<Ruled>& Ruled::fields() {
    static const FieldTable<Ruled> table;
    return table;
}

}  // namespace crescente::geometry
