#include "io/occt/thinning.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace crescente::io::occt {
namespace {

using namespace geometry;

constexpr std::size_t few = 8;            // pieces that are not worth the trouble
constexpr std::size_t samples_a_piece = 4;
constexpr std::size_t longest_run = 256;  // pieces

// In the scaled parameters.
struct Cubic {
    Point2 p[4];

    Point2 at(double s) const {
        const double r = 1 - s, b0 = r * r * r, b1 = 3 * r * r * s, b2 = 3 * r * s * s, b3 = s * s * s;
        return {b0 * p[0].u + b1 * p[1].u + b2 * p[2].u + b3 * p[3].u, b0 * p[0].v + b1 * p[1].v + b2 * p[2].v + b3 * p[3].v};
    }
    Point2 derivative(double s) const {
        const double r = 1 - s;
        const auto one = [&](double a, double b, double c, double d) { return 3 * (r * r * (b - a) + 2 * r * s * (c - b) + s * s * (d - c)); };
        return {one(p[0].u, p[1].u, p[2].u, p[3].u), one(p[0].v, p[1].v, p[2].v, p[3].v)};
    }
};

Point2 minus(Point2 a, Point2 b) { return {a.u - b.u, a.v - b.v}; }
double dot(Point2 a, Point2 b) { return a.u * b.u + a.v * b.v; }
double length(Point2 a) { return std::hypot(a.u, a.v); }

class Thinner {
public:
    Thinner(const std::vector<LoopPiece>& pieces, double scale_u, double scale_v, double tolerance)
        : pieces_(pieces), scale_{scale_u, scale_v}, tolerance_(tolerance) {
        for (const LoopPiece& piece : pieces) {
            for (std::size_t k = 0; k < samples_a_piece; ++k) samples_.push_back(scaled(point_on(piece, static_cast<double>(k) / samples_a_piece)));
        }
        samples_.push_back(scaled(point_on(pieces.back(), 1)));
    }

    std::vector<LoopPiece> thin() {
        std::vector<LoopPiece> result;
        for (std::size_t from = 0; from < pieces_.size();) {
            // Longer and longer while it fits, then the longest between the last that did and the first that did not.
            const std::size_t most = std::min(longest_run, pieces_.size() - from);
            std::size_t good = 1, bad = most + 1;
            std::optional<LoopPiece> best;
            const auto attempt = [&](std::size_t run) {
                auto piece = one_piece(from, from + run);
                if (piece) good = run, best = std::move(piece);
                else bad = run;
            };
            for (std::size_t run = 2; run <= most && bad > most; run *= 2) attempt(run);
            while (bad - good > 1) attempt(good + (bad - good) / 2);
            result.push_back(best ? std::move(*best) : pieces_[from]);
            from += good;
        }
        return result;
    }

private:
    Point2 scaled(Point2 p) const { return {p.u * scale_.u, p.v * scale_.v}; }

    // The pieces from `first` up to `last` as a line or a cubic, if that is within the tolerance.
    std::optional<LoopPiece> one_piece(std::size_t first, std::size_t last) const {
        const std::size_t begin = first * samples_a_piece, end = last * samples_a_piece;
        const Point2 from = point_on(pieces_[first], 0), to = point_on(pieces_[last - 1], 1);
        if (straight(begin, end)) return LinePiece{from, to};
        const auto cubic = fit(begin, end);
        if (!cubic) return std::nullopt;
        const auto control = [&](Point2 p) { return BezierPiece::Control{p.u / scale_.u, p.v / scale_.v, 1}; };
        return BezierPiece{{{from.u, from.v, 1}, control(cubic->p[1]), control(cubic->p[2]), {to.u, to.v, 1}}};
    }

    bool straight(std::size_t begin, std::size_t end) const {
        const Point2 chord = minus(samples_[end], samples_[begin]);
        const double size = length(chord);
        double along = 0;
        for (std::size_t i = begin; i <= end; ++i) {
            const Point2 d = minus(samples_[i], samples_[begin]);
            const double s = size > 0 ? dot(d, chord) / size : 0, off = size > 0 ? std::abs(d.u * chord.v - d.v * chord.u) / size : length(d);
            if (off > tolerance_ || s < along - tolerance_) return false;
            along = s;
        }
        return true;
    }

    // End points and end directions as given, the two lengths of the tangents by least squares over the samples at their share of the way.
    std::optional<Cubic> fit(std::size_t begin, std::size_t end) const {
        std::vector<double> way{0};
        for (std::size_t i = begin + 1; i <= end; ++i) way.push_back(way.back() + length(minus(samples_[i], samples_[i - 1])));
        const double all = way.back();
        const Point2 d0 = minus(samples_[begin + 1], samples_[begin]), d1 = minus(samples_[end - 1], samples_[end]);
        if (!(all > 0) || length(d0) == 0 || length(d1) == 0) return std::nullopt;
        // Directions from three samples at each end, to second order.
        const Point2 t0 = tangent(begin, 1), t1 = tangent(end, -1);
        Cubic cubic{{samples_[begin], {}, {}, samples_[end]}};
        double a00 = 0, a01 = 0, a11 = 0, b0 = 0, b1 = 0;
        for (std::size_t i = 1; i + 1 < way.size(); ++i) {
            const double s = way[i] / all, r = 1 - s, w1 = 3 * r * r * s, w2 = 3 * r * s * s, w0 = r * r * r + w1, w3 = s * s * s + w2;
            const Point2 rest = {samples_[begin + i].u - w0 * cubic.p[0].u - w3 * cubic.p[3].u, samples_[begin + i].v - w0 * cubic.p[0].v - w3 * cubic.p[3].v};
            a00 += w1 * w1 * dot(t0, t0), a01 += w1 * w2 * dot(t0, t1), a11 += w2 * w2 * dot(t1, t1);
            b0 += w1 * dot(t0, rest), b1 += w2 * dot(t1, rest);
        }
        const double determinant = a00 * a11 - a01 * a01;
        if (!(determinant > 1e-12 * a00 * a11)) return std::nullopt;
        const double l0 = (b0 * a11 - b1 * a01) / determinant, l1 = (b1 * a00 - b0 * a01) / determinant;
        if (!(l0 > 0) || !(l1 > 0) || l0 > 2 * all || l1 > 2 * all) return std::nullopt;
        cubic.p[1] = {cubic.p[0].u + l0 * t0.u, cubic.p[0].v + l0 * t0.v};
        cubic.p[2] = {cubic.p[3].u + l1 * t1.u, cubic.p[3].v + l1 * t1.v};
        for (std::size_t i = 1; i + 1 < way.size(); ++i) {
            double s = way[i] / all;
            for (int step = 0; step < 2; ++step) {  // Newton to the nearest point
                const Point2 d = cubic.derivative(s);
                const double square = dot(d, d);
                if (square > 0) s = std::clamp(s - dot(minus(cubic.at(s), samples_[begin + i]), d) / square, 0.0, 1.0);
            }
            if (!(length(minus(cubic.at(s), samples_[begin + i])) <= tolerance_)) return std::nullopt;
        }
        return cubic;
    }

    Point2 tangent(std::size_t at, int step) const {
        const auto sample = [&](int k) { return samples_[static_cast<std::size_t>(static_cast<std::ptrdiff_t>(at) + k * step)]; };
        const Point2 a = sample(0), b = sample(1), c = sample(2);
        const double ab = length(minus(b, a)), ac = ab + length(minus(c, b));
        Point2 t = ac > ab ? Point2{(b.u - a.u) / ab * ac - (c.u - a.u) / ac * ab, (b.v - a.v) / ab * ac - (c.v - a.v) / ac * ab} : minus(b, a);
        if (length(t) == 0) t = minus(b, a);
        const double size = length(t);
        return {t.u / size, t.v / size};
    }

    const std::vector<LoopPiece>& pieces_;
    Point2 scale_;
    double tolerance_;
    std::vector<Point2> samples_;
};

}  // namespace

std::vector<LoopPiece> thinned(const std::vector<LoopPiece>& pieces, double scale_u, double scale_v, double tolerance) {
    if (pieces.size() <= few || !(scale_u > 0) || !(scale_v > 0)) return pieces;
    return Thinner(pieces, scale_u, scale_v, tolerance).thin();
}

}  // namespace crescente::io::occt
