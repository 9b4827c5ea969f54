// Shapes made of patches, and what leaves promise beside their roots (patch_leaves_test.cpp).
#include <gtest/gtest.h>

#include <array>

#include "geometry/bernstein.h"
#include "geometry/bicubic.h"
#include "geometry/nurbs.h"
#include "geometry/patch_borders.h"
#include "geometry/sphere.h"
#include "geometry/swept.h"
#include "shape_check.h"

namespace crescente::geometry::test {
namespace {

BezierPatch hills(int p, int q, bool rational, Random& random) {
    BezierPatch patch{p, q, rational, 0, 1, 0, 1, {}};
    for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= q; ++j) {
            const double w = rational ? random.between(0.5, 2) : 1, height = random.between(-1, 1);
            patch.points.push_back({Vec3{2.0 * i / p - 1, 2.0 * j / q - 1, height} * w, w});
        }
    }
    return patch;
}

// A sphere as a half circle turned about y.
Revolution ball(double radius) {
    Revolution shape;
    shape.profile.push_back({CurveKind::arc, 3, false, {{0, -radius, 0}, {radius, 0, 0}, {0, radius, 0}}, {}, {}});
    shape.prepare();
    return shape;
}

Vec3 at(const BezierPatch& patch, double s, double t) {
    std::array<double, max_patch_degree + 1> bu, su, bv, sv;
    bernstein(patch.degree_u, s, bu.data(), su.data()), bernstein(patch.degree_v, t, bv.data(), sv.data());
    Vec3 sum;
    double weight = 0;
    for (int i = 0; i <= patch.degree_u; ++i) {
        for (int j = 0; j <= patch.degree_v; ++j) {
            const auto k = static_cast<std::size_t>(i), l = static_cast<std::size_t>(j);
            sum += patch.at(i, j).weighted * (bu[k] * bv[l]), weight += patch.at(i, j).weight * bu[k] * bv[l];
        }
    }
    return sum / weight;
}

Vec3 at(const CurvePiece& piece, double s) {
    std::array<double, max_patch_degree + 1> b, slope;
    bernstein(static_cast<int>(piece.points.size()) - 1, s, b.data(), slope.data());
    Vec3 sum;
    double weight = 0;
    for (std::size_t i = 0; i < piece.points.size(); ++i) sum += piece.points[i].weighted * b[i], weight += piece.points[i].weight * b[i];
    return sum / weight;
}

template <class Kind>
std::optional<ShapeHit> nearest(const Kind& shape, const Ray& ray) {
    std::optional<ShapeHit> best;
    for (std::uint32_t part = 0; part < shape.parts(); ++part) {
        const auto hit = shape.intersect(part, ray);
        if (hit && (!best || hit->t < best->t)) best = hit;
    }
    return best;
}

TEST(PatchShapes, LanesGiveTheSameBits) {
    Random random(3);
    const std::pair<int, int> degrees[] = {{1, 1}, {1, 2}, {2, 1}, {2, 2}, {1, 3}, {3, 1}, {2, 3}, {3, 2}, {3, 3}, {1, 5}, {5, 1}, {3, 5}, {5, 3}, {5, 5}, {4, 7}};
    for (const auto& [p, q] : degrees) {
        int met = 0;
        for (const bool rational : {false, true}) {
            const BezierPatch patch = hills(p, q, rational, random);
            const PatchLeaves leaves({&patch, 1});
            for (int round = 0; round < 300; ++round) {
                RayLanes lanes;
                std::array<Ray, lane_count> rays;
                const std::uint32_t leaf = static_cast<std::uint32_t>(random.bits() % leaves.count());
                for (int i = 0; i < lane_count; ++i) {
                    const auto range = leaves.range(leaf);
                    const Vec3 target = leaves.at(leaf, random.between(range.u0, range.u1), random.between(range.v0, range.v1)).position, along = random.direction();
                    const Ray ray{target - along * random.between(0, 5), along * random.between(0.1, 10), 0, random.bits() % 4 ? HUGE_VAL : 0.4};
                    rays[static_cast<std::size_t>(i)] = ray;
                    lanes.origin.x[i] = ray.origin.x, lanes.origin.y[i] = ray.origin.y, lanes.origin.z[i] = ray.origin.z;
                    lanes.direction.x[i] = ray.direction.x, lanes.direction.y[i] = ray.direction.y, lanes.direction.z[i] = ray.direction.z;
                    lanes.t_min[i] = ray.t_min, lanes.t_max[i] = ray.t_max;
                }
                const unsigned active = static_cast<unsigned>(random.bits() & 0xff);
                PatchRootLanes roots;
                const unsigned found = leaves.nearest(leaf, lanes, active, roots);
                for (int i = 0; i < lane_count; ++i) {
                    const auto one = leaves.nearest(leaf, rays[static_cast<std::size_t>(i)]);
                    ASSERT_EQ(found >> i & 1, (active >> i & 1) && one.has_value() ? 1u : 0u) << p << " x " << q;
                    if (!(found >> i & 1)) continue;
                    ++met;
                    ASSERT_TRUE(roots.t[i] == one->t && roots.u[i] == one->u && roots.v[i] == one->v) << p << " x " << q;
                }
            }
        }
        EXPECT_GT(met, 100) << p << " x " << q;
    }
}

TEST(PatchShapes, PointsAreFoundAgain) {
    Random random(4);
    for (int round = 0; round < 40; ++round) {
        const BezierPatch patch = hills(1 + round % 5, 1 + round / 5 % 5, round % 2, random);
        const PatchLeaves leaves({&patch, 1});
        for (int i = 0; i < 50; ++i) {
            const auto leaf = static_cast<std::uint32_t>(random.bits() % leaves.count());
            // A point of the patch that is on this leaf: where a ray meets it.
            const double u = random.unit(), v = random.unit();
            const Vec3 target = at(patch, u, v), along = random.direction();
            const auto root = leaves.nearest(leaf, {target - along * 3, along});
            if (!root) continue;
            const PatchPoint on = leaves.at(leaf, root->u, root->v);
            ASSERT_LE(length(on.position - at(patch, root->u, root->v)), 1e-14);
            const PatchRoot back = leaves.locate(leaf, on.position);
            ASSERT_NEAR(back.u, root->u, 1e-11);
            ASSERT_NEAR(back.v, root->v, 1e-11);
            const double h = 1e-6;
            const Vec3 du = (at(patch, root->u + h, root->v) - at(patch, root->u - h, root->v)) / (2 * h);
            const Vec3 dv = (at(patch, root->u, root->v + h) - at(patch, root->u, root->v - h)) / (2 * h);
            ASSERT_LE(length(on.along_u - du), 1e-8 * (1 + length(du)));
            ASSERT_LE(length(on.along_v - dv), 1e-8 * (1 + length(dv)));
            ASSERT_LE(length(on.normal - normalize(cross(du, dv))), 1e-6);
        }
    }
}

TEST(PatchShapes, LeavesAreSmall) {
    Random random(5);
    std::vector<BezierPatch> patches;
    for (int i = 0; i < 20; ++i) patches.push_back(hills(3, 3, i % 2, random));
    const PatchLeaves leaves(patches);
    EXPECT_GT(leaves.count(), 20u);
    EXPECT_LE(leaves.bytes(), leaves.count() * std::size_t{614});
}

TEST(PatchShapes, BallIsASphere) {
    const double radius = 2;
    const Revolution shape = ball(radius);
    const Sphere sphere{radius};
    Random random(6);
    int met = 0;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 origin = random.direction() * 7, to = random.inside_cube() * 2.2;
        const Ray ray{origin, normalize(to - origin)};
        const auto expected = sphere.intersect(0, ray), found = nearest(shape, ray);
        const double beside = length(cross(origin, ray.direction));
        if (std::abs(beside - radius) < 1e-9) continue;
        ASSERT_EQ(expected.has_value(), found.has_value()) << beside;
        if (!found) continue;
        ++met;
        ASSERT_NEAR(found->t, expected->t, 1e-13 * 7 / std::sqrt(1 - std::min(beside / radius, 0.999999)));
        const SurfacePoint point = shape.surface(found->primitive, ray.at(found->t));
        ASSERT_NEAR(length(point.position), radius, point.error);
        ASSERT_LE(length(point.normal - normalize(point.position)), 1e-7);
    }
    EXPECT_GT(met, 1000);
}

// Rays from inside, aimed at borders of leaves, at seams and at the poles: none leaves without a hit.
TEST(PatchShapes, NothingLeaks) {
    const Revolution shape = ball(1);
    Random random(7);
    const auto& leaves = *shape.leaves();
    for (int i = 0; i < 4000; ++i) {
        const double around = 2 * pi * double(random.bits() % 65) / 64, up = pi * double(random.bits() % 33) / 32 - pi / 2;
        const bool border = i % 2;
        const double turn = border ? around : random.between(0, 2 * pi), rise = border ? random.between(-pi / 2, pi / 2) : up;
        const Vec3 target{std::cos(rise) * std::cos(turn), std::sin(rise), -std::cos(rise) * std::sin(turn)};
        const Vec3 from = i % 5 ? random.inside_cube() * 0.5 : Vec3{};
        const auto hit = nearest(shape, {from, normalize(target - from)});
        ASSERT_TRUE(hit) << i;
        ASSERT_NEAR(length(from + normalize(target - from) * hit->t), 1, 1e-13);
    }
    for (const double pole : {-1.0, 1.0}) {
        for (int i = 0; i < 200; ++i) {
            const double size = std::exp2(random.between(-60, -2));
            const Vec3 origin = random.inside_cube() * 0.3, target = Vec3{random.between(-1, 1) * size, pole, random.between(-1, 1) * size};
            const auto hit = nearest(shape, {origin, normalize(target - origin)});
            ASSERT_TRUE(hit) << size;
            const auto point = shape.surface(hit->primitive, origin + normalize(target - origin) * hit->t);
            ASSERT_LE(length(point.normal - normalize(point.position)), 1e-6) << size;
        }
    }
    EXPECT_GT(leaves.count(), 8u);
}

TEST(PatchShapes, FreeBordersAreExtended) {
    Random random(8);
    BezierPatch left = hills(3, 3, false, random), right = left;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) right.points[static_cast<std::size_t>(4 * i + j)].weighted = left.at(3 - i, j).weighted + Vec3{2 * (1.0 - (2.0 * (3 - i) / 3 - 1)), 0, 0};
    }
    const std::array<BezierPatch, 2> both{left, right};
    const auto free = free_borders(both);
    EXPECT_EQ(free[0], (std::array{true, false, true, true}));
    EXPECT_EQ(free[1], (std::array{false, true, true, true}));
    const double band = 1e-3;
    const PatchLeaves leaves(both, band), bare(both);
    Bounds whole, plain;
    for (std::uint32_t k = 0; k < leaves.count(); ++k) whole.include(leaves.bounds(k));
    for (std::uint32_t k = 0; k < bare.count(); ++k) plain.include(bare.bounds(k));
    EXPECT_LT(whole.lower.x, plain.lower.x - 0.9 * band);
    EXPECT_LT(whole.lower.y, plain.lower.y - 0.9 * band);
    const Vec3 outside = at(left, -0.5 * band / 2, 0.3);  // 2 is the length in x
    bool met = false;
    for (std::uint32_t k = 0; k < leaves.count(); ++k) met = met || leaves.nearest(k, {outside + Vec3{0, 0, 3}, {0, 0, -1}});
    EXPECT_TRUE(met);
}

TEST(PatchShapes, BasesAgree) {
    Random random(9);
    std::array<Vec3, 16> points;
    for (auto& p : points) p = random.inside_cube();
    const auto patch_of = [&](PatchBasis basis) {
        Bicubic shape;
        shape.basis = basis, shape.points = {points};
        return shape.patches().value()[0];
    };
    const auto blend = [&](const std::array<double, 4>& a, const std::array<double, 4>& b) {
        Vec3 sum;
        for (std::size_t i = 0; i < 4; ++i) {
            for (std::size_t j = 0; j < 4; ++j) sum += points[4 * i + j] * (a[i] * b[j]);
        }
        return sum;
    };
    const auto spline = [](double t) { return std::array{(1 - t) * (1 - t) * (1 - t) / 6, (3 * t * t * t - 6 * t * t + 4) / 6, (-3 * t * t * t + 3 * t * t + 3 * t + 1) / 6, t * t * t / 6}; };
    const auto hermite = [](double t) { return std::array{2 * t * t * t - 3 * t * t + 1, -2 * t * t * t + 3 * t * t, t * t * t - 2 * t * t + t, t * t * t - t * t}; };
    const auto rom = [](double t) {
        return std::array{(-t * t * t + 2 * t * t - t) / 2, (3 * t * t * t - 5 * t * t + 2) / 2, (-3 * t * t * t + 4 * t * t + t) / 2, (t * t * t - t * t) / 2};
    };
    for (int i = 0; i < 20; ++i) {
        const double s = random.unit(), t = random.unit();
        EXPECT_LE(length(at(patch_of(PatchBasis::b_spline), s, t) - blend(spline(s), spline(t))), 1e-14);
        EXPECT_LE(length(at(patch_of(PatchBasis::hermite), s, t) - blend(hermite(s), hermite(t))), 1e-14);
        EXPECT_LE(length(at(patch_of(PatchBasis::catmull_rom), s, t) - blend(rom(s), rom(t))), 1e-14);
    }
    EXPECT_EQ(patch_of(PatchBasis::bezier).points[6].weighted, points[6]);
}

TEST(PatchShapes, NurbsFollowTheirDefinition) {
    Random random(10);
    Nurbs shape;
    shape.degree_u = 3, shape.degree_v = 2;
    shape.knots_u = {0, 0, 0, 0, 0.3, 1, 1, 2, 2, 2, 2}, shape.knots_v = {-1, 0, 0.5, 1, 1.5, 4, 5};
    shape.points.resize(7), shape.weights.resize(7);
    for (std::size_t i = 0; i < 7; ++i) {
        for (int j = 0; j < 4; ++j) shape.points[i].push_back(random.inside_cube()), shape.weights[i].push_back(random.between(0.3, 3));
    }
    // Cox and de Boor's recurrence.
    const std::function<double(const std::vector<double>&, std::size_t, int, double)> basis = [&](const std::vector<double>& k, std::size_t i, int p, double s) {
        if (p == 0) return k[i] <= s && s < k[i + 1] ? 1.0 : 0.0;
        const auto d = static_cast<std::size_t>(p);
        double sum = 0;
        if (k[i + d] > k[i]) sum += (s - k[i]) / (k[i + d] - k[i]) * basis(k, i, p - 1, s);
        if (k[i + d + 1] > k[i + 1]) sum += (k[i + d + 1] - s) / (k[i + d + 1] - k[i + 1]) * basis(k, i + 1, p - 1, s);
        return sum;
    };
    const auto patches = shape.patches();
    ASSERT_TRUE(patches);
    EXPECT_EQ(patches->size(), 3u * 2u);
    for (const BezierPatch& patch : *patches) {
        for (int n = 0; n < 10; ++n) {
            const double s = random.unit(), t = random.unit();
            const double u = patch.u0 + s * (patch.u1 - patch.u0), v = patch.v0 + t * (patch.v1 - patch.v0);
            Vec3 sum;
            double weight = 0;
            for (std::size_t i = 0; i < 7; ++i) {
                for (std::size_t j = 0; j < 4; ++j) {
                    const double b = basis(shape.knots_u, i, 3, u) * basis(shape.knots_v, j, 2, v) * shape.weights[i][j];
                    sum += shape.points[i][j] * b, weight += b;
                }
            }
            ASSERT_LE(length(at(patch, s, t) - sum / weight), 1e-13);
        }
    }
}

TEST(PatchShapes, RevolutionFollowsItsDefinition) {
    Revolution shape;
    shape.profile.push_back({CurveKind::b_spline, 3, true, {{2, 0, 0}, {2.5, 0.1, 0}, {2.6, 0.5, 0}, {2.2, 0.6, 0}, {1.9, 0.3, 0}}, {}, {}});
    shape.start = 0.3, shape.sweep = 3 * pi, shape.twist = 2, shape.pitch = 1.5, shape.pivot = {2.2, 0.3, 0};
    const auto patches = shape.patches();
    ASSERT_TRUE(patches);
    const auto pieces = pieces_of(shape.profile[0]);
    Random random(11);
    for (int i = 0; i < 500; ++i) {
        const std::size_t k = random.bits() % patches->size();
        const BezierPatch& patch = (*patches)[k];
        const double s = random.unit(), t = random.unit(), angle = patch.u0 + s * (patch.u1 - patch.u0) - shape.start;
        const Vec3 p = at((*pieces)[k % pieces->size()], t) - shape.pivot;
        const double turn = shape.twist * angle / shape.sweep;
        const Vec3 q = shape.pivot + Vec3{p.x * std::cos(turn) - p.y * std::sin(turn), p.x * std::sin(turn) + p.y * std::cos(turn), 0};
        const double a = shape.start + angle;
        const Vec3 expected{q.x * std::cos(a), q.y + shape.pitch * angle / (2 * pi), -q.x * std::sin(a)};
        ASSERT_LE(length(at(patch, s, t) - expected), 3e-6);
    }
    // A directrix of the circle's own is the circle.
    Revolution round = ball(1);
    round.directrix = {1, 1, 1, 1};
    const auto circles = round.patches().value();
    for (const BezierPatch& patch : circles) ASSERT_NEAR(length(at(patch, 0.37, 0.61)), 1, 2e-6);
}

TEST(PatchShapes, ExtrusionAndRuled) {
    Extrusion tube;
    tube.profile.push_back({CurveKind::arc, 3, false, {{1, 0, 0}, {0, 0, -1}, {-1, 0, 0}}, {}, {}});
    tube.direction = {0, 2, 0};
    tube.prepare();
    const auto hit = nearest(tube, {{0.2, 1, 0}, {0, 0, -1}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, std::sqrt(1 - 0.04), 1e-14);

    Ruled sheet;  // a hyperbolic paraboloid y = x z, from curves of different degrees and ends
    sheet.from.push_back({CurveKind::polyline, 3, false, {{0, 0, 0}, {1, 0, 0}}, {}, {}});
    sheet.to.push_back({CurveKind::b_spline, 2, false, {{0, 0, 1}, {0.25, 0.25, 1}, {0.75, 0.75, 1}, {1, 1, 1}}, {}, {}});
    sheet.prepare();
    ASSERT_GT(sheet.parts(), 0u);
    const auto down = nearest(sheet, {{0.5, 5, 0.5}, {0, -1, 0}});
    ASSERT_TRUE(down);
    EXPECT_NEAR(5 - down->t, 0.25, 0.02);
}

TEST(PatchShapes, WrongDescriptionsAreTold) {
    Nurbs nurbs;
    nurbs.points = {{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0}}};
    nurbs.knots_u = {0, 0, 1, 1}, nurbs.knots_v = {0, 1};
    const auto patches = nurbs.patches();
    ASSERT_FALSE(patches);
    EXPECT_GE(patches.error().problems.size(), 2u);
    nurbs.prepare();
    EXPECT_EQ(nurbs.parts(), 0u);
    Extrusion flat;
    EXPECT_FALSE(flat.patches());
    flat.profile.push_back({CurveKind::arc, 3, false, {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {}, {}});
    EXPECT_EQ(flat.patches().error().problems[0].place, "profile/0/points");
    Bicubic weights;
    weights.points.resize(1), weights.weights.resize(1);
    EXPECT_FALSE(weights.patches());
}

TEST(PatchShapes, HostileRays) {
    check_hostile_rays(ball(1));
    Random random(12);
    Bicubic shape;
    shape.points.resize(1);
    for (auto& p : shape.points[0]) p = random.inside_cube();
    shape.prepare();
    check_hostile_rays(shape);
}

}  // namespace
}  // namespace crescente::geometry::test
