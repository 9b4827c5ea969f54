// Law 3 for edits: an edit costs what it changes. And undo, edits that are refused, edits that follow each other.
#include <algorithm>

#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Edit;
using scene::Scene;

Session& converge(Session& session) {
    EXPECT_TRUE(session.advance(Deadline::never()).done);
    return session;
}

std::uint64_t all_rays(const RayCounts& r) { return r.camera + r.reflected + r.refracted + r.shadow; }

struct Cost {
    RayCounts rays;
    std::uint64_t tiles;
};

// Makes the edits on a converged session, and looks that they end in the right picture.
Cost cost_of(const Scene& scene, std::vector<Edit> edits) {
    Session session = finished(scene);
    const Stats before = session.stats();
    const auto done = session.edit(std::move(edits));
    EXPECT_TRUE(done) << (done ? "" : done.error().text());
    converge(session);
    EXPECT_TRUE(same_picture(finished(session.scene()).picture(true), session.picture(true)));
    const Stats after = session.stats();
    return {{after.rays.camera - before.rays.camera, after.rays.reflected - before.rays.reflected, after.rays.refracted - before.rays.refracted,
             after.rays.shadow - before.rays.shadow}, after.revised_tiles - before.revised_tiles};
}

Scene without_splits() {
    Scene scene = still_life();
    scene.settings.supersampling = 0;
    for (scene::Material& m : scene.materials) {
        if (auto* classic = std::get_if<ClassicMaterial>(&m.model)) classic->attenuation = {};
    }
    return scene;
}

TEST(EditCost, ColorsTraceNothing) {
    const Scene scene = without_splits();
    scene::Material floor = scene.materials[0];
    std::get<ClassicMaterial>(floor.model).diffuse = {0.1f, 0.9f, 0.2f};
    const Cost cost = cost_of(scene, {scene::SetMaterial{{0}, floor}});
    EXPECT_EQ(all_rays(cost.rays), 0u);
    EXPECT_GT(cost.tiles, 0u);
}

// Weaker mirrors send no new rays, stronger ones only those that were below the threshold.
TEST(EditCost, WeightsTraceOnlyWhatTheyBringAboveTheThreshold) {
    const Scene scene = without_splits();
    scene::Material floor = scene.materials[0];
    std::get<ClassicMaterial>(floor.model).reflection = {0.12f, 0.12f, 0.15f};
    EXPECT_EQ(all_rays(cost_of(scene, {scene::SetMaterial{{0}, floor}}).rays), 0u);
    std::get<ClassicMaterial>(floor.model).reflection = {0.3f, 0.3f, 0.3f};
    const Cost stronger = cost_of(scene, {scene::SetMaterial{{0}, floor}});
    EXPECT_EQ(stronger.rays.camera, 0u);
    EXPECT_GT(stronger.rays.reflected, 0u);
    EXPECT_LT(stronger.rays.reflected, finished(scene).stats().rays.reflected / 2);
}

TEST(EditCost, LightsTraceTheirOwnRays) {
    const Scene scene = without_splits();
    scene::Light light = scene.lights[1];
    light.color = {0.2f, 0.9f, 0.1f};
    EXPECT_EQ(all_rays(cost_of(scene, {scene::SetLight{1, light}}).rays), 0u);

    // Moved: no more than the shadow rays of a picture with this light alone.
    light = scene.lights[1];
    light.position = light.position + Vec3{0.3, 0.2, -0.4};
    const Cost moved = cost_of(scene, {scene::SetLight{1, light}});
    EXPECT_EQ(all_rays(moved.rays), moved.rays.shadow);
    Scene alone = scene;
    alone.lights = {light};
    EXPECT_LE(moved.rays.shadow, finished(alone).stats().rays.shadow);
    EXPECT_GT(moved.rays.shadow, 0u);

    // A wider cone: rays only to what it newly reaches.
    scene::Light spot = scene.lights[0];
    spot.outer_angle += 0.1;
    const Cost wider = cost_of(scene, {scene::SetLight{0, spot}});
    EXPECT_EQ(all_rays(wider.rays), wider.rays.shadow);
    alone.lights = {scene.lights[0]};
    EXPECT_LT(wider.rays.shadow, finished(alone).stats().rays.shadow / 2);
    EXPECT_GT(wider.rays.shadow, 0u);

    // Taken away: nothing.
    EXPECT_EQ(all_rays(cost_of(scene, {scene::RemoveLight{1}}).rays), 0u);
}

TEST(EditCost, LightsWithExtentAndTheirSurroundings) {
    Scene scene = without_splits();
    scene::Light panel;
    panel.kind = scene::LightKind::rectangle, panel.position = {1, 4, 3}, panel.direction = {-0.2, -1, -0.4}, panel.intensity = 20;
    scene.lights[0] = panel;
    // Its size is nothing to the levels that see its centre, and its strength takes no ray.
    panel.width = 3, panel.intensity = 9, panel.visible = false, panel.group = "all";
    EXPECT_EQ(all_rays(cost_of(scene, {scene::SetLight{0, panel}}).rays), 0u);
    panel.two_sided = true;
    const Cost sides = cost_of(scene, {scene::SetLight{0, panel}});
    EXPECT_EQ(all_rays(sides.rays), sides.rays.shadow);
    panel.kind = scene::LightKind::disk;
    cost_of(scene, {scene::SetLight{0, panel}});

    scene::Environment sky;
    std::vector<Rgb> pixels;
    for (int i = 0; i < 32; ++i) pixels.push_back({float(i), float(i % 8), 3});
    sky.panorama = std::make_shared<const scene::Panorama>(8, 4, std::move(pixels));
    scene.environment.reset();
    EXPECT_EQ(all_rays(cost_of(scene, {scene::SetEnvironment{sky}}).rays), 0u);
    scene.environment = sky;
    sky.rotation = 1, sky.intensity = 0.3;
    EXPECT_EQ(all_rays(cost_of(scene, {scene::SetEnvironment{sky}}).rays), 0u);
    cost_of(scene, {scene::SetEnvironment{}});
}

TEST(EditCost, AMovedObjectTracesWhatMeetsIt) {
    Build s(96, 72);
    s.settings().tile = 16, s.settings().depth = 3;
    s.camera().position = {0, 1, 8};
    const MaterialId grey = s.material(matte({0.6f, 0.6f, 0.6f}));
    for (int i = 0; i < 9; ++i) s.place(sphere(0.4), grey, at({-4.0 + i, 0, 0}));
    s.steady_light({3, 6, 5});
    scene::Node node = s.scene.nodes[4];
    node.transform = at({0, 1.1, 0});
    const Cost cost = cost_of(s.scene, {scene::SetNode{{4}, node}});
    const RayCounts fresh = finished(s.scene).stats().rays;
    EXPECT_GT(cost.rays.camera, 0u);
    EXPECT_LT(cost.rays.camera, fresh.camera / 10);
    EXPECT_LT(all_rays(cost.rays), all_rays(fresh) / 8);
}

// A thin rod across its large box: no ray that passes the box alone is traced, and what the rod shades is known without a ray through the scene.
TEST(EditCost, AnObjectThatComesTracesOnlyWhatItCovers) {
    Build s(96, 72);
    s.settings().tile = 96;
    s.camera().position = {0, 3, 9}, s.camera().target = {0, 1, 0};
    const MaterialId grey = s.material(matte({0.6f, 0.6f, 0.6f}));
    s.place(geometry::Plane{}, grey);
    const NodeId rod = s.place(box({-2.5, -0.05, -0.05}, {2.5, 0.05, 0.05}), grey, at({0, 1.5, 0}) * Affine::rotation({0, 0, 1}, 0.6) * Affine::rotation({0, 1, 0}, 0.6));
    s.steady_light({3, 6, 5});
    scene::Scene without = s.scene;
    without.nodes[rod.value].visible = false;
    const Cost came = cost_of(without, {scene::SetNode{rod, s.scene.nodes[rod.value]}});
    const scene::Image picture = finished(s.scene).picture(true);
    const auto covered = static_cast<std::uint64_t>(std::count(layer(picture, "object").values.begin(), layer(picture, "object").values.end(), float(rod.value)));
    EXPECT_GT(covered, 50u);
    EXPECT_GE(came.rays.camera, covered);
    EXPECT_LE(came.rays.camera, covered + 96 + 72 + 1);  // pixels' own corners are counted in the picture, not those on the tile's far borders
    EXPECT_LE(came.rays.shadow, came.rays.camera);

    // And goes: the rays that ended on it, and the ways that it alone blocked.
    const Cost went = cost_of(s.scene, {scene::SetNode{rod, without.nodes[rod.value]}});
    EXPECT_EQ(went.rays.camera, came.rays.camera);
    EXPECT_LT(went.rays.shadow, finished(s.scene).stats().rays.shadow / 6);
}

TEST(EditCost, RaysTriedAgainstWhatCameAreCountedApart) {
    const Scene scene = without_splits();
    scene::SetNode moved{{1}, scene.nodes[1]};
    moved.value.transform = at({0.1, 0, 0}) * moved.value.transform;
    Session session = finished(scene);
    EXPECT_EQ(session.stats().tests.kept_rays, 0u);
    ASSERT_TRUE(session.edit({moved}));
    converge(session);
    EXPECT_GT(session.stats().tests.kept_rays, 0u);
}

TEST(EditCost, FinerSettingsGrowOnlyTheFrontier) {
    Scene scene = without_splits();
    scene.settings.threshold = 0.05;
    scene::Settings finer = scene.settings;
    finer.threshold = 0.004;
    Scene fine = scene;
    fine.settings = finer;
    const RayCounts before = finished(scene).stats().rays, whole = finished(fine).stats().rays;
    const Cost cost = cost_of(scene, {scene::SetSettings{finer}});
    EXPECT_EQ(all_rays(cost.rays), all_rays(whole) - all_rays(before));
    // And back: hidden, nothing traced; and forth again: shown again, nothing traced.
    Session session = finished(fine);
    for (const scene::Settings& settings : {scene.settings, finer}) {
        ASSERT_TRUE(session.edit({scene::SetSettings{settings}}));
        converge(session);
        EXPECT_TRUE(same_picture(finished(session.scene()).picture(true), session.picture(true)));
        EXPECT_EQ(all_rays(session.stats().rays), all_rays(whole));
    }
}

TEST(EditCost, WhatIsOutOfSightCostsNothing) {
    Scene scene = without_splits();
    scene.materials.push_back({"unused", matte({1, 1, 1})});
    const Cost cost = cost_of(scene, {scene::SetMaterial{{static_cast<std::uint32_t>(scene.materials.size() - 1)}, {"unused", matte({0, 0, 0})}}});
    EXPECT_EQ(all_rays(cost.rays), 0u);
    EXPECT_EQ(cost.tiles, 0u);
}

// --- Undo, and edits that are refused

TEST(Edits, UndoBringsBackThePicture) {
    const Scene scene = still_life();
    const scene::Image picture = finished(scene).picture(true);
    Session session = finished(scene);
    scene::SetNode hide{{2}, scene.nodes[2]};
    hide.value.visible = false;
    scene::SetRoots fewer{scene.roots};
    fewer.roots.pop_back();
    auto first = session.edit({hide, fewer, scene::InsertLight{1, scene.lights[0]}, scene::AddMaterial{scene.materials[0]}});
    ASSERT_TRUE(first);
    converge(session);
    EXPECT_FALSE(same_picture(picture, session.picture(true)));
    auto redo = session.edit(std::move(first->undo));
    ASSERT_TRUE(redo);
    converge(session);
    EXPECT_TRUE(same_picture(picture, session.picture(true)));
    const scene::Image changed = finished([&] { Scene s = scene; s.nodes[2].visible = false, s.roots.pop_back(), s.lights.insert(s.lights.begin() + 1, scene.lights[0]); return s; }()).picture();
    ASSERT_TRUE(session.edit(std::move(redo->undo)));
    converge(session);
    EXPECT_TRUE(same_picture(changed, session.picture()));
}

// Pixels that are split, and no longer, and again: what was forgotten does not pile up.
TEST(Edits, ManyEditsDoNotMakeTheForestGrow) {
    const Scene scene = still_life();
    Session session = finished(scene);
    const std::uint64_t nodes = session.stats().nodes;
    for (int i = 0; i < 40; ++i) {
        scene::Material floor = scene.materials[0];
        std::get<ClassicMaterial>(floor.model).diffuse = i % 2 ? Rgb{0.9f, 0.1f, 0.1f} : Rgb{0.05f, 0.05f, 0.05f};
        ASSERT_TRUE(session.edit({scene::SetMaterial{{0}, floor}}));
        converge(session);
    }
    EXPECT_LT(session.stats().nodes, nodes + nodes / 2);
    EXPECT_TRUE(same_picture(finished(session.scene()).picture(true), session.picture(true)));
}

// What one edit moved is looked for only after others that touch no tree.
TEST(Edits, ThoseThatTouchNoTreeMayFollowBeforeTheyAreLookedAt) {
    Scene scene = still_life();
    PhysicalMaterial sheet;
    sheet.double_sided = false;
    scene.materials.push_back({"sheet", sheet});
    scene.nodes[1].materials = {{static_cast<std::uint32_t>(scene.materials.size() - 1)}};
    Session session = finished(scene);
    scene::SetNode move{{1}, scene.nodes[1]};
    move.value.transform = at({0.4, 0.1, 0.3}) * move.value.transform;
    ASSERT_TRUE(session.edit({move}));
    scene::Settings settings = scene.settings;
    for (int i = 0; i < 3; ++i) {
        settings.threads = 1 + i;
        ASSERT_TRUE(session.edit({scene::SetSettings{settings}}));
    }
    converge(session);
    EXPECT_TRUE(same_picture(finished(session.scene()).picture(true), session.picture(true)));
}

TEST(Edits, AnEditThatBreaksTheSceneIsRefusedWhole) {
    const Scene scene = still_life();
    const scene::Image picture = finished(scene).picture(true);
    Session session = finished(scene);
    scene::Material floor = scene.materials[0];
    std::get<ClassicMaterial>(floor.model).diffuse = {5, 0, 0};
    scene::SetNode circle{{0}, scene.nodes[0]};
    circle.value.children = {{0}};
    scene::Camera blind = *scene.camera;
    blind.target = blind.position;
    scene::Material fine = scene.materials[1];
    std::get<ClassicMaterial>(fine.model).diffuse = {0.5f, 0, 0};
    const auto refused = session.edit({scene::SetMaterial{{1}, fine}, scene::SetMaterial{{0}, floor}, scene::SetLight{99, {}}, circle, scene::SetCamera{blind},
                                       scene::AddShape{{"ball", sphere(0)}}, scene::SetCamera{}, scene::SetMaterial{{77}, fine}}, "script");
    ASSERT_FALSE(refused);
    const std::string text = refused.error().text();
    for (const char* said : {"diffuse", "no light 99", "circle", "looks nowhere", "radius", "cannot be taken away", "no material 77", "script"}) {
        EXPECT_NE(text.find(said), std::string::npos) << said << " is not told in\n" << text;
    }
    EXPECT_EQ(session.scene().shapes.size(), scene.shapes.size());
    EXPECT_TRUE(converge(session).stats().revised_tiles == 0);
    EXPECT_TRUE(same_picture(picture, session.picture(true)));
}

}  // namespace
}  // namespace crescente::render::testing
