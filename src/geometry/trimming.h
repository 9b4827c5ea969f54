// Which points of a face's (u, v) belong to it: loops made ready to be asked once for every ray that meets the surface.
//
// A grid of cells answers at once where no loop is near: the cell is inside or outside. In the others the crossings of the loops with the
// half line u > p.u in that row are counted, after Schollmeyer and Froehlich 2009 ("Direct Trimming of NURBS Surfaces on the GPU"): pieces are monotone in u and v,
// so that most are decided by their ends alone. Ends are welded bit by bit, and each belongs to the piece above it: however the curve between two
// ends is rounded, a loop is crossed an even number of times. A point outside that is within an edge's band of it, measured in space, still belongs.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/error.h"
#include "geometry/trim_curve.h"

namespace crescente::geometry {

enum class Place : std::uint8_t { outside, band, inside };  // band: outside by the loops, but within the band of one

class Trimming {
public:
    // How far a step of (du, dv) goes in space at least, anywhere in a box of (u, v): max(result.u |du|, result.v |dv|). Used to say how wide bands are.
    using LeastSteps = std::function<Point2(const ParameterBox&)>;

    // period: of the surface in u and v, 0 where it is not periodic. Loops must close: gaps up to the band are welded, longer ones up to 1e-3 of the
    // loops' box (in space) and those along which the surface does not move are bridged by a line. Errors (input): numbers that are not finite, an arc or Bézier
    // piece without extent in its parameters or weights that are not positive, a loop that stays open.
    static Expected<Trimming> make(const Face& face, Point2 period, const LeastSteps& steps);

    struct Located {
        Place place = Place::outside;
        Point2 at;  // the point moved by periods to where it belongs to the face
        bool near_edge = false;  // it may lie within the band of an edge
    };
    // metric(Point2) -> Metric there, at most `grazing_reach` times shorter than LeastSteps has it; asked for only near loops.
    template <class MetricAt>
    Located locate(Point2 p, const MetricAt& metric) const {
        if (period_.u == 0 && period_.v == 0) return place_of(p, metric);
        return locate_periodic(p, metric);
    }

    // The edges within whose bands p lies, on either side, the nearest first. p as `Located` has it. By `metric` they are near; directions and distances
    // are those of `surface`.
    struct NearEdge {
        Point2 outward;       // a direction in (u, v) orthogonal to the edge, away from the inside; zero if the loops do not tell
        Point2 body;          // from the edge's point next to p to its middle
        double distance = 0;  // by `surface`
        double band = 0;
    };
    static constexpr int most_near_edges = 4;
    int near_edges(Point2 p, const Metric& metric, const Metric& surface, NearEdge* edges) const;
    // Whether there is one.
    bool near_edge(Point2 p, const Metric& metric) const;

    const ParameterBox& box() const { return box_; }      // of the loops
    const ParameterBox& reach() const { return reach_; }  // of the loops with their bands
    double widest_band() const { return widest_band_; }
    // Whether every point of the box lies outside, bands included. (False if that is not plain from the cells.)
    bool all_outside(const ParameterBox& box) const;

    // The loops as they were given, but for welds and bridges; bands rounded up to float.
    std::vector<Loop> loops() const;
    // Calls visit(piece, curve or null) for every monotone piece.
    template <class Visit>
    void for_each_piece(Visit&& visit) const {
        for (const MonotonePiece& piece : pieces_) visit(piece, curve_of(piece));
    }

    // Memory in bytes, this object included.
    std::size_t bytes() const;

private:
    enum class Cell : std::uint8_t { outside, inside, boundary };

    Expected<void> add_loop(const Loop& loop, std::size_t number, const LeastSteps& steps);
    void make_grid(const LeastSteps& steps);
    void classify(const LeastSteps& steps);

    int column_of(double u) const { return static_cast<int>(std::clamp((u - inner_u_) * cells_per_u_ + 1, 0.0, columns_ - 1.0)); }
    int row_of(double v) const { return static_cast<int>(std::clamp((v - inner_v_) * cells_per_v_ + 1, 0.0, rows_ - 1.0)); }
    Cell cell(int column, int row) const {
        const std::size_t i = std::size_t(row) * columns_ + column;
        return static_cast<Cell>(cells_[i >> 2] >> (2 * (i & 3)) & 3);
    }
    void set_cell(int column, int row, Cell state) {
        const std::size_t i = std::size_t(row) * columns_ + column;
        std::uint8_t& four = cells_[i >> 2];
        four = static_cast<std::uint8_t>((four & ~(3u << (2 * (i & 3)))) | (unsigned(state) << (2 * (i & 3))));
    }

    template <class MetricAt>
    Located place_of(Point2 p, const MetricAt& metric) const {
        if (!(p.u >= reach_.u0 && p.u <= reach_.u1 && p.v >= reach_.v0 && p.v <= reach_.v1)) return {Place::outside, p};
        const int row = row_of(p.v);
        switch (cell(column_of(p.u), row)) {
            case Cell::outside: return {Place::outside, p};
            case Cell::inside: return {Place::inside, p};
            default: break;
        }
        if (encloses(p, row)) return {Place::inside, p, true};
        const bool in_band = near_edge(p, metric(p));
        return {in_band ? Place::band : Place::outside, p, in_band};
    }
    // A surface may come back to the same place several periods on, and near its seam on both sides of the loops.
    template <class MetricAt>
    Located locate_periodic(Point2 p, const MetricAt& metric) const {
        const auto first = [](double x, double period, double least) { return period > 0 ? x + period * std::ceil((least - x) / period) : x; };
        Located best{Place::outside, p};
        if (!std::isfinite(p.u) || !std::isfinite(p.v)) return best;
        for (double v = first(p.v, period_.v, reach_.v0); v <= reach_.v1; v += period_.v) {
            for (double u = first(p.u, period_.u, reach_.u0); u <= reach_.u1; u += period_.u) {
                const Located located = place_of({u, v}, metric);
                if (located.place > best.place) best = located;
                if (located.place == Place::inside) return best;
                if (period_.u == 0) break;
            }
            if (period_.v == 0) break;
        }
        return best;
    }
    bool encloses(Point2 p, int row) const;
    // Calls visit(piece, nearest point of it) for each piece within whose band p lies, until it returns true.
    template <class Visit>
    bool any_near(Point2 p, const Metric& metric, Visit&& visit) const;
    Point2 outward_of(const MonotonePiece& piece, Point2 along, const Metric& metric) const;
    bool runs_right_of(const MonotonePiece& piece, Point2 p) const;

    const CurveStretch* stretch_of(const MonotonePiece& piece) const { return piece.is_line() ? nullptr : &stretches_[piece.stretch]; }
    const LoopPiece* curve_of(const MonotonePiece& piece) const { return piece.is_line() ? nullptr : &curves_[stretches_[piece.stretch].curve]; }

    ParameterBox box_, reach_;
    Point2 period_;
    double inner_u_ = 0, inner_v_ = 0, cells_per_u_ = 0, cells_per_v_ = 0;  // of the cells but for those on the border, which reach out as far as needed
    int columns_ = 0, rows_ = 0;
    float widest_band_ = 0;
    std::vector<MonotonePiece> pieces_;  // loop by loop
    std::vector<CurveStretch> stretches_;
    std::vector<LoopPiece> curves_;          // arcs and Bézier pieces
    std::vector<std::uint32_t> loop_ends_;   // one past the last piece of each loop
    std::vector<std::uint8_t> cells_;        // two bits each, row by row
    std::vector<std::uint32_t> row_begins_;  // into row_pieces_
    std::vector<std::uint32_t> row_pieces_;  // pieces that come near each row
};

}  // namespace crescente::geometry
