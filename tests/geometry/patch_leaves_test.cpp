// Leaves of patches against an oracle that only subdivides. CRESCENTE_PATCH_RAYS=100000 tries so many rays of each kind instead of a few.
#include "geometry/patch_leaves.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <tuple>

#include "geometry/bernstein.h"
#include "patch_oracle.h"
#include "shape_check.h"

namespace crescente::geometry::test {
namespace {

int rays_of_a_kind() {
    const char* text = std::getenv("CRESCENTE_PATCH_RAYS");
    return text ? std::atoi(text) : 250;
}

// A net over [-1, 1]^2 that bends as much as `wave`.
BezierPatch wavy(int p, int q, double wave, bool rational, Random& random) {
    BezierPatch patch{p, q, rational, -1, 2, 3, 5, {}};
    for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= q; ++j) {
            const Vec3 jitter = random.inside_cube() * wave;
            const double w = rational ? std::exp(random.between(-1, 1)) : 1;
            const Vec3 at{2.0 * i / p - 1 + 0.4 * jitter.x / p, 2.0 * j / q - 1 + 0.4 * jitter.y / q, jitter.z};
            patch.points.push_back({at * w, w});
        }
    }
    return patch;
}

BezierPatch moved(BezierPatch patch, double scale, Vec3 offset) {
    for (ControlPoint& c : patch.points) c.weighted = (c.weighted * scale) + offset * c.weight;
    return patch;
}

Vec3 point(const PatchOracle& oracle, double u, double v) {
    const auto p = oracle.at(u, v);
    return oracle.corner() + Vec3{double(p.x), double(p.y), double(p.z)};
}

enum class Aim { anywhere, grazing, border };

Ray aimed(const PatchOracle& oracle, Aim aim, double size, double away, Random& random) {
    double u = random.between(-0.1, 1.1), v = random.between(-0.1, 1.1);
    if (aim == Aim::border) {  // of leaves: these are at halves, quarters ...
        const double at = std::ldexp(double(random.bits() % 17), -4);
        (random.bits() % 2 ? u : v) = at;
    }
    const Vec3 target = point(oracle, u, v);
    Vec3 along = random.direction();
    if (aim == Aim::grazing) {
        const double h = 1e-6;
        const Vec3 du = (point(oracle, u + h, v) - target) / h, dv = (point(oracle, u, v + h) - target) / h;
        const double turn = random.between(0, 2 * pi);
        along = normalize(normalize(du) * std::cos(turn) + normalize(dv) * std::sin(turn));
        along = normalize(along + random.direction() * std::exp2(random.between(-30, -3)));
    }
    return {target - along * (away * size), along * std::exp2(random.between(-3, 3)), -HUGE_VAL, HUGE_VAL};
}

std::vector<PatchRoot> all_roots(const PatchLeaves& leaves, const Ray& ray) {
    std::vector<PatchRoot> all;
    for (std::uint32_t leaf = 0; leaf < leaves.count(); ++leaf) {
        std::array<PatchRoot, 16> some;
        const int count = leaves.roots(leaf, ray, some);
        for (int i = 0; i < count; ++i) {
            EXPECT_TRUE(i == 0 || some[i - 1].t <= some[i].t);
            all.push_back(some[i]);
        }
    }
    return all;
}

struct Tally {
    int rays = 0, roots = 0, unclear = 0, hopeless = 0;
};

void compare(const BezierPatch& patch, const PatchLeaves& leaves, const PatchOracle& oracle, const Ray& ray, double size, Tally& tally) {
    ++tally.rays;
    const Vec3 corner = patch.points[0].weighted / patch.points[0].weight;
    const double reach = length(ray.origin - corner) + 2 * size + (patch.rational ? length(corner) : 0), blur = 1e-6 + 2e3 * eps * reach / size;
    const std::vector<OracleRoot> truth = oracle.roots(ray, Real{2 * blur});
    if (oracle.hopeless()) {
        ++tally.hopeless;
        return;
    }
    std::vector<PatchRoot> roots = all_roots(leaves, ray);
    for (PatchRoot& r : roots) r.u = (r.u - patch.u0) / (patch.u1 - patch.u0), r.v = (r.v - patch.v0) / (patch.v1 - patch.v0);
    // Where leaves meet they may both have the root.
    std::sort(roots.begin(), roots.end(), [](const auto& a, const auto& b) { return a.t < b.t; });
    const double speed = length(ray.direction);
    const auto near = [&](const PatchRoot& r, const OracleRoot& o) {
        const double u = blur + o.blurred * double(o.u1 - o.u0), v = blur + o.blurred * double(o.v1 - o.v0);
        return r.u > o.u0 - u && r.u < o.u1 + u && r.v > o.v0 - v && r.v < o.v1 + v;
    };
    bool unclear = false;
    for (const OracleRoot& o : truth) {
        const bool inside = o.u0 > 1e-12 && o.u1 < 1 - 1e-12 && o.v0 > 1e-12 && o.v1 < 1 - 1e-12;
        int met = 0;
        const PatchRoot* last = nullptr;
        for (const PatchRoot& r : roots) {
            if (!near(r, o)) continue;
            if (!last || std::abs(r.u - last->u) > blur || std::abs(r.v - last->v) > blur) ++met;
            last = &r;
        }
        if (!inside || o.winding == 0) {
            unclear = true;
            continue;
        }
        ++tally.roots;
        ASSERT_TRUE(o.blurred ? met >= 1 : met == 1) << met << "of " << roots.size() << " at u " << double(o.u0) << " v " << double(o.v0) << " t " << double(o.t0) << " ray " << tally.rays;
        if (o.blurred) continue;
        ASSERT_LE(std::abs(double(last->t - (o.t0 + o.t1) / 2)) * speed, double(o.t1 - o.t0) * speed + 1e-6 * size + 64 * eps * reach);
    }
    tally.unclear += unclear;
    // Distances are found times the weight, which is at most 1.
    double heaviest = 0, lightest = HUGE_VAL;
    for (const ControlPoint& c : patch.points) heaviest = std::max(heaviest, c.weight), lightest = std::min(lightest, c.weight);
    const double precision = 512 * eps * reach * heaviest / lightest;
    for (const PatchRoot& r : roots) {  // on the surface, and on the ray
        // Rounding moves a root beyond the border the farther the more the ray grazes.
        const double step = 1e-6;
        const auto on = oracle.at(r.u, r.v), there = oracle.on_ray(ray, r.t);
        const auto from_here = [&](const PatchOracle::Point& p) { return Vec3{double(p.x - on.x), double(p.y - on.y), double(p.z - on.z)}; };
        const Vec3 along_u = from_here(oracle.at(r.u + step, r.v)), along_v = from_here(oracle.at(r.u, r.v + step));
        const double sine = std::abs(dot(normalize(cross(along_u, along_v)), ray.direction)) / speed, most = blur / std::max(sine, 1e-3);
        ASSERT_TRUE(r.u > -most && r.u < 1 + most && r.v > -most && r.v < 1 + most) << r.u << ' ' << r.v << " sine " << sine;
        ASSERT_LE(std::hypot(on.x - there.x, on.y - there.y, on.z - there.z), precision) << "u " << r.u << " v " << r.v;
    }
}

struct Placement {
    double scale, offset, away;
};
constexpr Placement placements[] = {{1, 0, 3}, {1e-3, 0, 3}, {1e3, 0, 100}, {1, 1e6, 3}, {1e-3, 1e6, 3}, {1e3, 1e6, 3}};

void check_degrees(int p, int q, bool rational, double wave) {
    const bool failed_before = ::testing::Test::HasFatalFailure();
    for (const Placement& place : placements) {
        Random random(static_cast<std::uint64_t>(p * 100 + q * 10 + rational));
        Tally tally;
        const Vec3 offset = Vec3{1, -0.7, 0.4} * place.offset;
        const int kinds = 3, patches = 4, count = rays_of_a_kind() / static_cast<int>(std::size(placements)) / kinds / patches + 1;
        for (int k = 0; k < patches; ++k) {
            const BezierPatch patch = moved(wavy(p, q, wave, rational, random), place.scale, offset);
            const PatchLeaves leaves({&patch, 1});
            const PatchOracle oracle(patch);
            for (const Aim aim : {Aim::anywhere, Aim::grazing, Aim::border}) {
                for (int i = 0; i < count; ++i) {
                    compare(patch, leaves, oracle, aimed(oracle, aim, place.scale, place.away, random), place.scale, tally);
                    if (::testing::Test::HasFatalFailure() && !failed_before) {
                        ADD_FAILURE() << "degrees " << p << " x " << q << " scale " << place.scale << " offset " << place.offset << " patch " << k;
                        return;
                    }
                }
            }
        }
        EXPECT_GT(tally.roots, tally.rays / 3);
        EXPECT_LT(tally.unclear, tally.rays / 2 + 3);
        EXPECT_LT(tally.hopeless, tally.rays / 5 + 3);
    }
}

// Rows of the net that are points have no normals, nor are there two in a row beside them: halving must go on along both ways all the same.
TEST(PatchLeaves, NetsThatShrinkToPointsMakeFewLeaves) {
    const double ring[4][2] = {{1, 0}, {1, -0.56}, {0.56, -1}, {0, -1}}, profile[4][2] = {{0, 3.15}, {0.8, 3.15}, {0, 2.85}, {0.2, 2.7}};  // the teapot's knob
    BezierPatch patch{3, 3, false, 0, 1, 0, 1, {}}, turned = patch;
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) {
            const auto at = [&](int along, int around) { return ControlPoint{{ring[around][0] * profile[along][0], ring[around][1] * profile[along][0], profile[along][1]}, 1}; };
            patch.points.push_back(at(i, j)), turned.points.push_back(at(j, i));
        }
    }
    for (const BezierPatch& knob : {patch, turned}) {
        const PatchLeaves leaves(std::array{knob});
        EXPECT_GT(leaves.count(), 20u);
        EXPECT_LT(leaves.count(), 150u);
    }
}

// Of a point a little beside a leaf the nearest point of the leaf is found, or that along its mean normal, which is little farther, with a search or without.
TEST(PatchLeaves, PointsBesideALeaf) {
    const int count = rays_of_a_kind() / 10 + 1;
    for (const auto& [p, q, rational, wave] : {std::tuple{1, 1, false, 1.0}, {2, 2, true, 0.7}, {3, 3, false, 0.7}, {3, 3, true, 0.7}, {5, 3, false, 0.7}}) {
        Random random(static_cast<std::uint64_t>(p * 10 + q));
        const PatchLeaves leaves(std::array{wavy(p, q, wave, rational, random)});
        for (int i = 0; i < count; ++i) {
            const auto leaf = static_cast<std::uint32_t>(random.bits() % leaves.count());
            const ParameterBox range = leaves.range(leaf);
            const auto surface = [&](double s, double t) { return leaves.at(leaf, range.u0 + s * (range.u1 - range.u0), range.v0 + t * (range.v1 - range.v0)).position; };
            const double far = std::exp2(random.between(-20, -3)), away = random.bits() % 2 ? -far : 1 + far, along = random.between(-0.05, 1.05);
            const bool by_u = random.bits() % 2;
            const double size = length(surface(1, 1) - surface(0, 0));
            const Vec3 point = surface(by_u ? away : along, by_u ? along : away) + random.direction() * (size * far * random.unit());
            const PatchRoot found = leaves.locate(leaf, point);
            // The nearest by a grid that is made finer about its best point.
            double s = 0.5, t = 0.5, step = 0.5 / 16, least = HUGE_VAL;
            for (int round = 0; round < 12; ++round, step /= 8) {
                const double middle_s = s, middle_t = t;
                for (int a = -16; a <= 16; ++a) {
                    for (int b = -16; b <= 16; ++b) {
                        const double at_s = std::clamp(middle_s + a * step, 0.0, 1.0), at_t = std::clamp(middle_t + b * step, 0.0, 1.0);
                        if (const double off = length(point - surface(at_s, at_t)); off < least) least = off, s = at_s, t = at_t;
                    }
                }
            }
            ASSERT_LE(length(point - leaves.at(leaf, found.u, found.v).position), 1.1 * least + 1e-12 * size) << p << " x " << q << ", " << i << ": beside by " << far;
        }
    }
}

TEST(PatchLeaves, Bilinear) { check_degrees(1, 1, false, 1); }
TEST(PatchLeaves, LinearBySquare) { check_degrees(1, 2, false, 0.7), check_degrees(2, 1, true, 0.7); }
TEST(PatchLeaves, Biquadratic) { check_degrees(2, 2, false, 0.7), check_degrees(2, 2, true, 0.7); }
TEST(PatchLeaves, LinearByCubic) { check_degrees(1, 3, false, 0.7), check_degrees(3, 1, true, 0.7); }
TEST(PatchLeaves, QuadraticByCubic) { check_degrees(2, 3, false, 0.7), check_degrees(3, 2, true, 0.7); }
TEST(PatchLeaves, Bicubic) { check_degrees(3, 3, false, 0.7); }
TEST(PatchLeaves, BicubicRational) { check_degrees(3, 3, true, 0.7); }
TEST(PatchLeaves, BicubicTangled) { check_degrees(3, 3, false, 3); }
TEST(PatchLeaves, Quintic) { check_degrees(1, 5, false, 0.7), check_degrees(5, 1, false, 0.7); }
TEST(PatchLeaves, CubicByQuintic) { check_degrees(3, 5, false, 0.7), check_degrees(5, 3, true, 0.7); }
TEST(PatchLeaves, Biquintic) { check_degrees(5, 5, false, 0.7); }
TEST(PatchLeaves, OddDegrees) { check_degrees(2, 7, true, 0.7), check_degrees(6, 4, true, 0.7); }
TEST(PatchLeaves, HighDegree) { check_degrees(13, 1, false, 0.7), check_degrees(9, 9, false, 0.7); }

}  // namespace
}  // namespace crescente::geometry::test
