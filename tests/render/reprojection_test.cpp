// Camera moves: the new view begins with the old picture as far as it is seen from there.
#include "render/camera_rays.h"
#include "render/reprojection.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

TEST(CameraRays, ProjectUndoesThrough) {
    Random random(4);
    for (const auto projection : {scene::Projection::perspective, scene::Projection::orthographic}) {
        scene::Camera camera;
        camera.projection = projection, camera.position = {1, 2, 3}, camera.target = {-2, 0.5, -1}, camera.pixel_aspect = 1.25;
        const CameraRays rays(camera, 160, 90);
        for (int i = 0; i < 200; ++i) {
            const double x = random.uniform(-20, 180), y = random.uniform(-20, 110), t = random.uniform(0.1, 50);
            const geometry::Ray ray = rays.through(x, y);
            const auto seen = rays.project(ray.origin + ray.direction * t);
            ASSERT_TRUE(seen);
            EXPECT_NEAR(seen->x, x, 1e-9);
            EXPECT_NEAR(seen->y, y, 1e-9);
            EXPECT_NEAR(seen->depth, t * dot(ray.direction, rays.forward()), 1e-9);
            EXPECT_FALSE(rays.project(ray.origin - ray.direction * t)) << "behind the viewer";
            const auto far = rays.project_direction(ray.direction);
            ASSERT_EQ(bool(far), projection == scene::Projection::perspective);
            if (!far) continue;
            EXPECT_NEAR(far->x, x, 1e-9);
            EXPECT_NEAR(far->y, y, 1e-9);
        }
    }
}

scene::Scene table() {
    Build s(160, 120);
    s.settings().tile = 32;
    s.camera().position = {0, 2, 9}, s.camera().target = {0, 0.6, 0};
    const MaterialId red = s.material(matte({0.8f, 0.1f, 0.1f})), blue = s.material(matte({0.1f, 0.2f, 0.8f})), grey = s.material(matte({0.5f, 0.5f, 0.5f}));
    s.place(geometry::Plane{}, grey);
    s.place(sphere(1), red, at({-1.2, 1, 0}));
    s.place(box({-0.5, 0, -0.5}, {0.5, 1.4, 0.5}), blue, at({1.3, 0, 0.6}));
    s.steady_light({3, 6, 9});
    s.uniform_environment({0.3f, 0.4f, 0.6f}, 1);
    return s.scene;
}

scene::Camera moved(const scene::Scene& scene, Vec3 by) {
    scene::Camera camera = *scene.camera;
    camera.position = camera.position + by;
    return camera;
}

TEST(Reprojection, ASmallMoveIsShownAtOnce) {
    Session session = finished(table());
    const scene::Image before = session.picture();
    ASSERT_TRUE(session.edit({scene::SetCamera{moved(session.scene(), {0.25, 0.1, -0.2})}}));
    const std::uint64_t rays = session.stats().rays.total();
    const scene::Image shown = session.picture(), converged = picture_of(session.scene());
    EXPECT_EQ(session.stats().rays.total(), rays) << "without a ray";
    EXPECT_LT(mean_difference(shown, converged), 0.6 * mean_difference(before, converged)) << "nearer to the new view than the old picture is";
    EXPECT_LT(mean_difference(shown, converged), 0.01);

    session.advance(Deadline::never());
    EXPECT_TRUE(same_picture(finished(session.scene()).picture(true), session.picture(true))) << "nothing of it is in the finished picture";
}

TEST(Reprojection, TheSameViewKeepsItsPicture) {
    Session session = finished(table());
    const scene::Image before = session.picture();
    const scene::Camera camera = *session.scene().camera;
    ASSERT_TRUE(session.edit({scene::SetCamera{moved(session.scene(), {0.3, 0, 0})}}));
    ASSERT_TRUE(session.edit({scene::SetCamera{camera}}));
    EXPECT_LT(mean_difference(session.picture(), before), 1e-3) << "moves that follow each other start from the last complete picture";
}

TEST(Reprojection, PicturesOfAnotherSizeBeginWithoutIt) {
    Session session = finished(table());
    ASSERT_TRUE(session.edit({scene::SetCamera{moved(session.scene(), {0.3, 0, 0})}}));
    scene::Settings larger = session.scene().settings;
    larger.width = 400, larger.height = 300;
    ASSERT_TRUE(session.edit({scene::SetSettings{larger}}));
    ASSERT_TRUE(session.edit({scene::SetCamera{moved(session.scene(), {0.3, 0, 0})}}));
    session.advance(Deadline::never());
    EXPECT_TRUE(same_picture(picture_of(session.scene()), session.picture()));
}

TEST(Reprojection, IsTheSameOnAnyNumberOfThreads) {
    scene::Image pictures[2];
    for (const int threads : {1, 3}) {
        scene::Scene scene = table();
        scene.settings.threads = threads;
        Session session = finished(std::move(scene));
        ASSERT_TRUE(session.edit({scene::SetCamera{moved(session.scene(), {1, 0.4, -3})}}));
        pictures[threads / 3] = session.picture();
    }
    EXPECT_TRUE(same_picture(pictures[0], pictures[1]));
}

// Until there is something better, the level layer says what is only a preview.
TEST(Reprojection, IsMarkedAsPreview) {
    Session session = finished(table());
    ASSERT_TRUE(session.edit({scene::SetCamera{moved(session.scene(), {0.1, 0, 0})}}));
    while (!session.advance(Deadline::in(std::chrono::microseconds(50))).first_picture) {}
    const scene::Image begun = session.picture(true);
    const auto& level = layer(begun, "level").values;
    EXPECT_GT(std::count(level.begin(), level.end(), -1.0f), static_cast<std::ptrdiff_t>(level.size() / 2));
    session.advance(Deadline::never());
    const scene::Image done = session.picture(true);
    EXPECT_EQ(std::count(layer(done, "level").values.begin(), layer(done, "level").values.end(), -1.0f), 0);
}

constexpr int width = 96, height = 64;
constexpr Rgb red{1, 0, 0}, blue{0, 0, 1};

scene::Camera camera_at(double x, double z) {
    scene::Camera camera;
    camera.position = {x, 0, z};
    camera.target = {x, 0, 0};
    return camera;
}

// A red square at z = 3 before a blue wall at z = 0, as the camera sees them.
std::vector<SeenPoint> square_before_wall(const CameraRays& camera) {
    std::vector<SeenPoint> points;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const geometry::Ray ray = camera.through(x, y);
            const auto at = [&](double z) { return ray.origin + ray.direction * ((z - ray.origin.z) / ray.direction.z); };
            const Vec3 near = at(3), far = at(0);
            const bool square = std::abs(near.x) < 0.3 && std::abs(near.y) < 0.3;
            const Vec3 hit = square ? near : far;
            points.push_back({SeenPoint::Kind::surface, {static_cast<float>(hit.x), static_cast<float>(hit.y), static_cast<float>(hit.z)}, square ? red : blue});
        }
    }
    return points;
}

// Where the square was the wall comes into sight: it is like the wall, or along the square like that, and nowhere between the two.
TEST(Reprojection, WhatIsLaidBareLooksLikeWhatIsBehind) {
    const auto points = square_before_wall(CameraRays(camera_at(0, 5), width, height));
    const CameraRays moved(camera_at(0.25, 5), width, height);
    parallel::Pool pool(2);
    const Reprojected picture = reproject(points, moved, width, height, pool);
    int like_wall = 0, like_square = 0, squares = 0;
    for (int y = 4; y < height - 4; ++y) {
        for (int x = 4; x < width - 12; ++x) {  // at the right what the old picture did not have comes in
            const std::size_t i = static_cast<std::size_t>(y) * width + static_cast<std::size_t>(x);
            squares += picture.pixels[i] == red;
            if (picture.seen[i]) continue;
            like_wall += picture.pixels[i] == blue;
            like_square += picture.pixels[i] == red;
            EXPECT_TRUE(picture.pixels[i] == blue || picture.pixels[i] == red) << x << ' ' << y;
        }
    }
    EXPECT_GT(like_wall, 20 * like_square) << like_square;
    EXPECT_GT(squares, 300);
}

}  // namespace
}  // namespace crescente::render::testing
