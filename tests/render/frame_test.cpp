// Looking at a session: frames that are brought up to date, where work is done first, and what is under a pixel.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

scene::Scene balls() {
    Build s(96, 64);
    s.settings().tile = 16;
    s.camera().position = {0, 0, 10};
    const MaterialId red = s.material(matte({0.8f, 0.1f, 0.1f})), grey = s.material(matte({0.5f, 0.5f, 0.5f}));
    s.place(sphere(1), red, at({-2.5, 0, 0}));
    s.place(sphere(1), grey, at({2.5, 0, 0}));
    s.steady_light({3, 6, 9});
    return s.scene;
}

int pixels_in(const std::vector<Area>& areas) {
    int sum = 0;
    for (const Area& a : areas) sum += a.width * a.height;
    return sum;
}

TEST(Frames, OnlyWhatChangedIsWritten) {
    Session session = opened(balls());
    Frame frame;
    EXPECT_EQ(pixels_in(session.refresh(frame)), 96 * 64);
    EXPECT_TRUE(session.refresh(frame).empty());
    session.advance(Deadline::never());
    EXPECT_EQ(pixels_in(session.refresh(frame)), 96 * 64);
    EXPECT_TRUE(same_picture(session.picture(), frame.image));
    session.advance(Deadline::never());
    EXPECT_TRUE(session.refresh(frame).empty()) << "nothing was left to do";

    scene::Material other = session.scene().materials[0];
    std::get<ClassicMaterial>(other.model).diffuse = {0.1f, 0.8f, 0.1f};
    ASSERT_TRUE(session.edit({scene::SetMaterial{{0}, other}}));
    session.advance(Deadline::never());
    const std::vector<Area> areas = session.refresh(frame);
    EXPECT_FALSE(areas.empty());
    for (const Area& a : areas) EXPECT_LE(a.x + a.width, 48) << "the other ball did not change";
    EXPECT_TRUE(same_picture(picture_of(session.scene()), frame.image));
}

TEST(Frames, OneOfAnotherSizeIsMadeAnew) {
    Session session = finished(balls());
    Frame frame;
    session.refresh(frame);
    scene::Settings smaller = session.scene().settings;
    smaller.width = 40;
    ASSERT_TRUE(session.edit({scene::SetSettings{smaller}}));
    session.advance(Deadline::never());
    session.refresh(frame);
    EXPECT_TRUE(same_picture(picture_of(session.scene()), frame.image));
}

// Interrupted after every quantum: the level that each tile has reached.
TEST(Looking, WorkIsDoneFirstWhereTheUserLooks) {
    scene::Scene scene = balls();
    scene.settings.width = 384, scene.settings.height = 256, scene.settings.tile = 32;
    Session session = opened(scene);
    const Area looked_at{256, 64, 32, 32};
    session.look_at(looked_at);
    bool ahead = false;
    for (int i = 0; i < 100000 && !ahead; ++i) {
        const Progress progress = session.advance(Deadline::in(std::chrono::microseconds(50)));
        ASSERT_FALSE(progress.done) << "the tile that is looked at never was ahead of the others";
        const scene::Image image = session.picture(true);
        const float here = values(image, "level", 270, 80)[0];
        const float elsewhere = values(image, "level", 32, 224)[0];
        EXPECT_GE(here, elsewhere);
        ahead = here == static_cast<float>(scene::Level::reflections) && elsewhere == 0;  // pixels are not split
    }
    EXPECT_TRUE(ahead);
    session.advance(Deadline::never());
    EXPECT_TRUE(same_picture(picture_of(scene), session.picture()));
}

TEST(Picking, TellsWhatTheCameraSees) {
    Build s(64, 64);
    s.settings().tile = 16;
    s.camera().position = {0, 0, 10}, s.camera().field_of_view = 0.6;
    const MaterialId red = s.material(matte({0.8f, 0.1f, 0.1f}));
    s.place(sphere(1), red, at({-2, 0, 0}));
    // The same part twice below an assembly: told apart by the way that leads to it.
    const NodeId part = s.node({"part", {}, s.shape(box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5})), {}, {}, true});
    const NodeId up = s.node({"up", at({1, 1.2, 0}), {}, {}, {part}, true}), down = s.node({"down", at({1, -1.2, 0}), {}, {}, {part}, true});
    const NodeId assembly = s.node({"assembly", {}, {}, {}, {up, down}, true});
    s.scene.roots.push_back(assembly);
    s.steady_light({3, 6, 9});
    const auto ids = [](const std::vector<NodeId>& path) {
        std::vector<std::uint32_t> values;
        for (const NodeId id : path) values.push_back(id.value);
        return values;
    };

    for (const std::int64_t memory : {0, 1}) {
        s.settings().memory = memory;
        Session session = finished(s.scene);
        const RayCounts rays = session.stats().rays;
        const double scale = 10 * std::tan(0.3) / 32;  // metres a pixel, at the target
        const auto pixel_at = [&](double x, double y) { return std::array{static_cast<int>(32 + x / scale), static_cast<int>(32 - y / scale)}; };

        auto [x, y] = pixel_at(-2, 0);
        auto pick = session.pick(x, y);
        ASSERT_TRUE(pick);
        EXPECT_EQ(ids(pick->path), ids({s.scene.roots[0]}));
        EXPECT_EQ(pick->material.value, red.value);
        EXPECT_NEAR(length(pick->position - Vec3{-2, 0, 0}), 1, 1e-9);
        EXPECT_NEAR(dot(pick->normal, pick->position - Vec3{-2, 0, 0}), 1, 1e-6);

        std::tie(x, y) = std::pair{pixel_at(1, 1.2)[0], pixel_at(1, 1.2)[1]};
        pick = session.pick(x, y);
        ASSERT_TRUE(pick);
        EXPECT_EQ(ids(pick->path), ids({assembly, up, part}));
        EXPECT_FALSE(pick->material.valid());
        EXPECT_NEAR(pick->position.z, 0.5, 1e-9);
        EXPECT_EQ(ids(session.pick(pixel_at(1, -1.2)[0], pixel_at(1, -1.2)[1])->path), ids({assembly, down, part}));

        EXPECT_FALSE(session.pick(32, 2)) << "background";
        EXPECT_FALSE(session.pick(-1, 0));
        EXPECT_FALSE(session.pick(0, 64));
        EXPECT_EQ(session.stats().rays.total(), rays.total()) << "looking is not rendering";
    }
    Session begun = opened(s.scene);
    EXPECT_FALSE(begun.pick(10, 32)) << "nothing is known yet";
}

}  // namespace
}  // namespace crescente::render::testing
