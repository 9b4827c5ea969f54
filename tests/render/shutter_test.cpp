// While the shutter is open: what moves is blurred by as much as it moves.
#include <cmath>

#include "render/blocks.h"

namespace crescente::render::testing {
namespace {

using scene::Scene;

// A board of radiance 1 whose right edge is at x = 0, seen in parallel: 16 pixels of 1/8 m.
Build board(int samples) {
    Build b(16, 16);
    b.camera().projection = scene::Projection::orthographic, b.camera().height = 2;
    b.camera().position = {0, 0, 4}, b.camera().target = {0, 0, 0};
    b.settings().level = scene::Level::soft, b.settings().samples = samples, b.settings().noise = 0.0001;
    PhysicalMaterial shining;
    shining.base_color = {}, shining.emissive = gray(1), shining.ior = 1;
    b.place(box({-9, -9, -0.1}, {0, 9, 0}), b.material(shining));
    return b;
}

// Of a board whose edge goes from `from` to `to`, at even pace: the share of the time that a column of pixels is covered, in the mean over its width.
double covered(double left, double right, double from, double to) {
    double sum = 0;
    constexpr int steps = 1000;
    for (int i = 0; i < steps; ++i) {
        const double x = left + (right - left) * (i + 0.5) / steps;
        sum += std::clamp((to - x) / (to - from), 0.0, 1.0);
    }
    return sum / steps;
}

void expect_moved_edge(const Scene& scene, double from, double to) {
    const scene::Image image = picture_of(scene);
    for (int x = 0; x < 16; ++x) {
        double column = 0;
        for (int y = 0; y < 16; ++y) column += pixel(image, x, y).g / 16;
        EXPECT_NEAR(column, covered(x / 8.0 - 1, (x + 1) / 8.0 - 1, from, to), 0.02) << x;
    }
}

TEST(Shutter, CoverageByAMovingEdgeIsLinearInTime) {
    Build b = board(64);
    b.scene.nodes[0].motion = at({0.8, 0, 0});
    expect_moved_edge(b.scene, 0, 0.8);
    b.camera().shutter_open = 0.25, b.camera().shutter_close = 0.75;
    expect_moved_edge(b.scene, 0.2, 0.6);
}

TEST(Shutter, CoverageSeenByAMovingCamera) {
    Build b = board(64);
    b.camera().travel = b.camera().target_travel = {-0.8, 0, 0};
    expect_moved_edge(b.scene, 0, 0.8);
}

// A pinhole at the shutter's opening, for levels that do not sample.
TEST(Shutter, OtherLevelsShowTheOpening) {
    Build b = board(1);
    b.settings().level = scene::Level::edges;
    b.scene.nodes[0].motion = at({0.8, 0, 0});
    b.camera().travel = b.camera().target_travel = {0.2, 0, 0};
    b.camera().shutter_open = 0.5;
    const scene::Image opening = finished(b.scene).picture(true);
    b.scene.nodes[0].motion.reset(), b.scene.nodes[0].transform = at({0.4, 0, 0});
    b.camera().travel = b.camera().target_travel = {};
    b.camera().position.x = b.camera().target.x = 0.1;
    EXPECT_TRUE(same_picture(finished(b.scene).picture(true), opening));
}

// The same picture, within noise, whether the camera moves or everything moves the other way; light of what moves included.
TEST(Shutter, MovingCameraOrMovingWorld) {
    Build b(24, 24);
    b.settings().level = scene::Level::indirect, b.settings().samples = 128, b.settings().noise = 0.0001;
    b.camera().position = {0, 1, 5}, b.camera().target = {0, 0.3, 0}, b.camera().aperture = 0.05;
    PhysicalMaterial lamp;
    lamp.emissive = gray(5);
    b.place(box({-2, -0.1, -2}, {2, 0, 2}), b.material(matte({0.6f, 0.5f, 0.4f})));
    b.place(sphere(0.5), b.material(mirror(gray(0.8f))), at({-0.6, 0.5, 0}));
    b.place(sphere(0.3), b.material(lamp), at({0.7, 0.6, 0}));
    const Vec3 travel{0.6, 0.1, 0.2};
    Scene moving_camera = b.scene, moving_world = b.scene;
    moving_camera.camera->travel = moving_camera.camera->target_travel = travel;
    for (scene::Node& node : moving_world.nodes) node.motion = at(-travel);
    const scene::Image a = picture_of(moving_camera), c = picture_of(moving_world), still = picture_of(b.scene);
    const BlockDifference difference = block_difference(a, c, 6);
    EXPECT_LT(difference.absolute, 0.03 * difference.mean);
    EXPECT_GT(block_difference(a, still, 6).absolute, 0.06 * difference.mean);
}

// A body that turns about its own axis stays where it is; a group carries what is in it along.
TEST(Shutter, MotionIsInTheObjectsSpace) {
    Build b(32, 32);
    b.settings().level = scene::Level::soft, b.settings().samples = 32, b.settings().noise = 0.0001;
    b.camera().position = {0, 0, 6};
    PhysicalMaterial shining;
    shining.base_color = {}, shining.emissive = gray(1), shining.ior = 1;
    const NodeId round = b.node({"", at({1, 0, 0}) * Affine::rotation({0, 0, 1}, 0.4), b.shape(sphere(0.5)), {b.material(shining)}, {}, true});
    const NodeId group = b.node({"", {}, {}, {}, {round}, true});
    b.scene.roots = {group};
    const scene::Image still = picture_of(b.scene);
    b.scene.nodes[round.value].motion = Affine::rotation({0.3, 1, 0.2}, 2);
    EXPECT_LT(mean_difference(picture_of(b.scene), still), 0.01);
    b.scene.nodes[round.value].motion.reset();
    b.scene.nodes[group.value].motion = Affine::rotation({0, 0, 1}, 1.5);
    const scene::Image turned = picture_of(b.scene);
    EXPECT_GT(mean_difference(turned, still), 0.02);
    EXPECT_GT(pixel(turned, 24, 12).g, 0.2);  // on the arc, above where it was
}

TEST(Shutter, EditsOfMotion) {
    Scene scene = instances();
    scene.settings.width = 40, scene.settings.height = 30;
    scene.settings.level = scene::Level::soft, scene.settings.samples = 4;
    Session session = finished(scene);
    const auto expect_fresh = [&] {
        session.advance(Deadline::never());
        EXPECT_TRUE(same_picture(finished(scene).picture(true), session.picture(true)));
    };
    scene.nodes[5].motion = at({0.5, 0, 0});
    ASSERT_TRUE(session.edit({scene::SetNode{{5}, scene.nodes[5]}}));
    expect_fresh();
    scene.nodes[5].motion = at({0.5, 0.3, 0});
    scene.nodes[2].motion = Affine::rotation({0, 1, 0}, 1);
    ASSERT_TRUE(session.edit({scene::SetNode{{5}, scene.nodes[5]}, scene::SetNode{{2}, scene.nodes[2]}}));
    expect_fresh();
    scene.camera->shutter_close = 0;
    ASSERT_TRUE(session.edit({scene::SetCamera{scene.camera}}));
    expect_fresh();
}

}  // namespace
}  // namespace crescente::render::testing
