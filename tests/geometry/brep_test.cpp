// Trimmed faces against the closed form of the solids they bound: every hit lies on the solid's surface, and between hits a ray is inside and outside in turns.
#include "geometry/brep.h"

#include <algorithm>

#include "geometry/brep_models.h"

namespace crescente::geometry::test {
namespace {

std::vector<ShapeHit> sorted_hits(const Brep& brep, const Ray& ray) {
    std::vector<ShapeHit> hits;
    for (std::uint32_t part = 0; part < brep.parts(); ++part) {
        Ray rest = ray;
        while (const auto hit = brep.intersect(part, rest)) {
            EXPECT_TRUE(hit->t > rest.t_min && hit->t <= rest.t_max);
            EXPECT_EQ(hit->primitive, part);
            hits.push_back(*hit);
            rest.t_min = hit->t;
        }
    }
    std::sort(hits.begin(), hits.end(), [](const ShapeHit& a, const ShapeHit& b) { return a.t < b.t; });
    return hits;
}

Brep made(const Model& model) {
    auto brep = Brep::make(model.faces);
    EXPECT_TRUE(brep) << model.name << ": " << (brep ? "" : brep.error().text());
    return brep ? std::move(*brep) : Brep();
}

// In the units of the world.
L distance_at(const Model& model, Exact p) { return model.distance(model.place.back(p)) * model.place.scale; }

// One ray against the closed form. False, with a reason, if something is wrong.
::testing::AssertionResult agrees(const Model& model, const Brep& brep, const Ray& ray, double blur) {
    const std::vector<ShapeHit> hits = sorted_hits(brep, ray);
    const double size = model.size * model.place.scale, reach = length(ray.origin) + length(model.place.frame.origin) + size;
    for (const ShapeHit& hit : hits) {
        const L off = std::abs(distance_at(model, on_ray(ray, hit.t)));
        if (!(off <= 64 * eps * reach + blur)) return ::testing::AssertionFailure() << "hit off the surface by " << double(off) << " at t " << hit.t;
        const SurfacePoint point = brep.surface(hit.primitive, ray.at(hit.t));
        const L error = std::abs(distance_at(model, exact(point.position)));
        if (!(error <= point.error + 64 * eps * length(model.place.frame.origin) + blur)) {
            return ::testing::AssertionFailure() << "surface point off by " << double(error) << ", more than its error " << point.error;
        }
        if (!(std::abs(length(point.normal) - 1) < 8 * eps)) return ::testing::AssertionFailure() << "normal of length " << length(point.normal);
        const L step = 1e-4 * size;
        const Exact p = exact(point.position);
        const L out = distance_at(model, {p.x + step * point.normal.x, p.y + step * point.normal.y, p.z + step * point.normal.z});
        if (blur == 0 && !(std::abs(out / step - 1) < 1e-2)) return ::testing::AssertionFailure() << "normal does not lead out: " << double(out / step);
        // u and v mean what the face says.
        const Face face = brep.face(brep.face_of(hit.primitive));
        if (!(point.u >= face.u0 - 1e-3 && point.u <= face.u1 + 1e-3)) return ::testing::AssertionFailure() << "u " << point.u;
    }
    const double near = 256 * eps * reach + blur;
    bool inside = distance_at(model, exact(ray.origin)) < 0;
    double from = 0;
    const double end = (reach + length(ray.origin)) * 2 / length(ray.direction);
    for (std::size_t k = 0; k <= hits.size(); ++k) {
        const double to = k < hits.size() ? hits[k].t : end;
        for (int s = 1; s < 16; ++s) {
            const L value = distance_at(model, on_ray(ray, from + (to - from) * (s / 16.0L)));
            if (std::abs(value) > near && (value < 0) != inside) {
                return ::testing::AssertionFailure() << "between hits " << k << " of " << hits.size() << " the ray is " << (inside ? "outside" : "inside") << " by " << double(value);
            }
        }
        inside = !inside;
        from = to;
    }
    return ::testing::AssertionSuccess();
}

struct Setting {
    const char* name;
    double scale;
    Vec3 origin;
    std::uint64_t turned;
};
const Setting settings[] = {{"plain", 1, {}, 0}, {"turned", 1, {0.3, -0.2, 0.1}, 5}, {"far", 1, {1e6, -1e6, 1e6}, 6}, {"small", 1e-3, {}, 7}, {"large", 1e3, {100, 200, -300}, 8}};

class BrepModels : public ::testing::TestWithParam<Setting> {};

TEST_P(BrepModels, RandomRays) {
    const Setting& s = GetParam();
    for (const Model& model : models(placing(s.scale, s.origin, s.turned), 0)) {
        const Brep brep = made(model);
        Random random(11);
        int met = 0;
        for (int i = 0; i < 12000; ++i) {
            const Vec3 target = model.place.point(random.inside_cube() * 1.1), d = random.direction();
            const double away = model.size * s.scale * (i % 3 == 0 ? 0 : i % 3 == 1 ? 4 : 50);
            Ray ray;
            ray.origin = target - d * away;
            ray.direction = d * std::exp2(random.between(-8, 8));
            met += !sorted_hits(brep, ray).empty();
            ASSERT_TRUE(agrees(model, brep, ray, 0)) << model.name << ", ray " << i;
        }
        EXPECT_GT(met, 1000) << model.name;
    }
}

// Faces on rational patches. A patch is a little off the true circle in doubles, and neighbours among its leaves overlap: what lies within `blur` of the surface
// is not held against it, and hits that differ by rounding are one.
TEST_P(BrepModels, RandomRaysAtPatches) {
    const Setting& s = GetParam();
    const double band = 1e-9 * s.scale + 64 * eps * length(s.origin);
    for (const Model& model : patch_models(placing(s.scale, s.origin, s.turned), band)) {
        const Brep brep = made(model);
        Random random(12);
        int met = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3 target = model.place.point(random.inside_cube() * 1.1), d = random.direction();
            Ray ray;
            ray.origin = target - d * (model.size * s.scale * (i % 3 == 0 ? 0 : i % 3 == 1 ? 4 : 50));
            ray.direction = d * std::exp2(random.between(-8, 8));
            met += !sorted_hits(brep, ray).empty();
            ASSERT_TRUE(agrees(model, brep, ray, 8 * band)) << model.name << ", ray " << i;
        }
        EXPECT_GT(met, 1000) << model.name;
    }
}

// Symmetric places: through vertices of loops, along rows of cells, along axes and in planes of symmetry. Faces share edges exactly here, so what lies on an
// edge is found within the band of one unit in the last place or so.
TEST_P(BrepModels, SymmetricRays) {
    const Setting& s = GetParam();
    const double band = 1e-9 * s.scale + 64 * eps * length(s.origin);
    for (const Model& model : models(placing(s.scale, s.origin, s.turned), band)) {
        const Brep brep = made(model);
        for (int axis = 0; axis < 3; ++axis) {
            for (int i = -8; i <= 8; ++i) {
                for (int k = -8; k <= 8; ++k) {
                    Vec3 from, to;
                    from[axis] = -3, to[axis] = 3;
                    from[(axis + 1) % 3] = to[(axis + 1) % 3] = i / 8.0 + 0.001, from[(axis + 2) % 3] = to[(axis + 2) % 3] = k / 8.0 + 0.0013;
                    Ray ray;
                    ray.origin = model.place.point(from);
                    ray.direction = normalize(model.place.point(to) - ray.origin);
                    ASSERT_TRUE(agrees(model, brep, ray, 8 * band)) << model.name << ' ' << axis << ' ' << i << ' ' << k;
                }
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Places, BrepModels, ::testing::ValuesIn(settings), [](const auto& place) { return std::string(place.param.name); });

TEST(Brep, BoundsHoldEveryHit) {
    for (const Model& model : models(placing(1, {0.5, 0, 2}, 9), 1e-9)) {
        const Brep brep = made(model);
        Random random(3);
        for (int i = 0; i < 5000; ++i) {
            Ray ray;
            ray.origin = model.place.point(random.direction() * 5);
            ray.direction = model.place.point(random.inside_cube()) - ray.origin;
            for (const ShapeHit& hit : sorted_hits(brep, ray)) {
                const Vec3 p = ray.at(hit.t);
                const Bounds box = brep.part_bounds(hit.primitive);
                for (int axis = 0; axis < 3; ++axis) {
                    ASSERT_GE(p[axis], box.lower[axis] - 1e-14) << model.name;
                    ASSERT_LE(p[axis], box.upper[axis] + 1e-14) << model.name;
                }
            }
        }
    }
}

TEST(Brep, HostileRays) {
    for (const Model& model : models(placing(1), 1e-9)) check_hostile_rays(made(model));
}

TEST(Brep, FacesComeBack) {
    for (const Model& model : models(placing(1), 1e-7)) {
        const Brep first = made(model);
        std::vector<Face> faces;
        for (std::uint32_t i = 0; i < first.face_count(); ++i) faces.push_back(first.face(i));
        const auto second = Brep::make(faces);
        ASSERT_TRUE(second);
        for (std::uint32_t i = 0; i < first.face_count(); ++i) {
            EXPECT_EQ(faces[i].surface, model.faces[i].surface) << model.name;
            EXPECT_EQ(second->face(i), faces[i]) << model.name;
        }
    }
}

TEST(Brep, MemoryPerFace) {
    for (const Model& model : models(placing(1), 1e-7)) {
        const Brep brep = made(model);
        EXPECT_LE((brep.bytes() - sizeof brep) / brep.face_count(), 1024u) << model.name;
    }
}

// Derivatives against differences of positions; the normal against S_u x S_v; parameters against positions; bounds against samples.
TEST(AnalyticSurfaces, AgreeWithTheirParametrisation) {
    Random random(21);
    for (int i = 0; i < 3000; ++i) {
        Frame frame = placing(1, random.inside_cube() * 5, random.bits() | 1).frame;
        if (i % 2) frame.y = -frame.y;
        const double a = random.between(0.2, 2), b = random.between(0.2, 2);
        const FaceSurface kinds[] = {PlaneSurface{frame}, CylinderSurface{frame, a}, ConeSurface{frame, random.between(-1, 1), random.between(-1.5, 1.5)}, SphereSurface{frame, a}, TorusSurface{frame, a, b}};
        const FaceSurface& plain = kinds[i % 5];
        const auto surface = AnalyticSurface::make(plain);
        ASSERT_TRUE(surface);
        ASSERT_EQ(surface->plain(), plain);
        const bool sphere = i % 5 == 3;
        const double v_most = sphere ? 1.5 : pi;
        const Point2 p{random.between(-pi, pi), random.between(-v_most, v_most)};
        if (std::abs(surface->metric(p).uu) < 1e-4) continue;
        const double h = 1e-6;
        const auto difference = [&](Point2 d) { return (surface->position({p.u + d.u, p.v + d.v}) - surface->position({p.u - d.u, p.v - d.v})) / (2 * h); };
        const Vec3 su = surface->along_u(p), sv = surface->along_v(p), position = surface->position(p);
        ASSERT_LT(length(su - difference({h, 0})), 1e-7) << i;
        ASSERT_LT(length(sv - difference({0, h})), 1e-7) << i;
        ASSERT_NEAR(surface->metric(p).uu, dot(su, su), 1e-12);
        ASSERT_NEAR(surface->metric(p).vv, dot(sv, sv), 1e-12);
        ASSERT_NEAR(0, dot(su, sv), 1e-12);
        ASSERT_LT(length(surface->normal(p) - normalize(cross(su, sv))), 1e-11) << i;
        const Point2 again = surface->parameters(surface->to_local(position));
        ASSERT_NEAR(std::cos(again.u - p.u), i % 5 ? 1 : std::cos(again.u - p.u), 1e-9) << i;
        ASSERT_LT(length(surface->position(again) - position), 1e-12) << i;
        // From beside the surface: the foot, the side.
        const double off = random.between(-0.01, 0.01) * std::sqrt(std::min(surface->metric(p).uu, 1.0));
        const SurfacePoint foot = surface->nearest(position + surface->normal(p) * off);
        ASSERT_LT(length(foot.position - position), 1e-11) << i;
        ASSERT_LT(length(foot.normal - surface->normal(p)), 1e-9) << i;
        ASSERT_NEAR(surface->side(position + surface->normal(p) * off), off, 1e-12) << i;
        // Bounds and least steps of a range around p.
        const ParameterBox range{p.u - random.unit(), p.u + random.unit(), p.v - random.unit() * (v_most - std::abs(p.v)), p.v + random.unit() * (v_most - std::abs(p.v))};
        const Bounds box = surface->bounds(range);
        const Point2 least = surface->least_steps(range);
        Bounds sampled;
        for (int k = 0; k < 41 * 41; ++k) {
            const Point2 q{range.u0 + (range.u1 - range.u0) * (k % 41) / 40, range.v0 + (range.v1 - range.v0) * (k / 41) / 40};
            sampled.include(surface->position(q));
            ASSERT_GE(std::sqrt(surface->metric(q).uu), least.u * (1 - 1e-12));
            ASSERT_GE(std::sqrt(surface->metric(q).vv), least.v * (1 - 1e-12));
        }
        for (int axis = 0; axis < 3; ++axis) {
            ASSERT_LE(box.lower[axis], sampled.lower[axis] + 1e-12) << i;
            ASSERT_GE(box.upper[axis], sampled.upper[axis] - 1e-12) << i;
            ASSERT_NEAR(box.lower[axis], sampled.lower[axis], 0.02) << i;
            ASSERT_NEAR(box.upper[axis], sampled.upper[axis], 0.02) << i;
        }
    }
}

// Both sheets of a spindle torus, and both nappes of a cone, against exhaustive sampling of the implicit surface along the ray.
TEST(AnalyticSurfaces, EverySheetIsMet) {
    Random random(22);
    int meetings = 0;
    for (int i = 0; i < 4000; ++i) {
        const Frame frame = placing(1, random.inside_cube(), random.bits() | 1).frame;
        const bool cone = i % 2;
        const double major = random.between(0, 0.8), minor = random.between(0.8, 1.2), radius = random.between(-0.5, 0.5), angle = random.between(-1.2, 1.2);
        const auto surface = AnalyticSurface::make(cone ? FaceSurface(ConeSurface{frame, radius, angle}) : FaceSurface(TorusSurface{frame, major, minor}));
        ASSERT_TRUE(surface);
        Ray ray;
        ray.origin = frame.origin + random.direction() * 3;
        ray.direction = normalize(frame.origin + random.inside_cube() - ray.origin);
        const auto implicit = [&](double t) -> L {  // product over the sheets
            const Exact p = on_ray(ray, t);
            const L x = p.x - frame.origin.x, y = p.y - frame.origin.y, z = p.z - frame.origin.z;
            const auto along = [&](Vec3 a) { return x * a.x + y * a.y + z * a.z; };
            const L rho = length2(along(frame.x), along(frame.y)), h = along(frame.z);
            if (cone) return rho * rho - (radius + h * std::tan((L)angle)) * (radius + h * std::tan((L)angle));
            return (length2(rho - major, h) - minor) * (length2(rho + major, h) - minor);
        };
        int changes = 0;
        constexpr int samples = 3000;
        for (int k = 0; k < samples; ++k) changes += (implicit(6.0 * k / samples) < 0) != (implicit(6.0 * (k + 1) / samples) < 0);
        Meeting found[AnalyticSurface::most_meetings];
        ray.t_max = 6;
        const int count = surface->meet(ray, found);
        ASSERT_GE(count, changes) << i;
        ASSERT_EQ((count - changes) % 2, 0) << i;
        for (int k = 0; k < count; ++k) {
            meetings += 1;
            ASSERT_LT(std::abs(implicit(found[k].t)), 1e-11) << i;
            ASSERT_TRUE(k == 0 || found[k].t >= found[k - 1].t);
            ASSERT_LT(length(surface->position(surface->parameters(found[k].local)) - ray.at(found[k].t)), 1e-9) << i;
        }
    }
    EXPECT_GT(meetings, 4000);
}

TEST(Brep, TellsEveryBadFace) {
    std::vector<Face> faces = box_model(placing(1), 0).faces;
    std::get<PlaneSurface>(faces[1].surface).frame.x = {2, 0, 0};
    faces[3].loops[0].erase(faces[3].loops[0].begin());
    std::get<LinePiece>(faces[4].loops[0][2].piece).to.u = std::nan("");
    std::vector<FaceProblem> problems;
    const Brep brep(faces, problems);
    EXPECT_EQ(brep.face_count(), 3u);
    ASSERT_EQ(problems.size(), 3u);
    EXPECT_EQ(problems[0].face, 1u);
    EXPECT_NE(problems[0].reason.find("orthonormal"), std::string::npos) << problems[0].reason;
    EXPECT_EQ(problems[1].face, 3u);
    EXPECT_NE(problems[1].reason.find("does not end where"), std::string::npos) << problems[1].reason;
    EXPECT_EQ(problems[2].face, 4u);
    EXPECT_NE(problems[2].reason.find("not finite"), std::string::npos) << problems[2].reason;
    const auto none = Brep::make(faces);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().problems.size(), 3u);
}

}  // namespace
}  // namespace crescente::geometry::test
