// Rays at the edges that faces share, of models whose faces do not quite meet: nothing passes between them, and what enters a solid leaves it.
#include <algorithm>

#include "geometry/brep_models.h"

namespace crescente::geometry::test {
namespace {

// The model with every face moved by up to a quarter of the gap, so that there are slits and overlaps at its edges. (Where surfaces meet at an angle their
// true intersection moves by more than the faces do.)
Model loosened(Model model, double gap, std::uint64_t seed) {
    Random random(seed);
    for (Face& face : model.faces) {
        const Vec3 by = random.direction() * (0.25 * gap * random.unit());
        std::visit([&](auto& surface) {
            if constexpr (std::is_same_v<std::remove_cvref_t<decltype(surface)>, PatchSurface>) {
                for (BezierPatch& patch : surface.patches) {
                    for (ControlPoint& p : patch.points) p.weighted += by * p.weight;
                }
                if (surface.revolved) surface.revolved->origin += by;
            } else {
                surface.frame.origin += by;
            }
        }, face.surface);
    }
    return model;
}

struct Tally {
    int rays = 0, lost = 0, odd = 0, out_of_turn = 0;
};

// The crossings of a ray, which starts outside or well inside and ends outside: they must come in turns of entering and leaving, and be
// at least one from inside.
void cross(const Brep& brep, const Ray& ray, bool inside, Tally& tally) {
    struct Crossing {
        double t;
        bool leaves;
    };
    std::vector<Crossing> crossings;
    for (const ShapeHit& hit : all_hits(brep, ray)) {
        crossings.push_back({hit.t, dot(brep.surface(hit.primitive, ray.at(hit.t)).normal, ray.direction) > 0});
    }
    std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) { return a.t < b.t; });
    // Patches overlap where they meet: the same crossing told twice, at parameters that differ by rounding.
    const auto same = [&](const Crossing& a, const Crossing& b) { return a.leaves == b.leaves && b.t - a.t <= 1e-12 * (1 + std::abs(b.t)); };
    crossings.erase(std::unique(crossings.begin(), crossings.end(), same), crossings.end());
    // Through an edge itself a ray enters and leaves at once, in either order.
    for (std::size_t i = 1; i < crossings.size(); ++i) {
        if (crossings[i].leaves != crossings[i - 1].leaves && crossings[i].t - crossings[i - 1].t <= 1e-9 * (1e-3 + crossings[i].t)) {
            crossings.erase(crossings.begin() + std::ptrdiff_t(i) - 1, crossings.begin() + std::ptrdiff_t(i) + 1);
            i = 0;
        }
    }
    ++tally.rays;
    tally.lost += inside && crossings.empty();
    tally.odd += crossings.size() % 2 != (inside ? 1u : 0u);
    bool in = inside, in_turn = true;
    for (const Crossing& c : crossings) {
        in_turn = in_turn && c.leaves == in;
        in = !in;
    }
    tally.out_of_turn += !in_turn;
}

class Edges : public ::testing::TestWithParam<double> {};  // gap in sizes

TEST_P(Edges, AimedRays) {
    const double gap = GetParam();
    const int count = std::getenv("CRESCENTE_MANY_RAYS") ? 100000 : 6000;
    int seed = 0;
    for (const bool patches : {false, true}) {
        for (const auto& [scale, origin] : {std::pair{1.0, Vec3{}}, std::pair{1e-3, Vec3{}}, std::pair{1e3, Vec3{1e6, -1e6, 1e6}}}) {
            const Placing place = placing(scale, origin, 77);
            const double band = scale * (gap + 1e-6);
            for (const Model& plain : patches ? patch_models(place, band) : models(place, band)) {
                if (plain.edges.empty()) continue;
                const Model model = loosened(plain, scale * gap, ++seed);
                const auto brep = Brep::make(model.faces);
                ASSERT_TRUE(brep) << brep.error().text();
                Random random(seed);
                Tally tally;
                Vec3 within;  // a point well inside
                do within = random.inside_cube();
                while (model.distance(exact(within)) > -0.05);
                for (int i = 0; i < count; ++i) {
                    const Vec3 on_edge = model.edges[random.bits() % model.edges.size()](i % 50 == 0 ? double(random.bits() % 2) : random.unit());
                    const Vec3 target = on_edge + random.inside_cube() * (i % 3 == 0 ? 0 : 2 * (gap + 1e-6));
                    const bool inside = i % 2;
                    Ray ray;
                    ray.origin = model.place.point(inside ? within : target + random.direction() * 6);
                    ray.direction = normalize(model.place.point(target) - ray.origin);
                    cross(*brep, ray, inside, tally);
                }
                // What is left: vertices, where three faces take turns, and faces meant to be tangent that stand off from each other like sheets.
                EXPECT_EQ(tally.lost, 0) << model.name;
                EXPECT_LE(tally.odd, count / 200) << model.name;
                EXPECT_LE(tally.out_of_turn, count / 200) << model.name;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Gaps, Edges, ::testing::Values(0, 1e-5, 1e-3), [](const auto& gap) { return "gap_" + std::to_string(gap.index); });

// Two boxes of one shell that lie against each other, flush on all sides: four faces meet at each edge of the seam. Which of them a ray from inside leaves by is a
// matter of rounding; that it leaves is not.
TEST(Edges, FourFacesAtAnEdge) {
    const int count = std::getenv("CRESCENTE_MANY_RAYS") ? 1000000 : 20000;
    for (const std::uint64_t turned : {0, 77, 78, 79}) {
        Model model{"two boxes", {}, {}, {}, placing(1, {}, turned), 1};
        const Vec3 lower{-1, -0.7, -0.4}, middle{1, 0, 0.6}, upper{1, 0.7, 0.6};
        add_box_faces(model, lower, middle, 1e-6);
        add_box_faces(model, {lower.x, middle.y, lower.z}, upper, 1e-6);
        const auto brep = Brep::make(model.faces);
        ASSERT_TRUE(brep) << brep.error().text();
        Random random(turned + 1);
        int lost = 0;
        for (int i = 0; i < count; ++i) {
            const Vec3 target = i % 2 ? Vec3{upper.x, middle.y, -0.4 + random.unit()} : Vec3{-1 + 2 * random.unit(), middle.y, upper.z};
            const double side = i % 4 < 2 ? 0.35 : -0.35;
            const Vec3 from{0.9 * random.unit() - 0.5, side * (i % 3 ? 1 : 0.01) * random.unit(), 0.5 * random.unit()};
            Ray ray;
            ray.origin = model.place.point(from);
            ray.direction = normalize(model.place.point(target) - ray.origin);
            lost += all_hits(*brep, ray).empty();
        }
        EXPECT_EQ(lost, 0) << turned;
    }
}

}  // namespace
}  // namespace crescente::geometry::test
