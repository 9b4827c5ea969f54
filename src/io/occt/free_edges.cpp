#include "io/occt/free_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace crescente::io::occt {
namespace {

using math::Vec3;
using namespace math;

double segment_distance(Vec3 p, Vec3 a, Vec3 b) {
    const Vec3 ab = b - a;
    const double square = dot(ab, ab), s = square > 0 ? std::clamp(dot(p - a, ab) / square, 0.0, 1.0) : 0;
    return length(p - (a + ab * s));
}

double polyline_distance(Vec3 p, const EdgePoints& line) {
    double least = length(p - line[0]);
    for (std::size_t i = 1; i < line.size(); ++i) least = std::min(least, segment_distance(p, line[i - 1], line[i]));
    return least;
}

// How far a polyline of the curve strays from it: an eighth of the second difference, as for a parabola.
double sag(const EdgePoints& line) {
    double most = 0;
    for (std::size_t i = 2; i < line.size(); ++i) most = std::max(most, length(line[i] - line[i - 1] * 2 + line[i - 2]) / 8);
    return most;
}

using Cell = std::array<std::int64_t, 3>;

Cell cell_of(Vec3 p, double size) {
    const auto index = [&](double x) { return static_cast<std::int64_t>(std::floor(x / size)); };
    return {index(p.x), index(p.y), index(p.z)};
}

}  // namespace

double distance_between(const EdgePoints& a, const EdgePoints& b, double enough) {
    double same_pace = 0, apart = 0;
    for (std::size_t i = 0; i < a.size(); ++i) same_pace = std::max(same_pace, length(a[i] - b[i]));
    if (same_pace <= enough) return same_pace;
    for (const Vec3 p : a) apart = std::max(apart, polyline_distance(p, b) + sag(b));
    for (const Vec3 p : b) apart = std::max(apart, polyline_distance(p, a) + sag(a));
    return std::min(same_pace, apart);
}

std::vector<FreeEdgeGap> gaps_between(const std::vector<FreeEdge>& edges, double diagonal) {
    constexpr double near = 1e-4;  // of the diagonal
    double reach = near * diagonal;
    // By the cells that the segments' ends are in: every edge lists itself in the cells of its points.
    std::map<Cell, std::vector<std::size_t>> ends;
    const double size = reach * 2;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        for (const Vec3 p : {edges[e].points.front(), edges[e].points.back()}) ends[cell_of(p, size)].push_back(e);
    }
    const auto around = [&](Vec3 p, auto&& visit) {
        const Cell at = cell_of(p, size);
        for (std::int64_t x = -1; x <= 1; ++x) {
            for (std::int64_t y = -1; y <= 1; ++y) {
                for (std::int64_t z = -1; z <= 1; ++z) {
                    const auto found = ends.find({at[0] + x, at[1] + y, at[2] + z});
                    if (found == ends.end()) continue;
                    for (const std::size_t e : found->second) visit(e);
                }
            }
        }
    };
    std::vector<FreeEdgeGap> gaps;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const FreeEdge& one = edges[e];
        FreeEdgeGap result{e, false, e, 0};
        double best = reach;
        around(one.points.front(), [&](std::size_t other) {
            if (other == e) return;
            EdgePoints points = edges[other].points;
            if (length(points.front() - one.points.front()) > length(points.back() - one.points.front())) std::reverse(points.begin(), points.end());
            const double allowed = std::max(reach, 3 * (one.tolerance + edges[other].tolerance));
            if (length(points.front() - one.points.front()) > allowed || length(points.back() - one.points.back()) > allowed) return;
            const double gap = distance_between(one.points, points);
            if (gap > allowed || (result.matched && gap >= best)) return;
            result.matched = true, result.other = other, best = gap;
        });
        result.gap = result.matched ? best : 0;
        gaps.push_back(result);
    }
    return gaps;
}

}  // namespace crescente::io::occt
