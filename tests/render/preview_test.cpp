// What is shown right after an edit, before its work is done.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

scene::Scene row() {
    Build s(192, 96);
    s.settings().tile = 64, s.settings().supersampling = 1;
    s.camera().position = {0, 1, 9};
    const MaterialId red = s.material(matte({0.8f, 0.1f, 0.1f})), grey = s.material(matte({0.5f, 0.5f, 0.5f}));
    s.place(sphere(1.2), red, at({-2.5, 0, 0}));
    s.place(sphere(1.2), grey, at({2.5, 0, 0}));
    s.steady_light({3, 6, 9});
    s.steady_light({-5, 3, 4}, {0.4f, 0.4f, 0.5f});
    return s.scene;
}

// The first picture after an edit that is more than the one before, by quanta as small as there are.
scene::Image first_picture_after(Session& session, std::vector<scene::Edit> edits) {
    const scene::Image before = session.picture();
    EXPECT_TRUE(session.edit(std::move(edits)));
    for (int i = 0; i < 1000; ++i) {
        session.advance(Deadline::in(std::chrono::microseconds(100)));
        scene::Image now = session.picture();
        if (!same_picture(before, now)) return now;
    }
    return before;
}

void expect_to_begin_well(std::vector<scene::Edit> edits, double share) {
    scene::Scene scene = row();
    scene.settings.tile = 192;  // one tile: all that changed comes at once
    Session session = finished(scene);
    const scene::Image before = session.picture();
    const scene::Image first = first_picture_after(session, std::move(edits));
    const scene::Image converged = picture_of(session.scene());
    EXPECT_LT(mean_difference(first, converged), share * mean_difference(before, converged));
    session.advance(Deadline::never());
    EXPECT_TRUE(same_picture(converged, session.picture()));
}

TEST(Preview, ColorsAreThereAtOnce) {
    scene::Material green = row().materials[0];
    std::get<ClassicMaterial>(green.model).diffuse = {0.1f, 0.8f, 0.2f};
    expect_to_begin_well({scene::SetMaterial{{0}, green}}, 0.15);
}

TEST(Preview, LightsAreThereAtOnce) {
    scene::Light light = row().lights[0];
    light.color = {0.2f, 0.9f, 0.1f};
    expect_to_begin_well({scene::SetLight{0, light}}, 0.15);
    light = row().lights[0];
    light.position = {-6, 6, 5};
    expect_to_begin_well({scene::SetLight{0, light}}, 0.3);
}

TEST(Preview, MovedObjectsAreThereAtOnce) {
    scene::Node node = row().nodes[0];
    node.transform = at({-1.8, 0.7, 0});
    expect_to_begin_well({scene::SetNode{{0}, node}}, 0.5);
}

// What an edit does not touch stays as sharp as it was, at any moment.
TEST(Preview, TheRestOfThePictureStays) {
    Session session = finished(row());
    const scene::Image before = session.picture();
    scene::Material green = session.scene().materials[0];
    std::get<ClassicMaterial>(green.model).diffuse = {0.1f, 0.8f, 0.2f};
    ASSERT_TRUE(session.edit({scene::SetMaterial{{0}, green}}));
    bool done = false;
    while (!done) {
        done = session.advance(Deadline::in(std::chrono::microseconds(100))).done;
        const scene::Image now = session.picture();
        for (int y = 0; y < 96; ++y) {
            for (int x = 96; x < 192; ++x) {
                const Rgb a = pixel(before, x, y), b = pixel(now, x, y);
                ASSERT_TRUE(a.r == b.r && a.g == b.g && a.b == b.b) << x << ' ' << y;
            }
        }
    }
}

}  // namespace
}  // namespace crescente::render::testing
