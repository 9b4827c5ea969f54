// Where the rays of a camera go.
#include "render/camera_rays.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

void expect_point(Vec3 got, Vec3 expected, double tolerance = 1e-12) {
    EXPECT_NEAR(got.x, expected.x, tolerance);
    EXPECT_NEAR(got.y, expected.y, tolerance);
    EXPECT_NEAR(got.z, expected.z, tolerance);
}

TEST(Camera, OrthographicRaysAreParallel) {
    scene::Camera c;
    c.projection = scene::Projection::orthographic, c.height = 3, c.pixel_aspect = 1.5, c.near = 0.25;
    const CameraRays rays(c, 40, 20);
    for (const double x : {0.0, 13.0, 40.0}) {
        for (const double y : {0.0, 5.5, 20.0}) {
            const geometry::Ray ray = rays.through(x, y);
            expect_point(ray.direction, {0, 0, -1});
            // 20 pixels are 3 m high; a pixel is half as wide again as it is high.
            expect_point(ray.origin, {(x - 20) * 0.15 * 1.5, (10 - y) * 0.15, 5});
            EXPECT_DOUBLE_EQ(ray.t_min, 0.25);
        }
    }
}

TEST(Camera, PerspectiveRaysGoThroughThePictureInTheTargetPlane) {
    scene::Camera c;
    c.position = {1, 2, 3}, c.target = {1, 2, -7}, c.field_of_view = 2 * std::atan(0.3), c.pixel_aspect = 0.5, c.near = 2;
    const CameraRays rays(c, 40, 20);
    for (const double x : {0.0, 13.0, 40.0}) {
        for (const double y : {0.0, 5.5, 20.0}) {
            const geometry::Ray ray = rays.through(x, y);
            EXPECT_NEAR(length(ray.direction), 1, 1e-15);
            expect_point(ray.at(10 / -ray.direction.z), {1 + (x - 20) * 0.3 * 0.5, 2 + (10 - y) * 0.3, -7}, 1e-11);
            EXPECT_NEAR(ray.at(ray.t_min).z, 1, 1e-12) << "near is a plane";
        }
    }
}

TEST(Camera, UpTurnsThePicture) {
    scene::Camera c;
    c.up = {1, 0, 0};
    const CameraRays rays(c, 10, 10);
    EXPECT_GT(rays.through(5, 0).direction.x, 0.1);
    EXPECT_NEAR(rays.through(5, 0).direction.y, 0, 1e-12);
    EXPECT_GT(rays.through(10, 5).direction.y * -1, 0.1);
}

TEST(Camera, NearPlaneCutsOpen) {
    for (const auto projection : {scene::Projection::perspective, scene::Projection::orthographic}) {
        Build s(30, 30);
        s.camera().projection = projection, s.camera().near = 4.6;
        s.camera().height = 2.4, s.camera().field_of_view = 0.5;
        s.place(sphere(1), s.material(glow({1, 1, 1})));
        const scene::Image picture = finished(s.scene).picture(true);
        int inside = 0, seen = 0;
        for (int y = 0; y < 30; ++y) {
            for (int x = 0; x < 30; ++x) {
                const float depth = values(picture, "depth", x, y)[0];
                if (std::isinf(depth)) continue;
                EXPECT_GE(depth, 4.6f);
                ++seen;
                inside += depth > 5.0f;  // the far half, through the cut
            }
        }
        EXPECT_GT(inside, 100);
        EXPECT_GT(seen, inside);
    }
}

}  // namespace
}  // namespace crescente::render::testing
