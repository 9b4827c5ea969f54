// Loops against the winding number of a fine polyline of the same curves, on points far and near.
#include "geometry/trimming.h"

#include <algorithm>

#include "geometry/brep_models.h"

namespace crescente::geometry::test {
namespace {

const auto flat = [](Point2) { return Metric{}; };
Point2 unit_steps(const ParameterBox&) { return {1, 1}; }

Expected<Trimming> trim(const std::vector<Loop>& loops, Point2 period = {}) {
    Face face = trimmed(PlaneSurface{}, loops);
    return Trimming::make(face, period, unit_steps);
}

Point2 point_of(const LoopPiece& piece, double share) {
    if (const auto* line = std::get_if<LinePiece>(&piece)) return {line->from.u + share * (line->to.u - line->from.u), line->from.v + share * (line->to.v - line->from.v)};
    if (const auto* arc = std::get_if<ArcPiece>(&piece)) return evaluate(piece, arc->a0 + share * (arc->a1 - arc->a0)).at;
    return evaluate(piece, share).at;
}

// The loops as polylines, by the definition of the curves alone.
struct Polylines {
    std::vector<std::vector<Point2>> loops;

    explicit Polylines(const std::vector<Loop>& from, int steps = 160) {
        for (const Loop& loop : from) {
            auto& points = loops.emplace_back();
            for (const LoopEdge& edge : loop) {
                const int n = std::holds_alternative<LinePiece>(edge.piece) ? 1 : steps;
                for (int i = 0; i < n; ++i) points.push_back(point_of(edge.piece, double(i) / n));
            }
        }
    }
    bool encloses(Point2 p) const {
        bool inside = false;
        for (const auto& loop : loops) {
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const Point2 a = loop[i], b = loop[(i + 1) % loop.size()];
                if ((a.v > p.v) != (b.v > p.v) && a.u + (b.u - a.u) * ((p.v - a.v) / (b.v - a.v)) > p.u) inside = !inside;
            }
        }
        return inside;
    }
    double distance(Point2 p) const {
        double least = HUGE_VAL;
        for (const auto& loop : loops) {
            for (std::size_t i = 0; i < loop.size(); ++i) {
                const Point2 a = loop[i], b = loop[(i + 1) % loop.size()];
                const double du = b.u - a.u, dv = b.v - a.v, l2 = du * du + dv * dv;
                const double s = l2 > 0 ? std::clamp(((p.u - a.u) * du + (p.v - a.v) * dv) / l2, 0.0, 1.0) : 0;
                least = std::min(least, std::hypot(a.u + s * du - p.u, a.v + s * dv - p.v));
            }
        }
        return least;
    }
};

// A star-shaped outline of curves of one kind: lines, arcs or Bézier pieces of some degree, rational or not.
Loop outline(Random& random, int kind, int corners, Point2 center, double radius, double band) {
    std::vector<Point2> points;
    for (int i = 0; i < corners; ++i) {
        const double a = 2 * pi * (i + random.between(-0.3, 0.3)) / corners, r = radius * random.between(0.6, 1);
        points.push_back({center.u + r * std::cos(a), center.v + r * std::sin(a)});
    }
    Loop loop;
    for (int i = 0; i < corners; ++i) {
        const Point2 a = points[i], b = points[(i + 1) % corners];
        if (kind == 0) {
            loop.push_back({LinePiece{a, b}, band});
        } else if (kind == 1) {
            // A half ellipse over the chord, leaning to one side.
            const Point2 c{(a.u + b.u) / 2, (a.v + b.v) / 2}, x{a.u - c.u, a.v - c.v};
            const double bulge = random.between(0.05, 0.4), lean = random.between(-0.5, 0.5);
            loop.push_back({ArcPiece{c, x, {bulge * -x.v + lean * x.u, bulge * x.u + lean * x.v}, 0, random.bits() % 2 ? pi : -pi}, band});
        } else {
            const int degree = 1 + static_cast<int>(random.bits() % 6);
            BezierPiece piece;
            for (int k = 0; k <= degree; ++k) {
                const double s = double(k) / degree, w = kind == 3 ? random.between(0.3, 3) : 1;
                const double sway = k == 0 || k == degree ? 0 : 0.25 * radius / corners;
                const double u = a.u + s * (b.u - a.u) + sway * random.between(-1, 1), v = a.v + s * (b.v - a.v) + sway * random.between(-1, 1);
                piece.points.push_back({u * w, v * w, w});
            }
            loop.push_back({piece, band});
        }
    }
    return loop;
}

TEST(Trimming, RandomOutlines) {
    Random random(31);
    int near = 0;
    for (int i = 0; i < 240; ++i) {
        const int kind = i % 4, corners = 3 + static_cast<int>(random.bits() % (i % 5 == 0 ? 60 : 8));
        const double size = std::exp2(random.between(-12, 12)), band = i % 3 == 0 ? 0 : size * std::exp2(random.between(-20, -6));
        const Point2 center{size * random.between(-2, 2), size * random.between(-2, 2)};
        std::vector<Loop> loops{outline(random, kind, corners, center, size, band)};
        if (i % 2) loops.push_back(outline(random, (kind + 1) % 4, 5, center, size * 0.3, band));
        const auto trimming = trim(loops);
        ASSERT_TRUE(trimming) << i << ": " << trimming.error().text();
        const Polylines oracle(loops);
        const double chord = size * 1e-4;  // what the polylines miss
        for (int k = 0; k < 500; ++k) {
            Point2 p{center.u + size * random.between(-1.3, 1.3), center.v + size * random.between(-1.3, 1.3)};
            if (k % 2) {  // beside a curve
                const Loop& loop = loops[random.bits() % loops.size()];
                p = point_of(loop[random.bits() % loop.size()].piece, random.unit());
                const double off = std::max(2 * chord, 2 * band);
                p.u += off * random.between(-1, 1), p.v += off * random.between(-1, 1);
            }
            const Place place = trimming->locate(p, flat).place;
            const double distance = oracle.distance(p);
            if (distance > chord) {
                ASSERT_EQ(place == Place::inside, oracle.encloses(p)) << i << ' ' << k;
            }
            if (place == Place::band) {
                ASSERT_LE(distance, band * (1 + 1e-6) + chord) << i << ' ' << k;
            }
            if (place == Place::outside) {
                ASSERT_GE(distance, band * (1 - 1e-6) - chord) << i << ' ' << k;
            }
            near += place == Place::band;
        }
    }
    EXPECT_GT(near, 500);
}

// A symmetric outline has its vertices on rows and columns through the middle, where a sample is likely to fall.
TEST(Trimming, SymmetricOutlines) {
    for (const int corners : {3, 4, 6, 8, 12, 64}) {
        for (const double turn : {0.0, 0.5}) {
            std::vector<Point2> points;
            for (int i = 0; i < corners; ++i) points.push_back({std::cos(2 * pi * (i + turn) / corners), std::sin(2 * pi * (i + turn) / corners)});
            for (Point2& p : points) {
                for (double* c : {&p.u, &p.v}) *c = std::round(*c * 1e12) / 1e12;  // so that opposite vertices lie in one row to the bit
            }
            const std::vector<Loop> loops{polygon_loop(points, 0), circle_loop({0, 0}, 0.25, 0)};
            const auto trimming = trim(loops);
            ASSERT_TRUE(trimming);
            const Polylines oracle(loops);
            for (int i = -40; i <= 40; ++i) {
                for (int k = -40; k <= 40; ++k) {
                    const Point2 p{i / 32.0, k / 32.0};
                    if (oracle.distance(p) < 1e-4) continue;
                    ASSERT_EQ(trimming->locate(p, flat).place == Place::inside, oracle.encloses(p)) << corners << ' ' << p.u << ' ' << p.v;
                }
            }
        }
    }
}

// On a surface where steps along u and v are not alike nor orthogonal, the band is a length in space.
TEST(Trimming, BandIsMeasuredInSpace) {
    const double band = 0.01;
    const Vec3 su{3, 0.5, 0}, sv{0.2, 0.25, 0};
    const Metric metric{dot(su, su), dot(su, sv), dot(sv, sv)};
    const double sine = length(cross(su, sv)) / (length(su) * length(sv));
    const std::vector<Loop> loops{circle_loop({0, 0}, 1, band)};
    const auto trimming = Trimming::make(trimmed(PlaneSurface{}, loops), {}, [&](const ParameterBox&) { return Point2{length(su) * sine, length(sv) * sine}; });
    ASSERT_TRUE(trimming);
    Random random(5);
    int counts[3]{};
    for (int i = 0; i < 1500; ++i) {
        const double a = random.between(0, 2 * pi), r = 1 + 0.15 * random.unit();
        const Point2 p{r * std::cos(a), r * std::sin(a)};
        double nearest = HUGE_VAL;
        for (int k = 0; k < 8000; ++k) {
            const double b = 2 * pi * k / 8000;
            nearest = std::min(nearest, length(su * (std::cos(b) - p.u) + sv * (std::sin(b) - p.v)));
        }
        const Place place = trimming->locate(p, [&](Point2) { return metric; }).place;
        ++counts[int(place)];
        if (nearest < band * 0.99) {
            ASSERT_EQ(place, Place::band) << i << ' ' << p.u << ' ' << p.v << ' ' << nearest;
        }
        if (nearest > band * 1.01) {
            ASSERT_EQ(place, Place::outside) << i;
        }
    }
    EXPECT_GT(counts[int(Place::band)], 150);
    EXPECT_GT(counts[int(Place::outside)], 150);
}

TEST(Trimming, PeriodsAndSeams) {
    // From 5 to 5 + 2 pi: the whole turn, with the seam at 5; and a window across the angle pi, where atan2 jumps.
    const auto whole = trim({rectangle_loop(5, 5 + 2 * pi, 0, 1, 1e-9)}, {2 * pi, 0});
    const auto window = trim({rectangle_loop(3, 3.5, 0, 1, 1e-9)}, {2 * pi, 0});
    ASSERT_TRUE(whole && window);
    for (int i = -1000; i <= 1000; ++i) {
        const double u = i * pi / 1000;
        ASSERT_EQ(whole->locate({u, 0.5}, flat).place, Place::inside) << u;
        const double turned = u < 0 ? u + 2 * pi : u;
        const auto located = window->locate({u, 0.5}, flat);
        ASSERT_EQ(located.place == Place::inside, turned > 3 && turned < 3.5) << u;
        if (located.place == Place::inside) {
            ASSERT_NEAR(located.at.u, turned, 1e-14);
        }
    }
    for (const double off : {-1e-10, -1e-16, 0.0, 1e-16, 1e-10}) ASSERT_EQ(whole->locate({5 - 2 * pi + off, 0.5}, flat).place, Place::inside) << off;
    EXPECT_EQ(whole->locate({1, -0.5e-9}, flat).place, Place::band);
    EXPECT_EQ(whole->locate({1, -2e-9}, flat).place, Place::outside);
}

TEST(Trimming, SaysWhatLiesOutside) {
    Random random(8);
    const std::vector<Loop> loops{outline(random, 3, 7, {0, 0}, 1, 1e-3), circle_loop({0, 0}, 0.3, 1e-3)};
    const auto trimming = trim(loops);
    ASSERT_TRUE(trimming);
    int empty = 0;
    for (int i = 0; i < 5000; ++i) {
        const Point2 a{random.between(-1.2, 1.2), random.between(-1.2, 1.2)};
        const double size = random.between(0, 0.2);
        const ParameterBox box{a.u, a.u + size, a.v, a.v + size};
        if (!trimming->all_outside(box)) continue;
        ++empty;
        for (int k = 0; k < 50; ++k) {
            ASSERT_EQ(trimming->locate({random.between(box.u0, box.u1), random.between(box.v0, box.v1)}, flat).place, Place::outside);
        }
    }
    EXPECT_GT(empty, 500);
}

TEST(Trimming, BadLoops) {
    const auto reason = [](const std::vector<Loop>& loops) {
        const auto t = trim(loops);
        return t ? std::string("none") : t.error().text();
    };
    EXPECT_EQ(reason({rectangle_loop(0, 1, 0, 1, 0)}), "none");
    EXPECT_NE(reason({rectangle_loop(0, 1, 0, 1, -1)}).find("band"), std::string::npos);
    EXPECT_NE(reason({rectangle_loop(0, 1, 0, std::nan(""), 0)}).find("not finite"), std::string::npos);
    EXPECT_NE(reason({rectangle_loop(0, 1, 1, 1, 0)}).find("no area"), std::string::npos);
    EXPECT_NE(reason({{{LinePiece{{0, 0}, {1, 0}}, 0}, {LinePiece{{1, 0}, {1, 1}}, 0}}}).find("does not end"), std::string::npos);
    EXPECT_NE(reason({{{BezierPiece{{{0, 0, 1}}}, 0}}}).find("degree 0"), std::string::npos);
    EXPECT_NE(reason({{{BezierPiece{{{0, 0, 1}, {1, 1, -1}, {0, 0, 1}}}, 0}}}).find("weight"), std::string::npos);
    EXPECT_NE(reason({{{ArcPiece{{0, 0}, {1, 0}, {0, 1}, 0, 10}, 0}}}).find("turn"), std::string::npos);
    // Two bad loops are both told.
    const std::string both = reason({rectangle_loop(0, 1, 0, 1, -1), rectangle_loop(0, 1, 0, 1, -1)});
    EXPECT_NE(both.find("loop 0"), std::string::npos);
    EXPECT_NE(both.find("loop 1"), std::string::npos);
    // A gap within the band is welded.
    Loop gap = rectangle_loop(0, 1, 0, 1, 1e-4);
    std::get<LinePiece>(gap[1].piece).to.v += 0.5e-4;
    EXPECT_EQ(reason({gap}), "none");
}

}  // namespace
}  // namespace crescente::geometry::test
