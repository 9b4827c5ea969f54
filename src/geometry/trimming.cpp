#include "geometry/trimming.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace crescente::geometry {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool finite(Point2 p) { return std::isfinite(p.u) && std::isfinite(p.v); }

float rounded_up(double x) {
    const float f = static_cast<float>(x);
    return f < x ? std::nextafterf(f, HUGE_VALF) : f;
}

// What is wrong with a piece; empty if nothing.
std::string fault(const LoopEdge& edge) {
    if (!(edge.band >= 0 && edge.band < 1e30)) return "a band that is no length";
    if (const auto* line = std::get_if<LinePiece>(&edge.piece)) return finite(line->from) && finite(line->to) ? "" : "a line with coordinates that are not finite";
    if (const auto* arc = std::get_if<ArcPiece>(&edge.piece)) {
        if (!finite(arc->center) || !finite(arc->x) || !finite(arc->y) || !std::isfinite(arc->a0) || !std::isfinite(arc->a1)) return "an arc with numbers that are not finite";
        const double turn = std::abs(arc->a1 - arc->a0);
        return turn > 0 && turn < 2 * pi * (1 + 1e-9) && std::abs(arc->a0) < 1e6 ? "" : "an arc of no extent or of more than a turn";
    }
    const auto& points = std::get<BezierPiece>(edge.piece).points;
    if (points.size() < 2 || points.size() > 64) return "a Bézier piece of degree " + std::to_string(static_cast<int>(points.size()) - 1);
    for (const auto& p : points) {
        if (!std::isfinite(p.u) || !std::isfinite(p.v) || !(p.weight > 0 && p.weight < 1e100)) return "a Bézier piece with numbers that are not finite or a weight that is not positive";
    }
    return "";
}

// Of a band in space, how far it reaches in one parameter.
double margin(double band, double step) { return band == 0 ? 0 : grazing_reach * band / step; }

double distance(Point2 a, Point2 b, Point2 steps) { return std::max(steps.u * std::abs(a.u - b.u), steps.v * std::abs(a.v - b.v)); }

}  // namespace

Expected<Trimming> Trimming::make(const Face& face, Point2 period, const LeastSteps& steps) {
    Trimming t;
    t.period_ = period;
    if (face.loops.empty()) {
        const Point2 a{face.u0, face.v0}, b{face.u1, face.v0}, c{face.u1, face.v1}, d{face.u0, face.v1};
        if (!(face.u0 < face.u1 && face.v0 < face.v1) || !finite(a) || !finite(c)) return failure(ErrorKind::input, {"", "", "a range of parameters without extent", ""});
        const Loop whole{{LinePiece{a, b}, 0}, {LinePiece{b, c}, 0}, {LinePiece{c, d}, 0}, {LinePiece{d, a}, 0}};
        if (auto added = t.add_loop(whole, 0, steps); !added) return tl::unexpected(added.error());
    }
    Error error{ErrorKind::input, {}};
    for (std::size_t i = 0; i < face.loops.size(); ++i) {
        if (auto added = t.add_loop(face.loops[i], i, steps); !added) {
            error.problems.insert(error.problems.end(), added.error().problems.begin(), added.error().problems.end());
        }
    }
    if (!error.problems.empty()) return tl::unexpected(std::move(error));
    if (t.pieces_.empty()) return failure(ErrorKind::input, {"", "", "loops without extent", ""});
    t.box_ = {infinity, -infinity, infinity, -infinity};
    for (const MonotonePiece& piece : t.pieces_) {
        for (const Point2 p : {piece.from, piece.to}) {
            t.box_ = {std::min(t.box_.u0, p.u), std::max(t.box_.u1, p.u), std::min(t.box_.v0, p.v), std::max(t.box_.v1, p.v)};
        }
    }
    if (!(t.box_.u0 < t.box_.u1 && t.box_.v0 < t.box_.v1)) return failure(ErrorKind::input, {"", "", "loops that enclose no area", ""});
    if (period.u > 0 && t.box_.u1 - t.box_.u0 > 64 * period.u) return failure(ErrorKind::input, {"", "", "loops that wind about the surface more than 64 times", ""});
    if (period.v > 0 && t.box_.v1 - t.box_.v0 > 64 * period.v) return failure(ErrorKind::input, {"", "", "loops that wind about the surface more than 64 times", ""});
    t.make_grid(steps);
    t.classify(steps);
    for (auto* list : {&t.loop_ends_, &t.row_begins_, &t.row_pieces_}) list->shrink_to_fit();
    t.pieces_.shrink_to_fit(), t.stretches_.shrink_to_fit(), t.curves_.shrink_to_fit();
    return t;
}

Expected<void> Trimming::add_loop(const Loop& loop, std::size_t number, const LeastSteps& steps) {
    const std::string place = "loop " + std::to_string(number);
    if (loop.empty()) return {};
    std::size_t edges = 0;
    for (const LoopEdge& edge : loop) {
        if (const std::string wrong = fault(edge); !wrong.empty()) return failure(ErrorKind::input, {"", place + ", edge " + std::to_string(edges), wrong, ""});
        ++edges;
    }
    ParameterBox box{infinity, -infinity, infinity, -infinity};
    const auto include = [&](Point2 p) { box = {std::min(box.u0, p.u), std::max(box.u1, p.u), std::min(box.v0, p.v), std::max(box.v1, p.v)}; };
    std::vector<std::vector<double>> stops(loop.size());  // of curves
    for (std::size_t i = 0; i < loop.size(); ++i) {
        include(first_point(loop[i].piece)), include(last_point(loop[i].piece));
        if (std::holds_alternative<LinePiece>(loop[i].piece)) continue;
        stops[i] = monotone_stops(loop[i].piece);
        for (const double t : stops[i]) include(evaluate(loop[i].piece, t).at);
    }
    const Point2 overall = steps(box);
    const double size = std::max(overall.u * (box.u1 - box.u0), overall.v * (box.v1 - box.v0));

    struct Joint {  // between an edge and the one after it
        Point2 end, start;
        bool bridged = false;
    };
    std::vector<Joint> joints(loop.size());
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const LoopEdge &edge = loop[i], &next = loop[(i + 1) % loop.size()];
        Joint& joint = joints[i];
        joint.end = last_point(edge.piece), joint.start = first_point(next.piece);
        if (joint.end == joint.start) continue;
        const Point2 local = steps({std::min(joint.end.u, joint.start.u), std::max(joint.end.u, joint.start.u), std::min(joint.end.v, joint.start.v), std::max(joint.end.v, joint.start.v)});
        const double gap = distance(joint.end, joint.start, local), band = std::max(edge.band, next.band);
        const bool slight = std::abs(joint.end.u - joint.start.u) <= 1e-3 * (box.u1 - box.u0) && std::abs(joint.end.v - joint.start.v) <= 1e-3 * (box.v1 - box.v0);
        if (gap > std::max(band, 1e-3 * size)) {
            return failure(ErrorKind::input, {"", place + ", edge " + std::to_string(i), "does not end where the next one begins", ""});
        }
        if (slight) {
            // A curve keeps its own end; of two lines the first.
            const bool curved_next = !std::holds_alternative<LinePiece>(next.piece) && std::holds_alternative<LinePiece>(edge.piece);
            (curved_next ? joint.end : joint.start) = curved_next ? joint.start : joint.end;
        } else {
            joint.bridged = true;
        }
    }
    for (std::size_t i = 0; i < loop.size(); ++i) {
        const LoopEdge& edge = loop[i];
        const float band = rounded_up(edge.band);
        widest_band_ = std::max(widest_band_, band);
        const Point2 from = joints[(i + loop.size() - 1) % loop.size()].start, to = joints[i].end;
        if (std::holds_alternative<LinePiece>(edge.piece)) {
            if (from != to) pieces_.push_back({from, to, band, MonotonePiece::no_curve});
        } else {
            const auto curve = static_cast<std::uint32_t>(curves_.size());
            curves_.push_back(edge.piece);
            Point2 before = from;
            for (std::size_t k = 1; k < stops[i].size(); ++k) {
                const Point2 after = k + 1 == stops[i].size() ? to : evaluate(edge.piece, stops[i][k]).at;
                pieces_.push_back({before, after, band, static_cast<std::uint32_t>(stretches_.size())});
                stretches_.push_back({stops[i][k - 1], stops[i][k], curve});
                before = after;
            }
        }
        if (joints[i].bridged) pieces_.push_back({joints[i].end, joints[i].start, rounded_up(std::max(edge.band, loop[(i + 1) % loop.size()].band)), MonotonePiece::no_curve});
    }
    loop_ends_.push_back(static_cast<std::uint32_t>(pieces_.size()));
    return {};
}

void Trimming::make_grid(const LeastSteps& steps) {
    const double width = box_.u1 - box_.u0, height = box_.v1 - box_.v0;
    // A rectangle along u and v needs no cell but the one inside it.
    const bool rectangle = pieces_.size() <= 4 && std::all_of(pieces_.begin(), pieces_.end(), [](const MonotonePiece& p) {
        return p.is_line() && (p.from.u == p.to.u || p.from.v == p.to.v);
    });
    const Point2 step = steps(box_);
    double aspect = step.u * width / (step.v * height);
    if (!(aspect > 0.25)) aspect = 0.25;
    if (aspect > 4) aspect = 4;
    const double cells = rectangle ? 1 : std::clamp(16.0 * static_cast<double>(pieces_.size()), 48.0, 16384.0);
    // Rows take more memory than columns, by their lists of pieces.
    const int nu = std::max(1, static_cast<int>(std::sqrt(2 * cells * aspect))), nv = std::max(1, static_cast<int>(std::sqrt(0.5 * cells / aspect)));
    columns_ = nu + 2, rows_ = nv + 2;

    // The border cells begin where the bands of edges along the border end, if these are narrow.
    double mu = margin(widest_band_, step.u), mv = margin(widest_band_, step.v);
    mu += 1e-12 * (std::abs(box_.u0) + std::abs(box_.u1)), mv += 1e-12 * (std::abs(box_.v0) + std::abs(box_.v1));
    const double inset_u = mu < 0.1 * width ? mu : 0, inset_v = mv < 0.1 * height ? mv : 0;
    inner_u_ = box_.u0 + inset_u, inner_v_ = box_.v0 + inset_v;
    cells_per_u_ = nu / (width - 2 * inset_u), cells_per_v_ = nv / (height - 2 * inset_v);
    if (!(mu < 4 * width)) mu = 4 * width;  // where the surface shrinks to a point, u means nothing
    if (!(mv < 4 * height)) mv = 4 * height;
    reach_ = {box_.u0 - mu, box_.u1 + mu, box_.v0 - mv, box_.v1 + mv};
    if (period_.u > 0) reach_.u0 = std::max(reach_.u0, box_.u0 - period_.u), reach_.u1 = std::min(reach_.u1, box_.u1 + period_.u);
    if (period_.v > 0) reach_.v0 = std::max(reach_.v0, box_.v0 - period_.v), reach_.v1 = std::min(reach_.v1, box_.v1 + period_.v);
}

void Trimming::classify(const LeastSteps& steps) {
    const double tiny_u = 1e-12 * (std::abs(box_.u0) + std::abs(box_.u1)), tiny_v = 1e-12 * (std::abs(box_.v0) + std::abs(box_.v1));
    cells_.assign((std::size_t(columns_) * rows_ + 3) / 4, 0);
    row_begins_ = {0};
    for (int row = 0; row < rows_; ++row) {
        const double low = row == 0 ? reach_.v0 : inner_v_ + (row - 1) / cells_per_v_ - tiny_v;
        const double high = row + 1 == rows_ ? reach_.v1 : inner_v_ + row / cells_per_v_ + tiny_v;
        const Point2 step = steps({box_.u0, box_.u1, std::clamp(low, box_.v0, box_.v1), std::clamp(high, box_.v0, box_.v1)});
        for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
            const MonotonePiece& piece = pieces_[i];
            const double bu = margin(piece.band, step.u) + tiny_u, bv = margin(piece.band, step.v) + tiny_v;
            const auto [least, most] = std::minmax(piece.from.v, piece.to.v);
            if (least - bv > high || most + bv < low) continue;
            row_pieces_.push_back(i);
            // The part of the piece that is near the row, and how far it goes along it.
            double u0 = piece.from.u, u1 = piece.to.u;
            if (least < most) {
                const CurveStretch* stretch = stretch_of(piece);
                u0 = u_at(piece, stretch, curve_of(piece), std::max(least, low - bv)), u1 = u_at(piece, stretch, curve_of(piece), std::min(most, high + bv));
            }
            const int last = column_of(std::max(u0, u1) + bu);
            for (int column = column_of(std::min(u0, u1) - bu); column <= last; ++column) set_cell(column, row, Cell::boundary);
        }
        row_begins_.push_back(static_cast<std::uint32_t>(row_pieces_.size()));

        // No loop runs through cells in a row that are not of the boundary: what holds for one point of them holds for all. Several are asked, and if loops that
        // cross themselves make them disagree, every ray is asked anew.
        const auto left = [&](int column) { return column == 0 ? reach_.u0 : inner_u_ + (column - 1) / cells_per_u_; };
        const auto right = [&](int column) { return column + 1 == columns_ ? reach_.u1 : inner_u_ + column / cells_per_u_; };
        for (int column = 0; column < columns_; ++column) {
            if (cell(column, row) == Cell::boundary) continue;
            int end = column;
            while (end < columns_ && cell(end, row) != Cell::boundary) ++end;
            int inside = 0;
            for (const double share : {0.381966, 0.723607}) {
                const double v = low + share * (high - low);
                inside += encloses({left(column) + share * (right(column) - left(column)), v}, row);
                inside += encloses({left(end - 1) + share * (right(end - 1) - left(end - 1)), v}, row);
            }
            const Cell state = inside == 4 ? Cell::inside : inside == 0 ? Cell::outside : Cell::boundary;
            for (; column < end; ++column) set_cell(column, row, state);
        }
    }
}

// Whether the piece, which has p.v between its ends, has a greater u there.
bool Trimming::runs_right_of(const MonotonePiece& piece, Point2 p) const {
    const auto [least, most] = std::minmax(piece.from.u, piece.to.u);
    if (p.u < least) return true;
    if (p.u >= most) return false;
    if (piece.is_line()) {
        const double across = (piece.to.u - piece.from.u) * (p.v - piece.from.v), along = (p.u - piece.from.u) * (piece.to.v - piece.from.v);
        return piece.to.v > piece.from.v ? across > along : across < along;
    }
    if (const auto* arc = std::get_if<ArcPiece>(curve_of(piece))) {
        // Of the two points of the ellipse in this row the stretch has the right one if it runs right of the middles of the chords along u.
        const Point2 d{p.u - arc->center.u, p.v - arc->center.v};
        const double area = arc->x.u * arc->y.v - arc->x.v * arc->y.u;
        const double a = d.u * arc->y.v - d.v * arc->y.u, b = arc->x.u * d.v - arc->x.v * d.u;
        const double lean = (arc->x.u * arc->x.v + arc->y.u * arc->y.v) / (arc->x.v * arc->x.v + arc->y.v * arc->y.v);
        if (area != 0 && std::isfinite(lean)) {
            const bool inside = a * a + b * b < area * area, left_half = d.u < lean * d.v;
            const double side = piece.from.u + piece.to.u - 2 * arc->center.u - lean * (piece.from.v + piece.to.v - 2 * arc->center.v);
            return side > 0 ? inside || left_half : !inside && left_half;
        }
    }
    return u_at(piece, stretch_of(piece), curve_of(piece), p.v) > p.u;
}

bool Trimming::encloses(Point2 p, int row) const {
    bool inside = false;
    for (std::uint32_t k = row_begins_[row]; k < row_begins_[row + 1]; ++k) {
        const MonotonePiece& piece = pieces_[row_pieces_[k]];
        if ((piece.from.v > p.v) != (piece.to.v > p.v) && runs_right_of(piece, p)) inside = !inside;
    }
    return inside;
}

template <class Visit>
bool Trimming::any_near(Point2 p, const Metric& metric, Visit&& visit) const {
    const int row = row_of(p.v);
    // Steps of u alone, or v alone, go at least so far from any line along the other one.
    const double determinant = metric.uu * metric.vv - metric.uv * metric.uv;
    const double step_u2 = metric.vv > 0 ? determinant / metric.vv : 0, step_v2 = metric.uu > 0 ? determinant / metric.uu : 0;
    for (std::uint32_t k = row_begins_[row]; k < row_begins_[row + 1]; ++k) {
        const MonotonePiece& piece = pieces_[row_pieces_[k]];
        const double band2 = double(piece.band) * piece.band;
        const auto [u0, u1] = std::minmax(piece.from.u, piece.to.u);
        const auto [v0, v1] = std::minmax(piece.from.v, piece.to.v);
        const double du = std::max({u0 - p.u, p.u - u1, 0.0}), dv = std::max({v0 - p.v, p.v - v1, 0.0});
        if (du * du * step_u2 > band2 || dv * dv * step_v2 > band2) continue;
        if (const auto* arc = piece.is_line() ? nullptr : std::get_if<ArcPiece>(curve_of(piece)); arc && arc->x.u == arc->y.v && arc->x.v == -arc->y.u) {
            // Far from a circle, told without a search.
            const double off = std::hypot(p.u - arc->center.u, p.v - arc->center.v) - std::hypot(arc->x.u, arc->x.v);
            if (off * off * std::min(step_u2, step_v2) * 0.5 > band2) continue;
        }
        const NearestPoint near = nearest_point(piece, stretch_of(piece), curve_of(piece), p, metric);
        if (near.distance2 <= band2 && visit(piece, near)) return true;
    }
    return false;
}

bool Trimming::near_edge(Point2 p, const Metric& metric) const {
    return any_near(p, metric, [](const MonotonePiece&, const NearestPoint&) { return true; });
}

int Trimming::near_edges(Point2 p, const Metric& metric, const Metric& surface, NearEdge* edges) const {
    int count = 0;
    any_near(p, metric, [&](const MonotonePiece& piece, const NearestPoint& near) {
        const Point2 middle = middle_of(piece, stretch_of(piece), curve_of(piece)).at;
        const Point2 off{p.u - near.at.u, p.v - near.at.v};
        const double distance = std::sqrt(surface.uu * off.u * off.u + 2 * surface.uv * off.u * off.v + surface.vv * off.v * off.v);
        NearEdge edge{outward_of(piece, near.along, surface), {middle.u - near.at.u, middle.v - near.at.v}, distance, piece.band};
        for (int i = 0; i < count; ++i) {
            if (edge.distance < edges[i].distance) std::swap(edge, edges[i]);
        }
        if (count < most_near_edges) edges[count++] = edge;
        return false;
    });
    return count;
}

Point2 Trimming::outward_of(const MonotonePiece& piece, Point2 along, const Metric& metric) const {
    // Which side of the piece is inside, asked beside its middle.
    const CurvePoint middle = middle_of(piece, stretch_of(piece), curve_of(piece));
    const double length = std::hypot(middle.slope.u, middle.slope.v), step = 1e-7 * std::min(box_.u1 - box_.u0, box_.v1 - box_.v0) / length;
    const Point2 left{middle.at.u - step * middle.slope.v, middle.at.v + step * middle.slope.u}, right{middle.at.u + step * middle.slope.v, middle.at.v - step * middle.slope.u};
    const bool left_inside = encloses(left, row_of(left.v)), right_inside = encloses(right, row_of(right.v));
    if (left_inside == right_inside) return {0, 0};
    const Point2 across{-(metric.uv * along.u + metric.vv * along.v), metric.uu * along.u + metric.uv * along.v};  // to the left
    return left_inside ? Point2{-across.u, -across.v} : across;
}

bool Trimming::all_outside(const ParameterBox& box) const {
    if (box.u1 < reach_.u0 || box.u0 > reach_.u1 || box.v1 < reach_.v0 || box.v0 > reach_.v1) return true;
    const int last_row = row_of(box.v1), first_column = column_of(box.u0), last_column = column_of(box.u1);
    for (int row = row_of(box.v0); row <= last_row; ++row) {
        for (int column = first_column; column <= last_column; ++column) {
            if (cell(column, row) != Cell::outside) return false;
        }
    }
    return true;
}

std::vector<Loop> Trimming::loops() const {
    std::vector<Loop> loops;
    std::uint32_t i = 0;
    for (const std::uint32_t end : loop_ends_) {
        Loop& loop = loops.emplace_back();
        std::uint32_t last_curve = MonotonePiece::no_curve;
        for (; i < end; ++i) {
            const MonotonePiece& piece = pieces_[i];
            const std::uint32_t curve = piece.is_line() ? MonotonePiece::no_curve : stretches_[piece.stretch].curve;
            if (piece.is_line()) {
                loop.push_back({LinePiece{piece.from, piece.to}, piece.band});
            } else if (curve != last_curve) {
                loop.push_back({curves_[curve], piece.band});
            }
            last_curve = curve;
        }
    }
    return loops;
}

std::size_t Trimming::bytes() const {
    std::size_t total = sizeof *this + pieces_.capacity() * sizeof(MonotonePiece) + stretches_.capacity() * sizeof(CurveStretch) +
                        curves_.capacity() * sizeof(LoopPiece) + cells_.capacity() +
                        sizeof(std::uint32_t) * (loop_ends_.capacity() + row_begins_.capacity() + row_pieces_.capacity());
    for (const LoopPiece& curve : curves_) {
        if (const auto* bezier = std::get_if<BezierPiece>(&curve)) total += bezier->points.capacity() * sizeof(BezierPiece::Control);
    }
    return total;
}

}  // namespace crescente::geometry
