#include "accel/box_hierarchy.h"

#include <gtest/gtest.h>

#include "accel/box_ray.h"
#include "accel/random_rays.h"

namespace crescente::accel::testing {
namespace {

bool contains(const Bounds& outer, const Bounds& inner) {
    return min(outer.lower, inner.lower) == outer.lower && max(outer.upper, inner.upper) == outer.upper;
}

// Every box is in exactly one leaf, every node's box holds what is below it, and no path exceeds max_depth.
void expect_sound(const BoxHierarchy& hierarchy, std::span<const Bounds> boxes) {
    ASSERT_EQ(hierarchy.nodes.empty(), boxes.empty());
    ASSERT_EQ(hierarchy.order.size(), boxes.size());
    std::vector<int> seen(boxes.size());
    for (const std::uint32_t i : hierarchy.order) ++seen.at(i);
    for (const int times : seen) ASSERT_EQ(times, 1);
    if (boxes.empty()) return;

    std::size_t placed = 0, visited = 0;
    std::vector<std::pair<std::uint32_t, int>> waiting{{0, 0}};
    while (!waiting.empty()) {
        const auto [index, depth] = waiting.back();
        waiting.pop_back();
        ++visited;
        ASSERT_LE(depth, BoxHierarchy::max_depth);
        const BoxNode& node = hierarchy.nodes.at(index);
        if (node.leaf()) {
            placed += node.count;
            for (std::uint32_t i = node.first; i < node.first + node.count; ++i) ASSERT_TRUE(contains(node.box, boxes[hierarchy.order.at(i)]));
        } else {
            for (const std::uint32_t child : {node.first, node.first + 1}) {
                ASSERT_GT(child, index);
                ASSERT_TRUE(contains(node.box, hierarchy.nodes.at(child).box));
                waiting.push_back({child, depth + 1});
            }
        }
    }
    EXPECT_EQ(placed, boxes.size());
    EXPECT_EQ(visited, hierarchy.nodes.size());
}

Bounds cube(Vec3 center, double half) { return {center - Vec3{half, half, half}, center + Vec3{half, half, half}}; }

TEST(BoxHierarchy, SoundForAnyNumberOfRandomBoxes) {
    Random random(1);
    for (std::size_t count : {0, 1, 2, 3, 5, 8, 13, 100, 1000, 20000}) {
        std::vector<Bounds> boxes;
        for (std::size_t i = 0; i < count; ++i) boxes.push_back(cube(random.in_cube(), std::pow(10.0, random.uniform(-6, -1))));
        expect_sound(build_box_hierarchy(boxes), boxes);
    }
}

TEST(BoxHierarchy, SoundForBoxesThatCannotBeToldApart) {
    const std::vector<Bounds> boxes(5000, cube({1, 2, 3}, 0.5));
    expect_sound(build_box_hierarchy(boxes), boxes);
    const std::vector<Bounds> points(5000, cube({1, 2, 3}, 0));
    expect_sound(build_box_hierarchy(points), points);
}

// Each twice as far out as the one before: bins separate only the last few.
TEST(BoxHierarchy, SoundWhereBinsSeparateLittle) {
    std::vector<Bounds> boxes;
    for (int i = 0; i < 600; ++i) {
        const double x = std::ldexp(1.0, i / 2 - 150);
        boxes.push_back(cube({x, i % 2 ? x : -x, 0}, x / 4));
    }
    expect_sound(build_box_hierarchy(boxes), boxes);
    for (int i = 0; i < 20000; ++i) boxes.push_back(cube({std::ldexp(1.0 + i * 1e-9, -150), 0, 0}, 0));
    expect_sound(build_box_hierarchy(boxes), boxes);
}

TEST(BoxHierarchy, SoundAtTheLargestCoordinates) {
    Random random(2);
    std::vector<Bounds> boxes;
    for (int i = 0; i < 1000; ++i) boxes.push_back(cube(random.in_cube(9e99), 1e90));
    expect_sound(build_box_hierarchy(boxes), boxes);
}

TEST(BoxHierarchy, RepeatsItself) {
    Random random(3);
    std::vector<Bounds> boxes;
    for (int i = 0; i < 3000; ++i) boxes.push_back(cube(random.in_cube(), 0.01));
    EXPECT_EQ(build_box_hierarchy(boxes).order, build_box_hierarchy(boxes).order);
}

// The tests of a box against points of the box that the ray passes: neither may miss one.
TEST(BoxRay, NeverMissesAPointOfTheBox) {
    Random random(4);
    for (int i = 0; i < 300000; ++i) {
        const double size = std::pow(10.0, random.uniform(-6, 3));
        Bounds box;
        box.include(random.in_cube(size));
        box.include(random.in_cube(size));
        if (random.chance(0.2)) box.upper[static_cast<int>(random.below(3))] = box.lower[0];
        if (box.empty()) continue;
        Vec3 target;  // in the box, often on its surface
        for (int k = 0; k < 3; ++k) {
            const double choice = random.uniform();
            target[k] = choice < 0.3 ? box.lower[k] : choice < 0.6 ? box.upper[k] : random.uniform(box.lower[k], box.upper[k]);
        }
        Vec3 direction = random.direction();
        if (random.chance(0.5)) direction[static_cast<int>(random.below(3))] = random.chance(0.5) ? 0.0 : -0.0;
        if (random.chance(0.2)) direction[static_cast<int>(random.below(3))] = random.chance(0.5) ? 0.0 : -0.0;
        if (direction == Vec3{}) continue;
        direction = normalize(direction);
        const double t = size * std::pow(10.0, random.uniform(-3, 3));
        Ray ray = ray_through(target - direction * t, direction);
        if (random.chance(0.3)) ray.t_max = t;
        if (random.chance(0.1)) ray.t_min = t;
        const double slack = 0x1p-40 * (max_component(abs(ray.origin)) + box.largest_coordinate());
        BoxRay box_ray(ray, slack);
        ASSERT_FALSE(box_ray.rejects(box)) << i;
        ASSERT_LE(box_ray.entry(box), t * (1 + 1e-9)) << i;
        box_ray.end_at(t);
        ASSERT_FALSE(box_ray.rejects(box)) << i;
        ASSERT_LE(box_ray.entry(box), t) << i;
    }
}

TEST(BoxRay, RejectsWhatIsBehindOrBeyond) {
    Ray ray = ray_through({0, 0, 0}, normalize({1, 1, -1}));
    BoxRay box_ray(ray, 1e-9);
    EXPECT_TRUE(box_ray.rejects(cube({-2, 2, -2}, 1)));
    EXPECT_TRUE(box_ray.rejects(cube({2, -2, -2}, 1)));
    EXPECT_TRUE(box_ray.rejects(cube({2, 2, 2}, 1)));
    EXPECT_FALSE(box_ray.rejects(cube({2, 2, -2}, 1)));
    box_ray.end_at(1);
    EXPECT_TRUE(box_ray.rejects(cube({2, 2, -2}, 1)));
    EXPECT_FALSE(box_ray.rejects(cube({0, 0, 0}, 1)));
}

TEST(BoxRay, EntersWhereTheSlabsBegin) {
    const Ray ray = ray_through({-3, 0.25, 0.25}, {1, 0, 0});
    const BoxRay box_ray(ray, 1e-9);
    EXPECT_NEAR(box_ray.entry({{0, 0, 0}, {1, 1, 1}}), 3, 1e-8);
    EXPECT_EQ(box_ray.entry({{0, 0.5, 0}, {1, 1, 1}}), BoxRay::missed);
    EXPECT_EQ(box_ray.entry({{-5, 0, 0}, {-4, 1, 1}}), BoxRay::missed);
    EXPECT_EQ(box_ray.entry({{-5, 0, 0}, {1, 1, 1}}), 0);
}

}  // namespace
}  // namespace crescente::accel::testing
