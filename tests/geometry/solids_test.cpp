// The closed solids against their distance functions in long double, at many sizes and distances.
#include "geometry/box.h"
#include "geometry/cone.h"
#include "geometry/cylinder.h"
#include "geometry/shape_check.h"
#include "geometry/sphere.h"
#include "geometry/torus.h"

namespace crescente::geometry::test {
namespace {

using L = long double;

// A solid, its true distance and points on it.
template <class S>
struct Sample {
    S shape;
    double size;
    SignedDistance distance;
    std::function<Exact(Random&)> point;
    Vec3 center{};
};

Exact around(L rho, L y, double turn) { return {rho * std::cos((L)turn), y, rho * std::sin((L)turn)}; }

Sample<Sphere> sphere(double scale) {
    const L r = 1.25 * scale;
    return {{double(r)}, double(r), [r](Exact p) { return std::hypot(p.x, p.y, p.z) - r; }, [r](Random& random) {
                const L v = std::asin((L)random.between(-1, 1));
                return around(r * std::cos(v), r * std::sin(v), random.between(0, 2 * pi));
            }};
}

Sample<Box> box(double scale) {
    const Vec3 lower = Vec3{-1, -0.25, 0.1} * scale, upper = Vec3{0.5, 0.75, 0.4} * scale;
    return {{lower, upper}, 1.3 * scale, [=](Exact p) {
                const L a = std::max((L)lower.x - p.x, p.x - upper.x), b = std::max((L)lower.y - p.y, p.y - upper.y);
                return std::max({a, b, std::max((L)lower.z - p.z, p.z - upper.z)});
            },
            [=](Random& random) {
                Vec3 p;
                for (int k = 0; k < 3; ++k) p[k] = random.between(lower[k], upper[k]);
                const int axis = static_cast<int>(random.bits() % 3);
                p[axis] = random.bits() % 2 ? lower[axis] : upper[axis];
                return exact(p);
            }};
}

// Distance to a frustum's sides as planes in the meridian: exact near the faces, a bound elsewhere.
Sample<Cone> cone(double base, double top, double height) {
    const L b = base, k = ((L)top - base) / height, slant = std::sqrt(1 + k * k), h = height;
    return {{base, top, height, true}, std::max({base, top, height}),
            [=](Exact p) { return std::max({(std::hypot(p.x, p.z) - (b + k * p.y)) / slant, -p.y, p.y - h}); },
            [=](Random& random) {
                const double turn = random.between(0, 2 * pi);
                const L y = random.between(0, height), s = std::sqrt((L)random.unit());
                switch (random.bits() % 4) {
                    case 0: if (base > 0) return around(s * b, 0, turn); break;
                    case 1: if (top > 0) return around(s * top, h, turn); break;
                    default: break;
                }
                return around(b + k * y, y, turn);
            },
            {0, height / 2, 0}};
}

Sample<Cylinder> cylinder(double radius, double height) {
    const Sample<Cone> c = cone(radius, radius, height);
    return {{radius, height, true}, c.size, c.distance, c.point, c.center};
}

Sample<Torus> torus(double major, double minor) {
    const L R = major, r = minor;
    return {{major, minor}, major + minor, [=](Exact p) { return std::hypot(std::hypot(p.x, p.z) - R, p.y) - r; },
            [=](Random& random) {
                for (;;) {
                    const double turn = random.between(0, 2 * pi);
                    const L v = random.between(0, 2 * pi), rho = R + r * std::cos(v);
                    if (rho >= 0) return around(rho, r * std::sin(v), turn);
                }
            }};
}

template <class S>
void check_all(const Sample<S>& s, int count = 20000) {
    for (const double away : {3.0, 1e3, 1e6}) {
        SCOPED_TRACE("from " + std::to_string(away) + " sizes, size " + std::to_string(s.size));
        check_reintersection(s.shape, s.distance, s.point, s.size, away, count, 1);
        check_oracle(s.shape, s.distance, s.size, s.center, away, count / 10, 2);
        check_oracle(s.shape, s.distance, s.size, s.center, 0, count / 20, 3);  // from inside and nearby
    }
    check_transformed(s.shape, s.size, 2000, 4);
}

TEST(Solids, sphere) {
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) check_all(sphere(scale));
    check_reintersection(sphere(1).shape, sphere(1).distance, sphere(1).point, 1.25, 10, 100000, 9);
    check_no_self_hit(sphere(1).shape, 1, 100000, 5);
    check_hostile_rays(sphere(1).shape);
}

TEST(Solids, box) {
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) check_all(box(scale));
    check_reintersection(box(1).shape, box(1).distance, box(1).point, 1.3, 10, 100000, 9);
    check_no_self_hit(box(1).shape, 1, 100000, 5);
    check_hostile_rays(box(1).shape);
}

TEST(Solids, cylinder) {
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) check_all(cylinder(0.7 * scale, 1.5 * scale));
    check_all(cylinder(1, 1e-3));
    check_all(cylinder(0.02, 1));
    check_reintersection(cylinder(1, 2).shape, cylinder(1, 2).distance, cylinder(1, 2).point, 2, 10, 100000, 9);
    check_no_self_hit(cylinder(1, 1).shape, 1, 100000, 5);
    check_hostile_rays(cylinder(1, 1).shape);
}

TEST(Solids, cone) {
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) {
        check_all(cone(scale, 0, scale));
        check_all(cone(0.3 * scale, 0.9 * scale, scale));
    }
    check_all(cone(1, 0, 5));
    check_all(cone(0, 1, 0.2));
    check_all(cone(1, 0.999999, 1));
    check_reintersection(cone(1, 0, 2).shape, cone(1, 0, 2).distance, cone(1, 0, 2).point, 2, 10, 100000, 9);
    check_no_self_hit(cone(1, 0.5, 1).shape, 1, 100000, 5);
    check_hostile_rays(cone(1, 0, 1).shape);
}

TEST(Solids, torus) {
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3, 1e6}) check_all(torus(scale, 0.25 * scale));
    check_all(torus(1, 1));       // horn
    check_all(torus(0.5, 1));     // spindle
    check_all(torus(1e-9, 1));    // nearly a sphere
    check_all(torus(0, 1));       // a sphere
    check_all(torus(1, 0.02));
    check_reintersection(torus(1, 0.25).shape, torus(1, 0.25).distance, torus(1, 0.25).point, 1.25, 10, 100000, 9);
    check_no_self_hit(torus(1, 0.25).shape, 1, 100000, 5, false);
    check_no_self_hit(torus(0.5, 1).shape, 1, 100000, 5, false);
    check_hostile_rays(torus(1, 0.25).shape);
    check_hostile_rays(torus(0, 0).shape);
}

}  // namespace
}  // namespace crescente::geometry::test
