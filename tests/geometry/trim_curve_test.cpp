#include "geometry/trim_curve.h"

#include <gtest/gtest.h>

#include "shape_check.h"

namespace crescente::geometry::test {
namespace {

// What is told to be farther without looking for the nearest point is so.
void check_farther(const LoopPiece& curve, Random& random, int& told, int& far) {
    const std::vector<double> stops = monotone_stops(curve);
    for (std::size_t k = 1; k < stops.size(); ++k) {
        MonotonePiece piece{evaluate(curve, stops[k - 1]).at, evaluate(curve, stops[k]).at, 0, 0};
        if (random.between(0, 1) < 0.3) piece.to.u += 1e-4 * random.between(-1, 1), piece.from.v += 1e-4 * random.between(-1, 1);  // welded
        CurveStretch stretch{stops[k - 1], stops[k], 0};
        measure_bulge(piece, stretch, curve);
        for (int i = 0; i < 40; ++i) {
            const double uu = std::exp(random.between(-3, 3)), vv = std::exp(random.between(-3, 3));
            const Metric metric{uu, random.between(-0.9, 0.9) * std::sqrt(uu * vv), vv};
            const Point2 on = evaluate(curve, stops[k - 1] + random.between(0, 1) * (stops[k] - stops[k - 1])).at;
            const double away = std::exp(random.between(-8, 1));
            const Point2 p{on.u + away * random.between(-1, 1), on.v + away * random.between(-1, 1)};
            const double distance = std::exp(random.between(-8, 0)), nearest = std::sqrt(nearest_point(piece, &stretch, &curve, p, metric).distance2);
            far += nearest > distance;
            if (!surely_farther(piece, stretch, curve, p, metric, distance)) continue;
            ++told;
            ASSERT_GT(nearest, distance);
        }
    }
}

TEST(TrimCurve, WhatIsToldToBeFartherIsSo) {
    Random random(5);
    int told = 0, far = 0;
    for (int i = 0; i < 500; ++i) {
        ArcPiece arc{{random.between(-3, 3), random.between(-3, 3)}, {random.between(-1, 1), random.between(-1, 1)}, {}, random.between(-7, 7), 0};
        arc.a1 = arc.a0 + random.between(-6, 6);
        arc.y = i % 3 == 0 ? Point2{-arc.x.v, arc.x.u} : i % 3 == 1 ? Point2{arc.x.v, -arc.x.u} : Point2{random.between(-1, 1), random.between(-1, 1)};
        check_farther(LoopPiece{arc}, random, told, far);
        BezierPiece bezier;
        const int degree = 1 + i % 7;
        for (int k = 0; k <= degree; ++k) {
            const double w = i % 2 ? 1 : std::exp(random.between(-1, 1));
            bezier.points.push_back({w * (k + random.between(-1, 1)), w * random.between(-1, 1), w});
        }
        check_farther(LoopPiece{bezier}, random, told, far);
    }
    EXPECT_GT(told, far / 2);
}

}  // namespace
}  // namespace crescente::geometry::test
