#include "geometry/bicubic.h"

#include <string>

namespace crescente::geometry {
namespace {

// Four values in the basis become those of Bézier's, in place, `stride` apart.
void to_bezier(PatchBasis basis, ControlPoint* p, int stride) {
    const auto mix = [](double a, const ControlPoint& x, double b, const ControlPoint& y, double c, const ControlPoint& z) {
        return ControlPoint{x.weighted * a + y.weighted * b + z.weighted * c, x.weight * a + y.weight * b + z.weight * c};
    };
    const ControlPoint p0 = p[0], p1 = p[stride], p2 = p[2 * stride], p3 = p[3 * stride];
    const ControlPoint none{{}, 0};
    switch (basis) {
        case PatchBasis::bezier: return;
        case PatchBasis::b_spline:
            p[0] = mix(1 / 6.0, p0, 4 / 6.0, p1, 1 / 6.0, p2), p[3 * stride] = mix(1 / 6.0, p1, 4 / 6.0, p2, 1 / 6.0, p3);
            p[stride] = mix(2 / 3.0, p1, 1 / 3.0, p2, 0, none), p[2 * stride] = mix(1 / 3.0, p1, 2 / 3.0, p2, 0, none);
            return;
        case PatchBasis::hermite:  // ends, then tangents
            p[stride] = mix(1, p0, 1 / 3.0, p2, 0, none), p[2 * stride] = mix(1, p1, -1 / 3.0, p3, 0, none), p[3 * stride] = p1;
            return;
        case PatchBasis::catmull_rom:
            p[0] = p1, p[stride] = mix(1, p1, 1 / 6.0, p2, -1 / 6.0, p0);
            p[2 * stride] = mix(1, p2, -1 / 6.0, p3, 1 / 6.0, p1), p[3 * stride] = p2;
            return;
    }
}

}  // namespace

Expected<std::vector<BezierPatch>> Bicubic::patches() const {
    Error error{ErrorKind::input, {}};
    const auto wrong = [&](const std::string& place, const std::string& reason) { error.problems.push_back({"", place, reason, ""}); };
    if (points.empty()) wrong("patches", "there is no patch");
    if (!weights.empty() && weights.size() != points.size()) {
        wrong("weights", "there are " + std::to_string(weights.size()) + " sets of weights for " + std::to_string(points.size()) + " patches");
    }
    if (!weights.empty() && basis == PatchBasis::hermite) wrong("weights", "the hermite basis has none");
    std::vector<BezierPatch> result;
    for (std::size_t k = 0; k < points.size() && error.problems.empty(); ++k) {
        BezierPatch& patch = result.emplace_back();
        patch.degree_u = patch.degree_v = 3;
        patch.rational = !weights.empty();
        bool good = true;
        for (std::size_t i = 0; i < 16; ++i) {
            const double weight = weights.empty() ? (basis == PatchBasis::hermite && (i % 4 > 1 || i / 4 > 1) ? 0 : 1) : weights[k][i];
            good = good && is_finite(points[k][i] * weight) && (weights.empty() || (weight > 0 && std::isfinite(weight)));
            patch.points.push_back({points[k][i] * (weights.empty() ? 1 : weight), weight});
        }
        for (int i = 0; i < 4; ++i) to_bezier(basis, &patch.points[static_cast<std::size_t>(4 * i)], 1);
        for (int j = 0; j < 4; ++j) to_bezier(basis, &patch.points[static_cast<std::size_t>(j)], 4);
        for (ControlPoint& c : patch.points) {
            if (weights.empty()) c.weight = 1;
            good = good && c.weight > 0 && is_finite(c.weighted);
        }
        if (!good) wrong((weights.empty() ? "patches/" : "weights/") + std::to_string(k), "numbers must be finite, and weights positive throughout the patch");
    }
    if (!error.problems.empty()) return tl::unexpected(std::move(error));
    return result;
}

const FieldTable<Bicubic>& Bicubic::fields() {
    static const FieldTable<Bicubic> table{
        field(&Bicubic::basis, {"basis", FieldType::choice, "", 0, 3, "How 16 points make a patch", {"bezier", "b_spline", "hermite", "catmull_rom"}}),
    };
    return table;
}

}  // namespace crescente::geometry
