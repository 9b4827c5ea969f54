#include "geometry/nurbs.h"

#include <cmath>
#include <string>

#include "geometry/bernstein.h"
#include "geometry/curve.h"

namespace crescente::geometry {

Expected<std::vector<BezierPatch>> Nurbs::patches() const {
    Error error{ErrorKind::input, {}};
    const auto wrong = [&](const std::string& place, const std::string& reason) { error.problems.push_back({"", place, reason, ""}); };
    const std::size_t rows = points.size(), columns = rows > 0 ? points[0].size() : 0;
    for (std::size_t i = 0; i < rows; ++i) {
        if (points[i].size() != columns) wrong("points/" + std::to_string(i), "has " + std::to_string(points[i].size()) + " points, the first row " + std::to_string(columns));
        for (const Vec3 p : points[i]) {
            if (!is_finite(p)) wrong("points/" + std::to_string(i), "a point is not finite");
        }
    }
    if (!weights.empty() && weights.size() != rows) wrong("weights", "there are " + std::to_string(weights.size()) + " rows of weights for " + std::to_string(rows) + " of points");
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (weights[i].size() != columns) wrong("weights/" + std::to_string(i), "has " + std::to_string(weights[i].size()) + " weights for " + std::to_string(columns) + " points");
        for (const double w : weights[i]) {
            if (!(w > 0) || !std::isfinite(w)) wrong("weights/" + std::to_string(i), "weights must be positive");
        }
    }
    const auto knots_are_right = [&](const std::string& name, const std::vector<double>& knots, std::size_t count, int degree) {
        if (degree < 1 || degree > max_patch_degree) return wrong("degree_" + name, "must be from 1 to " + std::to_string(max_patch_degree));
        if (const std::string problem = knot_problem(knots, count, degree); !problem.empty()) wrong("knots_" + name, problem);
    };
    knots_are_right("u", knots_u, rows, degree_u), knots_are_right("v", knots_v, columns, degree_v);
    if (!error.problems.empty()) return tl::unexpected(std::move(error));

    std::vector<BezierPatch> result;
    const auto spans_v = knot_spans(knots_v, degree_v);
    for (const KnotSpan& u : knot_spans(knots_u, degree_u)) {
        // Rows of the patches first, for all columns.
        std::vector<std::vector<ControlPoint>> across(u.matrix.size(), std::vector<ControlPoint>(columns, {{}, 0}));
        for (std::size_t i = 0; i < u.matrix.size(); ++i) {
            for (std::size_t k = 0; k < u.matrix.size(); ++k) {
                for (std::size_t j = 0; j < columns; ++j) {
                    const double w = weights.empty() ? 1 : weights[u.first + k][j];
                    across[i][j].weighted += points[u.first + k][j] * (w * u.matrix[i][k]), across[i][j].weight += w * u.matrix[i][k];
                }
            }
        }
        for (const KnotSpan& v : spans_v) {
            BezierPatch& patch = result.emplace_back(BezierPatch{degree_u, degree_v, !weights.empty(), u.from, u.to, v.from, v.to, {}});
            for (const auto& row : across) {
                for (const auto& mixture : v.matrix) {
                    ControlPoint sum{{}, 0};
                    for (std::size_t k = 0; k < mixture.size(); ++k) {
                        sum.weighted += row[v.first + k].weighted * mixture[k], sum.weight += row[v.first + k].weight * mixture[k];
                    }
                    if (weights.empty()) sum.weight = 1;
                    patch.points.push_back(sum);
                }
            }
        }
    }
    return result;
}

const FieldTable<Nurbs>& Nurbs::fields() {
    static const FieldTable<Nurbs> table{
        field(&Nurbs::degree_u, {"degree_u", FieldType::integer, "", 1, max_patch_degree, "Degree along u"}),
        field(&Nurbs::degree_v, {"degree_v", FieldType::integer, "", 1, max_patch_degree, "Degree along v"}),
    };
    return table;
}

}  // namespace crescente::geometry
