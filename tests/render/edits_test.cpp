// Law 1 for edits: after any script of edits, however it was interrupted, the converged picture is that of a fresh session of the final scene, to the
// bit. And law 3: an edit costs what it changes.
//
// CRESCENTE_EDIT_SCRIPTS=1000 test_render --gtest_filter='EditScripts.*' plays that many random scripts.
#include <unistd.h>

#include <algorithm>
#include <cstdlib>

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

// One edit of any kind, of something that is there.
class RandomEdits {
public:
    RandomEdits(Random& random) : random_(random) {}

    Edit next(const Scene& s) {
        switch (random_.below(15)) {
            case 0:
            case 1: return material(s);
            case 2: return light(s);
            case 3: {
                if (s.lights.size() > 5) return scene::RemoveLight{static_cast<std::uint32_t>(random_.below(s.lights.size()))};
                scene::Light l;
                l.position = random_.in_cube(5), l.falloff = scene::Falloff::none, l.color = color();
                return scene::InsertLight{static_cast<std::uint32_t>(random_.below(s.lights.size() + 1)), l};
            }
            case 4:
                if (s.lights.empty()) return material(s);
                return scene::RemoveLight{static_cast<std::uint32_t>(random_.below(s.lights.size()))};
            case 5:
            case 6: return moved(s);
            case 7: {
                scene::SetNode e = any_node(s);
                e.value.visible = !e.value.visible;
                return e;
            }
            case 8: {
                scene::SetNode e = any_node(s);
                for (scene::MaterialId& m : e.value.materials) m = any_material(s);
                return e;
            }
            case 9: return roots(s);
            case 10: {
                scene::Environment e = s.environment.value_or(scene::Environment{});
                e.horizon = color(), e.backdrop = random_.chance(0.5), e.backdrop_top = color();
                if (random_.chance(0.3)) e.strength = random_.uniform(0, 1);
                return scene::SetEnvironment{e};
            }
            case 11: return settings(s);
            case 12: {
                scene::Camera c = *s.camera;
                c.position = c.position + random_.in_cube(0.3);
                return scene::SetCamera{c};
            }
            case 13: return scene::AddMaterial{any_value()};
            default: {
                const std::uint32_t shape = static_cast<std::uint32_t>(random_.below(s.shapes.size()));
                return scene::SetShape{{shape}, random_.chance(0.5) ? geometry::Shape(sphere(random_.uniform(0.2, 1))) : geometry::Shape(box({-0.4, -0.3, -0.5}, random_.in_cube(0.5) + Vec3{0.6, 0.6, 0.6}))};
            }
        }
    }

private:
    Rgb color() { return {float(random_.uniform(0, 1)), float(random_.uniform(0, 1)), float(random_.uniform(0, 1))}; }
    scene::MaterialId any_material(const Scene& s) { return {static_cast<std::uint32_t>(random_.below(s.materials.size()))}; }
    scene::SetNode any_node(const Scene& s) {
        const auto i = static_cast<std::uint32_t>(random_.below(s.nodes.size()));
        return {{i}, s.nodes[i]};
    }
    scene::Material any_value() {
        switch (random_.below(4)) {
            case 0: return {"", matte(color())};
            case 1: return {"", mirror(color())};
            case 2: return {"", glass(color(), random_.uniform(1, 1.8), random_.chance(0.5))};
            default: {
                PhysicalMaterial m;
                m.base_color = color(), m.metallic = random_.chance(0.5), m.roughness = random_.uniform(0, 1), m.opacity = random_.chance(0.3) ? 0.5 : 1;
                return {"", m};
            }
        }
    }
    Edit material(const Scene& s) {
        const scene::MaterialId id = any_material(s);
        scene::Material value = s.materials[id.value];
        if (random_.chance(0.3)) return scene::SetMaterial{id, any_value()};
        if (auto* m = std::get_if<ClassicMaterial>(&value.model)) {
            m->diffuse = color();
            if (random_.chance(0.3)) m->reflection = color();
            if (random_.chance(0.2)) m->transmission = color();
            if (random_.chance(0.2)) m->ior = random_.uniform(1, 2);
            if (random_.chance(0.1)) m->attenuation = color();
        } else {
            auto& p = std::get<PhysicalMaterial>(value.model);
            p.base_color = color();
            if (random_.chance(0.3)) p.double_sided = !p.double_sided;
        }
        return scene::SetMaterial{id, value};
    }
    Edit light(const Scene& s) {
        if (s.lights.empty()) return scene::InsertLight{0, {}};
        const auto i = static_cast<std::uint32_t>(random_.below(s.lights.size()));
        scene::Light l = s.lights[i];
        switch (random_.below(5)) {
            case 0: l.position = l.position + random_.in_cube(1); break;
            case 1: l.color = random_.chance(0.2) ? Rgb{} : color(); break;
            case 2: l.outer_angle = random_.uniform(0.3, math::pi), l.inner_angle = l.outer_angle * random_.uniform(0, 1), l.direction = random_.direction(); break;
            case 3: l.shadows = !l.shadows; break;
            default: l.highlights = !l.highlights, l.range = random_.chance(0.5) ? 0 : random_.uniform(2, 9); break;
        }
        return scene::SetLight{i, l};
    }
    Edit moved(const Scene& s) {
        scene::SetNode e = any_node(s);
        e.value.transform = at(random_.in_cube(0.5)) * e.value.transform;
        if (random_.chance(0.3)) e.value.transform = e.value.transform * Affine::rotation(random_.direction(), random_.uniform(0, 3));
        return e;
    }
    // A root is taken away, or one of the nodes added.
    Edit roots(const Scene& s) {
        scene::SetRoots e{s.roots};
        if (e.roots.size() > 3 && random_.chance(0.6)) {
            e.roots.erase(e.roots.begin() + static_cast<std::ptrdiff_t>(random_.below(e.roots.size())));
        } else {
            const scene::NodeId node{static_cast<std::uint32_t>(random_.below(s.nodes.size()))};
            e.roots.insert(e.roots.begin() + static_cast<std::ptrdiff_t>(random_.below(e.roots.size() + 1)), node);
        }
        return e;
    }
    Edit settings(const Scene& s) {
        scene::Settings t = s.settings;
        switch (random_.below(8)) {
            case 0: t.threshold = random_.chance(0.5) ? 1.0 / 256 : random_.uniform(0.004, 0.3); break;
            case 1: t.depth = static_cast<int>(random_.below(7)); break;
            case 2: t.supersampling = static_cast<int>(random_.below(3)); break;
            case 3: t.contrast = random_.uniform(0.02, 0.3); break;
            case 4: t.level = static_cast<scene::Level>(random_.below(4)); break;
            case 5: t.threads = 1 + static_cast<int>(random_.below(3)); break;
            case 6: t.accelerator = static_cast<scene::AcceleratorKind>(random_.below(2)); break;
            default: t.width = 30 + static_cast<int>(random_.below(50)), t.tile = 16 + static_cast<int>(random_.below(20)); break;
        }
        return scene::SetSettings{t};
    }

    Random& random_;
};

// A script is a seed and which of its steps are played, so that a failing one can be cut down to the steps that matter.
struct Script {
    std::uint64_t seed;
    std::vector<int> steps;
};

Scene start(std::uint64_t seed) {
    Scene scene = seed % 3 == 0 ? still_life() : seed % 3 == 1 ? instances() : coincident();
    Random random(seed);
    scene.settings.width = 40, scene.settings.height = 30, scene.settings.tile = 16;
    scene.settings.threads = 1 + static_cast<int>(seed % 2);
    scene.settings.order = seed & 4 ? scene::Order::tiles : scene::Order::even;
    if (seed % 5 == 1) scene.settings.memory = random.chance(0.5) ? 1 : 200'000;
    if (seed % 7 == 3) scene.settings.keep = false;
    if (seed % 4 == 2) scene.settings.level = static_cast<scene::Level>(random.below(4));
    for (scene::Material& m : scene.materials) {  // bodies that absorb begin anew at most edits: not in every script
        if (auto* classic = std::get_if<ClassicMaterial>(&m.model); classic && seed % 6 != 0) classic->attenuation = {};
    }
    return scene;
}

// Where a script leaves its checkpoints, which are taken away again.
struct ScriptFile {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("crescente-edits-" + std::to_string(getpid()) + ".checkpoint");
    ~ScriptFile() { std::filesystem::remove(path); }
};

// Plays the script; says what is wrong, or nothing. Now and then another session goes on from a checkpoint.
std::string play(const Script& script, bool tell = false) {
    Session session = opened(start(script.seed));
    Frame frame;  // brought up to date now and then
    const ScriptFile file;
    std::string told;
    for (const int step : script.steps) {
        Random random(mix_bits(script.seed * 1000 + static_cast<std::uint64_t>(step)));
        RandomEdits edits(random);
        const int stops = static_cast<int>(random.below(4));
        if (stops == 0) session.advance(Deadline::never());
        for (int i = 1; i < stops; ++i) session.advance(Deadline::in(std::chrono::microseconds(random.below(3000))));
        std::vector<Edit> batch;
        const std::uint64_t more = random.below(2);
        for (std::uint64_t i = 0; i <= more; ++i) batch.push_back(edits.next(session.scene()));
        if (tell) {
            told += "step " + std::to_string(step) + ":";
            for (const Edit& e : batch) told += " kind " + std::to_string(e.index());
            told += "\n";
        }
        session.picture(random.chance(0.3));  // whole and safe at any moment
        if (random.chance(0.5)) {
            session.refresh(frame);
            if (const auto same = same_picture(session.picture(), frame.image); !same) return told + "refreshed: " + same.message();
        }
        if (random.chance(0.3)) session.look_at({static_cast<int>(random.below(40)), static_cast<int>(random.below(30)), static_cast<int>(random.below(20)), 5});
        if ((script.seed + static_cast<std::uint64_t>(step)) % 3 == 0) {
            if (const auto saved = session.save(file.path); !saved) return told + saved.error().text();
            auto again = Session::resume(session.scene(), file.path);
            if (!again) return told + again.error().text();
            session = std::move(*again);
            frame = {};
        }
        auto done = session.edit(std::move(batch));
        if (!done) continue;  // a batch may break the scene: refused whole
        if (random.chance(0.2)) {
            if (random.chance(0.5)) session.advance(Deadline::in(std::chrono::microseconds(random.below(3000))));
            if (!session.edit(std::move(done->undo))) return told + "undo failed at step " + std::to_string(step);
        }
    }
    if (!session.advance(Deadline::never()).done) return told + "not done";
    session.refresh(frame);
    if (const auto same = same_picture(session.picture(), frame.image); !same) return told + "refreshed: " + same.message();
    auto fresh = Session::open(session.scene());  // in which perhaps nothing is left to be seen
    if (!fresh) return told + fresh.error().text();
    fresh->advance(Deadline::never());
    const auto same = same_picture(fresh->picture(true), session.picture(true));
    return same ? "" : told + same.message();
}

// Leaves out every step that the failure does not need.
Script shrunk(Script script) {
    for (std::size_t i = script.steps.size(); i-- > 0;) {
        Script shorter = script;
        shorter.steps.erase(shorter.steps.begin() + static_cast<std::ptrdiff_t>(i));
        if (!play(shorter).empty()) script = shorter;
    }
    return script;
}

TEST(EditScripts, EndInThePictureOfAFreshSession) {
    const char* wanted = std::getenv("CRESCENTE_EDIT_SCRIPTS");
    const char* first = std::getenv("CRESCENTE_EDIT_SEED");
    const std::uint64_t begin = first ? std::strtoull(first, nullptr, 10) : 0, count = wanted ? std::strtoull(wanted, nullptr, 10) : 60;
    for (std::uint64_t seed = begin; seed < begin + count; ++seed) {
        Script script{seed, {}};
        for (int i = 0; i < 6; ++i) script.steps.push_back(i);
        if (play(script).empty()) continue;
        script = shrunk(script);
        ADD_FAILURE() << "seed " << seed << ", " << script.steps.size() << " steps\n" << play(script, true);
        if (HasFailure()) return;
    }
}

// --- Law 3: what an edit costs

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
