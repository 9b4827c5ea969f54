// What every shape is held to, written once. The true surface is a signed distance in long double, written for the test.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "geometry/ray.h"
#include "geometry/shape.h"
#include "math/transform.h"

namespace crescente::geometry::test {

// Numbers that depend on the seed and the position in the sequence only (SplitMix64; Steele, Lea, Flood 2014).
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u) {}
    std::uint64_t bits() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    double between(double a, double b) { return a + (b - a) * unit(); }
    Vec3 inside_cube() {
        const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
        return {x, y, z};
    }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = inside_cube();
            const double l = length(v);
            if (l > 0.05 && l <= 1) return v / l;
        }
    }

private:
    std::uint64_t state_;
};

struct Exact {
    long double x, y, z;
};
inline Exact exact(Vec3 v) { return {v.x, v.y, v.z}; }
inline Exact on_ray(const Ray& r, long double t) {
    return {r.origin.x + t * r.direction.x, r.origin.y + t * r.direction.y, r.origin.z + t * r.direction.z};
}
inline long double distance(Exact a, Exact b) {
    return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

using SignedDistance = std::function<long double(Exact)>;  // negative inside; near the surface the distance, elsewhere any bound

constexpr double eps = std::numeric_limits<double>::epsilon();

template <class Shape>
std::vector<ShapeHit> all_hits(const Shape& shape, Ray ray) {
    std::vector<ShapeHit> hits;
    for (std::uint32_t part = 0; part < shape.parts(); ++part) {
        Ray rest = ray;
        while (const auto hit = shape.intersect(part, rest)) {
            hits.push_back(*hit);
            rest.t_min = hit->t;
            if (hits.size() > 64) break;
        }
    }
    return hits;
}

// Every hit lies on the true surface as exactly as the ray's own numbers allow, surface() brings it nearer and tells its error
// truly, and the normal is the gradient of the distance.
template <class Shape>
void check_hits(const Shape& shape, const SignedDistance& true_distance, const Ray& ray, double size, bool check_normal = true) {
    for (const ShapeHit& hit : all_hits(shape, ray)) {
        const double reach = length(ray.origin) + size;
        const long double off = std::abs(true_distance(on_ray(ray, hit.t)));
        ASSERT_LE(off, 16 * eps * reach) << "hit off the surface, t " << hit.t;
        const SurfacePoint point = shape.surface(hit.primitive, ray.at(hit.t));
        ASSERT_LE(std::abs(true_distance(exact(point.position))), point.error);
        ASSERT_LE(point.error, 64 * eps * size);
        ASSERT_LE(distance(exact(point.position), on_ray(ray, hit.t)), 32 * eps * reach);
        ASSERT_NEAR(length(point.normal), 1, 4 * eps);
        ASSERT_EQ(point.normal, point.shading_normal);
        ASSERT_TRUE(std::isfinite(point.u) && std::isfinite(point.v));
        // A step along the normal leaves the solid by that step.
        if (check_normal) {
            const double step = 1e-5 * size;
            const long double out = true_distance(exact(point.position + point.normal * step));
            ASSERT_NEAR(static_cast<double>(out / step), 1.0, 1e-3);
        }
    }
}

// Aims rays at points of the surface, from `away` (in sizes): each must hit there.
template <class Shape>
void check_reintersection(const Shape& shape, const SignedDistance& true_distance, const std::function<Exact(Random&)>& sample, double size,
                          double away, int count, std::uint64_t seed) {
    Random random(seed);
    int grazing = 0;
    for (int i = 0; i < count; ++i) {
        const Exact target = sample(random);
        const Vec3 d = random.direction();
        const double far = away * size * random.between(0.5, 1), stretch = std::exp2(random.between(-12, 12));
        Ray ray;
        const auto before = [far](long double target_coordinate, long double d_coordinate) {
            return static_cast<double>(target_coordinate - far * d_coordinate);
        };
        ray.origin = {before(target.x, d.x), before(target.y, d.y), before(target.z, d.z)};
        ray.direction = d * stretch;
        const double h = 1e-7 * size;
        const auto at = [&](long double s) { return true_distance({target.x + s * d.x, target.y + s * d.y, target.z + s * d.z}); };
        const double incidence = static_cast<double>(std::abs(at(h) - at(-h)) / (2 * h));  // cosine to the normal
        if (incidence < 0.02) {
            ++grazing;
            continue;
        }
        const double tolerance = 64 * eps * (far + size) / incidence;
        double nearest = HUGE_VAL;
        for (const ShapeHit& hit : all_hits(shape, ray)) {
            if (std::abs(hit.t * stretch - far) < std::abs(nearest * stretch - far)) nearest = hit.t;
        }
        ASSERT_NEAR(nearest * stretch, far, tolerance)
            << "ray " << i << " incidence " << incidence << " at " << double(target.x) << ' ' << double(target.y) << ' ' << double(target.z);
        check_hits(shape, true_distance, ray, size, false);
        if (::testing::Test::HasFatalFailure()) return;
    }
    ASSERT_LT(grazing, count / 4);
}

// Lines through the neighbourhood of the shape against dense sampling of the true distance: every change of sign is a hit, hits
// and the samples' signs alternate, and a closed shape is crossed an even number of times from outside, odd from inside.
template <class Shape>
void check_oracle(const Shape& shape, const SignedDistance& true_distance, double size, Vec3 center, double away, int count,
                  std::uint64_t seed, int samples = 400) {
    Random random(seed);
    int met = 0;
    for (int i = 0; i < count; ++i) {
        Ray ray;
        const Vec3 d = random.direction();
        Vec3 target = center + random.inside_cube() * (size * 0.7);
        Vec3 used = d;
        if (i % 8 == 1) used = {0, d.y > 0 ? 1.0 : -1.0, 0};
        if (i % 8 == 2) used = {d.x > 0 ? 1.0 : -1.0, 0, 0};
        if (i % 8 == 3) used = normalize(Vec3{d.x, 0, d.z});
        if (i % 8 == 4) used = normalize(Vec3{d.x * 1e-7, d.y, 1e-9 * d.z});
        if (i % 8 == 5) target = {0, target.y, 0};  // through the axis
        const double far = away * size, stretch = std::exp2(random.between(-12, 12));
        ray.origin = target - used * far;
        ray.direction = used * stretch;
        const double middle = far / stretch, half = 2.5 * size / stretch;
        const auto f = [&](long double t) { return true_distance(on_ray(ray, t)); };
        const std::vector<ShapeHit> hits = all_hits(shape, ray);
        met += !hits.empty();
        ASSERT_EQ(hits.size() % 2, f(0) < 0 ? 1u : 0u) << "ray " << i;
        check_hits(shape, true_distance, ray, size, false);
        if (::testing::Test::HasFatalFailure()) return;

        const double blur = 64 * eps * (far + size);  // of a position on the ray, as a distance
        bool inside = f(0) < 0;
        double from = 0;
        for (std::size_t k = 0; k <= hits.size(); ++k) {
            const double to = k < hits.size() ? hits[k].t : middle + half;
            for (int s = 1; s < 10; ++s) {
                const long double value = f(from + (to - from) * (s / 10.0L));
                if (std::abs(value) > blur) {
                    ASSERT_EQ(value < 0, inside) << "ray " << i << " between hits " << k;
                }
            }
            inside = !inside;
            from = to;
        }
        long double before = f(std::max(0.0, middle - half));
        for (int s = 1; s <= samples; ++s) {
            const long double t0 = std::max(0.0L, middle - half + 2 * half * (long double)(s - 1) / samples);
            const long double t1 = std::max(0.0L, middle - half + 2 * half * (long double)s / samples);
            const long double after = f(t1);
            if ((before < 0) != (after < 0) && std::abs(before) > blur && std::abs(after) > blur) {
                bool found = false;
                for (const ShapeHit& hit : hits) found |= hit.t >= t0 && hit.t <= t1;
                ASSERT_TRUE(found) << "ray " << i << ": no hit in [" << double(t0) << ", " << double(t1) << "]";
            }
            before = after;
        }
    }
    ASSERT_GT(met, count / 100);  // the test met the shape
}

// A hit carried through a transform is where the world ray says, at the same t.
template <class Shape>
void check_transformed(const Shape& shape, double size, int count, std::uint64_t seed) {
    Random random(seed);
    int met = 0;
    for (int i = 0; i < count; ++i) {
        const Affine turn = Affine::rotation(random.direction(), random.between(0, 6));
        const Affine stretch = Affine::scaling({random.between(0.2, 3), random.between(0.2, 3), random.between(0.2, 3)});
        const Affine to_world = Affine::translation(random.inside_cube() * (3 * size)) * turn * stretch;
        const Affine to_local = inverse(to_world);
        Ray world;
        world.origin = random.direction() * (20 * size);
        world.direction = normalize(to_world.point(random.inside_cube() * size) - world.origin);
        Ray local = world;
        local.origin = to_local.point(world.origin), local.direction = to_local.vector(world.direction);
        for (const ShapeHit& hit : all_hits(shape, local)) {
            ++met;
            const SurfacePoint point = shape.surface(hit.primitive, local.at(hit.t));
            ASSERT_LE(length(to_world.point(point.position) - world.at(hit.t)), 1e-12 * 20 * size);
            const Bounds box = transform(to_world, shape.bounds());
            if (!box.bounded()) continue;
            for (int axis = 0; axis < 3; ++axis) {
                ASSERT_GE(world.at(hit.t)[axis], box.lower[axis] - 1e-12 * 20 * size);
                ASSERT_LE(world.at(hit.t)[axis], box.upper[axis] + 1e-12 * 20 * size);
            }
        }
    }
    ASSERT_GT(met, count / 100);
}

// A ray that leaves a solid from a little more than the error bound above the hit starts outside: it enters as often as it leaves, and a
// convex solid never.
template <class Shape>
void check_no_self_hit(const Shape& shape, double size, int count, std::uint64_t seed, bool convex = true) {
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        Ray ray;
        ray.origin = random.direction() * (5 * size);
        ray.direction = random.inside_cube() * (0.5 * size) - ray.origin;
        const auto hit = shape.intersect(0, ray);
        if (!hit) continue;
        const SurfacePoint point = shape.surface(hit->primitive, ray.at(hit->t));
        Ray leaving;
        leaving.origin = point.position + point.normal * (2 * point.error);
        leaving.direction = random.direction();
        if (dot(leaving.direction, point.normal) < 0) leaving.direction = -leaving.direction;
        const std::size_t hits = all_hits(shape, leaving).size();
        ASSERT_TRUE(hits == 0 || (!convex && hits % 2 == 0)) << i;
    }
}

// Nothing that can be asked of a shape makes it crash or answer with a parameter out of reach.
template <class Shape>
void check_hostile_rays(const Shape& shape) {
    const double values[] = {0.0, -0.0, 1.0, -1.0, 1e-320, 1e-200, 1e200, 1e308, HUGE_VAL, -HUGE_VAL, std::nan("")};
    Random random(77);
    const auto any = [&] { return values[random.bits() % std::size(values)]; };
    for (int i = 0; i < 20000; ++i) {
        const double ox = any(), oy = any(), oz = any(), dx = any(), dy = any(), dz = any();
        const Ray ray{{ox, oy, oz}, {dx, dy, dz}, 0, i % 2 ? 10.0 : HUGE_VAL};
        for (std::uint32_t part = 0; part < shape.parts(); ++part) {
            const auto hit = shape.intersect(part, ray);
            if (hit) {
                ASSERT_TRUE(hit->t > ray.t_min && hit->t <= ray.t_max && std::isfinite(hit->t));
                (void)shape.surface(hit->primitive, ray.at(hit->t));
            }
        }
    }
}

}  // namespace crescente::geometry::test
