// Lights that act on some objects only.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Light;
using scene::Scene;

// Two balls side by side over nothing, seen from the front, each within its half of the picture; the right one is within a group.
struct Pair {
    Build b{24, 12};
    explicit Pair(const PhysicalMaterial& material) {
        const MaterialId m = b.material(material);
        b.scene.nodes[b.place(sphere(0.9), m, at({-1, 0, 0})).value].name = "left";
        const NodeId right = b.node({"right", at({1, 0, 0}), b.shape(sphere(0.9)), {m}, {}, true});
        b.scene.roots.push_back(b.node({"group", {}, {}, {}, {right}, true}));
        b.camera().projection = scene::Projection::orthographic, b.camera().height = 2;
    }
    Light& light(scene::LightKind kind) {
        Light& l = b.light();
        l.kind = kind, l.position = {0, 0, 6}, l.direction = {0, 0, -1}, l.intensity = 40, l.radius = 0.4, l.visible = false;
        return l;
    }
};

PhysicalMaterial plain() {
    PhysicalMaterial m;
    m.base_color = gray(0.5f), m.roughness = 1, m.ior = 1;
    return m;
}

Scene at_level(Scene s, scene::Level level) {
    s.settings.level = level, s.settings.samples = 8;
    return s;
}

// The two halves of a picture: what each sums up to, and whether it is that of another picture to the bit.
double sum_of(const scene::Image& image, bool right) {
    double sum = 0;
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width / 2; ++x) sum += pixel(image, x + (right ? image.width / 2 : 0), y).g;
    }
    return sum;
}
bool same_half(const scene::Image& a, const scene::Image& b, bool right) {
    for (int y = 0; y < a.height; ++y) {
        for (int x = 0; x < a.width / 2; ++x) {
            const int column = x + (right ? a.width / 2 : 0);
            if (pixel(a, column, y) != pixel(b, column, y)) return false;
        }
    }
    return true;
}

TEST(LightLinks, OnlyAndExceptAtAllLevels) {
    for (const scene::LightKind kind : {scene::LightKind::point, scene::LightKind::disk, scene::LightKind::sphere}) {
        for (const scene::Level level : {scene::Level::visible, scene::Level::reflections, scene::Level::soft, scene::Level::indirect}) {
            SCOPED_TRACE(std::to_string(int(kind)) + " at level " + std::to_string(int(level)));
            Pair pair(plain());
            Light& light = pair.light(kind);
            const scene::Image all = picture_of(at_level(pair.b.scene, level));
            light.only = {"group"};
            const scene::Image only = picture_of(at_level(pair.b.scene, level));
            light.only = {}, light.except = {"right"};
            const scene::Image except = picture_of(at_level(pair.b.scene, level));
            EXPECT_GT(sum_of(all, false), 1);
            EXPECT_GT(sum_of(all, true), 1);
            // From soft on the balls see each other: at grazing angles, at indirect by all their light.
            const double light_of_the_other = level < scene::Level::soft ? 0 : level == scene::Level::soft ? 1e-3 : 0.2;
            EXPECT_LE(sum_of(only, false), light_of_the_other * sum_of(all, false));
            EXPECT_LE(sum_of(except, true), light_of_the_other * sum_of(all, true));
            EXPECT_NEAR(sum_of(only, true), sum_of(all, true), light_of_the_other * sum_of(all, true));
            EXPECT_NEAR(sum_of(except, false), sum_of(all, false), light_of_the_other * sum_of(all, false));
            if (level < scene::Level::soft) {
                EXPECT_TRUE(same_half(only, all, true));
                EXPECT_TRUE(same_half(except, all, false));
            }
        }
    }
}

TEST(LightLinks, WhatIsNotLitDoesNotMirrorTheLight) {
    PhysicalMaterial chrome;
    chrome.metallic = 1, chrome.roughness = 0, chrome.base_color = gray(0.9f);
    Pair pair(chrome);
    Light& light = pair.light(scene::LightKind::disk);
    light.highlights = false, light.radius = 2.5;
    const scene::Image all = picture_of(at_level(pair.b.scene, scene::Level::soft));
    light.except = {"left"};
    const scene::Image linked = picture_of(at_level(pair.b.scene, scene::Level::soft));
    EXPECT_GT(sum_of(all, false), 1);
    EXPECT_LT(sum_of(linked, false), 0.2 * sum_of(all, false)) << "but what the other ball shows of it";
    EXPECT_GT(sum_of(linked, true), 0.8 * sum_of(all, true));
}

// Samples hold where a light's color changes, but not where its links do; the result is a fresh picture's either way (EditScripts).
TEST(LightLinks, AnEditThatChangesNothingOfTheLinksAsksForNoRay) {
    Pair pair(plain());
    pair.light(scene::LightKind::disk).only = {"left", "right"};
    Session session = finished(at_level(pair.b.scene, scene::Level::soft));
    const auto before = session.stats().rays.total();
    Light same = session.scene().lights[0];
    same.only = {"right", "left"}, same.intensity = 20;
    ASSERT_TRUE(session.edit({scene::SetLight{0, same}}));
    session.advance(Deadline::never());
    EXPECT_EQ(session.stats().rays.total(), before);
}

TEST(LightLinks, NamesThatNobodyBearsAreTold) {
    Pair pair(plain());
    pair.light(scene::LightKind::point).only = {"left", "rigth"};
    const Problems problems = scene::validate(pair.b.scene, "f");
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_EQ(problems[0].place, "/lights/0/only/1");
    EXPECT_NE(problems[0].text().find("right"), std::string::npos);
}

}  // namespace
}  // namespace crescente::render::testing
