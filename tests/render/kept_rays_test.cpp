// Rays that are kept, tried again: they are the rays that were traced, to the bit, and boxes turn away only those that meet nothing.
#include "render/growth.h"
#include "render/instance_group.h"
#include "render/level.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

Bounds box_between(Vec3 a, Vec3 b) {
    Bounds box;
    box.include(a), box.include(b);
    return box;
}
Bounds at_point(Vec3 p) { return {p, p}; }

bool samples_pass(const Bounds& box, Vec3 start, Vec3 way, double end) {
    constexpr int steps = 400;
    for (int i = 0; i <= steps; ++i) {
        const Vec3 p = start + way * (end * i / steps);
        if (max(box.lower, min(p, box.upper)) == p) return true;
    }
    return false;
}

TEST(Bundles, NoneThatPassesABoxIsTurnedAway) {
    Random random(1);
    int passed = 0, turned_away = 0;
    for (int round = 0; round < 2000; ++round) {
        const Bounds box = box_between(random.in_cube(3), random.in_cube(3));
        StretchLanes eight{};
        Bounds starts, ends, directions;
        for (int i = 0; i < lane_count; ++i) {
            const Vec3 start = random.in_cube(3), way = random.in_cube(round % 2 ? 4 : 0.5);
            set_lane(eight.start, i, start), set_lane(eight.way, i, way);
            starts.include(start), ends.include(start + way), directions.include(way);
        }
        for (const bool endless : {false, true}) {
            eight.endless = endless ? 0xff : 0;
            const unsigned lanes = may_pass(box, eight);
            const bool together = may_pass(box, endless ? toward(starts, directions) : between(starts, ends));
            for (int i = 0; i < lane_count; ++i) {
                const Vec3 start = lane(eight.start, i), way = lane(eight.way, i);
                const bool alone = may_pass(box, endless ? toward(at_point(start), at_point(way)) : between(at_point(start), at_point(start + way)));
                EXPECT_EQ(alone, (lanes >> i & 1) != 0) << "the two tests of single stretches are exact";
                if (samples_pass(box, start, way, endless ? 40 : 1)) {
                    EXPECT_TRUE(alone && together);
                    ++passed;
                }
                turned_away += !alone;
            }
        }
    }
    EXPECT_GT(passed, 1000);
    EXPECT_GT(turned_away, 1000);
}

TEST(InstanceGroups, MeetWhatTheOracleMeets) {
    Random random(2);
    const geometry::Shape ball = sphere(0.1);
    std::vector<accel::Instance> instances;
    std::vector<Bounds> boxes;
    for (int i = 0; i < 100; ++i) {
        instances.emplace_back(ball, at(random.in_cube(2)), i % 2 == 0);
        boxes.push_back(transform(instances.back().to_world, geometry::bounds(ball)));
    }
    const std::vector<accel::Instance> copy = instances;
    const auto oracle = accel::make_linear(copy);
    auto alone = accel::make_embree(instances);
    ASSERT_TRUE(alone);
    const InstanceGroup group(boxes, std::move(instances), std::move(*alone)), unknown(boxes, {}, nullptr);
    std::vector<geometry::Ray> rays;
    for (int i = 0; i < 4000; ++i) {
        geometry::Ray& ray = rays.emplace_back();
        ray.origin = random.in_cube(3), ray.direction = random.direction(), ray.t_max = random.uniform(0.5, 6);
    }
    accel::TestCounts tests;
    std::vector<accel::Hit> hits(rays.size()), occluders(rays.size());
    std::vector<accel::Crossing> crossings;
    oracle->nearest(rays, hits, accel::Coherence::coherent, tests);
    oracle->shadow(rays, occluders, crossings, accel::Coherence::coherent, tests);
    std::vector<bool> crosses(rays.size());
    for (const accel::Crossing& c : crossings) crosses[c.ray] = true;
    std::vector<Meeting> eye, light, unsure;
    group.meet(rays, eye, tests), group.meet_light(rays, light, tests), unknown.meet(rays, unsure, tests);
    int met = 0, turned_away = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        const Bundle way = between(at_point(rays[i].origin), at_point(rays[i].at(rays[i].t_max)));
        EXPECT_EQ(eye[i] != Meeting::nothing, hits[i].found());
        EXPECT_EQ(light[i], occluders[i].found() ? Meeting::occluder : crosses[i] ? Meeting::something : Meeting::nothing);
        EXPECT_EQ(unsure[i], Meeting::something);
        EXPECT_TRUE(group.may_meet(way) || !hits[i].found());
        met += hits[i].found();
        turned_away += !group.may_meet(way);
    }
    EXPECT_GT(met, 100);
    EXPECT_GT(turned_away, 100);
}

// Every ray of a tile grown to the end, made again from its nodes, finds what it found.
TEST(KeptRays, AreThoseThatWereTraced) {
    scene::Scene scene = still_life();
    scene.settings.tile = 75;
    for (scene::Material& m : scene.materials) {  // with media, shares are not of the crossings alone
        if (auto* classic = std::get_if<ClassicMaterial>(&m.model)) classic->attenuation = {};
    }
    const auto world = world_of(std::move(scene)).value();
    const scene::Settings& settings = world->scene.settings;
    Tile tile;
    tile.width = settings.width, tile.height = settings.height;
    Growth growth(*world, tile, false);
    for (const LevelKind& kind : levels()) {
        for (const Stage& stage : kind.stages(settings)) {
            ASSERT_TRUE(kind.advance(growth, stage, Deadline::never()));
            tile.cursor = 0, ++tile.stage;
        }
    }
    accel::TestCounts tests;
    std::vector<std::uint32_t> children, lit;
    std::vector<Pending> ways;
    for (std::uint32_t i = 0; i < tile.nodes.size(); ++i) {
        const Node& node = tile.nodes[i];
        if (!node.left_scene()) lit.push_back(i);
        if (node.parent == no_node) continue;
        const Node& parent = tile.nodes[node.parent];
        children.push_back(i);
        ways.push_back({node.parent, {}, 0, parent.reflected == i ? Way::reflected : parent.refracted == i ? Way::refracted : Way::straight});
    }
    ASSERT_GT(children.size(), 1000u);
    const auto rays = growth.child_rays(ways);
    std::vector<accel::Hit> hits(rays.size());
    world->accelerator->nearest(rays, hits, accel::Coherence::incoherent, tests);
    for (std::size_t k = 0; k < children.size(); ++k) {
        const Node& node = tile.nodes[children[k]];
        ASSERT_EQ(hits[k].found(), !node.left_scene());
        if (node.left_scene()) ASSERT_EQ(rays[k].direction, node.position);
        else ASSERT_TRUE(hits[k].instance == node.instance && hits[k].primitive == node.primitive);
    }
    std::size_t tried = 0;
    for (std::size_t l = 0; l < world->lights.size(); ++l) {
        const auto to_light = growth.shadow_rays(lit, l);
        std::vector<accel::Hit> occluders(lit.size());
        std::vector<accel::Crossing> crossings;
        world->accelerator->shadow(to_light, occluders, crossings, accel::Coherence::coherent, tests);
        std::vector<bool> crosses(lit.size());
        for (const accel::Crossing& c : crossings) crosses[c.ray] = true;
        for (std::size_t k = 0; k < lit.size(); ++k) {
            const Share share = tile.shares[lit[k] * world->lights.size() + l];
            if (share == Share::untried || share == Share::behind) continue;
            ++tried;
            if (occluders[k].found()) ASSERT_EQ(share, Share::blocked);
            else if (!crosses[k]) ASSERT_EQ(share, Share::clear);
            else ASSERT_NE(share, Share::clear);
        }
    }
    EXPECT_GT(tried, 1000u);
}

}  // namespace
}  // namespace crescente::render::testing
