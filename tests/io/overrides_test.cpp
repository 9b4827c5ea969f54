#include "io/overrides.h"

#include <gtest/gtest.h>

using namespace crescente;
using namespace crescente::scene;

namespace {

Scene some_scene() {
    Scene scene;
    scene.unit = {"mm", 0.001};
    scene.camera = Camera{};
    scene.materials = {{"chrome", PhysicalMaterial{}}, {"part.7=a", ClassicMaterial{}}, {"twin", PhysicalMaterial{}}, {"twin", PhysicalMaterial{}}, {"", PhysicalMaterial{}}};
    scene.lights.resize(1);
    scene.lights[0].name = "key";
    scene.shapes = {{"ball", geometry::Sphere{}}};
    return scene;
}

std::string problem_of(std::string_view assignment) {
    Scene scene = some_scene();
    const auto done = io::apply_override(scene, assignment);
    if (done) return "no problem";
    EXPECT_EQ(done.error().kind, ErrorKind::usage);
    EXPECT_EQ(done.error().problems.size(), 1u);
    EXPECT_EQ(done.error().problems[0].place, assignment);
    return done.error().problems[0].reason + " (" + done.error().problems[0].hint + ")";
}

void apply(Scene& scene, std::string_view assignment) {
    const auto done = io::apply_override(scene, assignment);
    ASSERT_TRUE(done) << done.error().text();
}

}  // namespace

TEST(Overrides, EveryKindOfThing) {
    Scene s = some_scene();
    apply(s, "material.chrome.roughness=0.1");
    EXPECT_EQ(std::get<PhysicalMaterial>(s.materials[0].model).roughness, 0.1);
    apply(s, "settings.threshold=0.01");
    EXPECT_EQ(s.settings.threshold, 0.01);
    apply(s, "light.key.intensity=3");
    EXPECT_EQ(s.lights[0].intensity, 3);
    apply(s, "environment.zenith=0.25");  // made where there was none
    ASSERT_TRUE(s.environment);
    EXPECT_EQ(s.environment->zenith, math::gray(0.25f));
    apply(s, "shape.ball.radius=20");
    EXPECT_EQ(std::get<geometry::Sphere>(s.shapes[0].shape).radius, 0.02);
}

TEST(Overrides, ValuesAsInFiles) {
    Scene s = some_scene();
    apply(s, "camera.position=1000,2000,-500");  // in the scene's millimetres
    EXPECT_EQ(s.camera->position, (math::Vec3{1, 2, -0.5}));
    apply(s, "camera.position=[1, 2, 3]");
    EXPECT_EQ(s.camera->position, (math::Vec3{0.001, 0.002, 0.003}));
    apply(s, "camera.projection=orthographic");
    EXPECT_EQ(s.camera->projection, Projection::orthographic);
    apply(s, "camera.field_of_view=90");
    EXPECT_DOUBLE_EQ(s.camera->field_of_view, math::pi / 2);
    apply(s, "light.key.color=#ff0000");
    EXPECT_EQ(s.lights[0].color, (math::Rgb{1, 0, 0}));
    apply(s, "light.key.color=0.5,1,2");
    EXPECT_EQ(s.lights[0].color, (math::Rgb{0.5f, 1, 2}));
    apply(s, "light.key.shadows=false");
    EXPECT_FALSE(s.lights[0].shadows);
    apply(s, "environment.sky=160,40");
    EXPECT_EQ(s.environment->sky, "160,40");
    apply(s, "settings.width=640");
    EXPECT_EQ(s.settings.width, 640);
}

TEST(Overrides, Names) {
    Scene s = some_scene();
    apply(s, "material.part.7=a.ior=1.4");
    EXPECT_EQ(std::get<ClassicMaterial>(s.materials[1].model).ior, 1.4);
    apply(s, "material.\"part.7=a\".ior=1.3");
    EXPECT_EQ(std::get<ClassicMaterial>(s.materials[1].model).ior, 1.3);
    apply(s, "material.twin.metallic=1");
    EXPECT_EQ(std::get<PhysicalMaterial>(s.materials[2].model).metallic, 1);
    EXPECT_EQ(std::get<PhysicalMaterial>(s.materials[3].model).metallic, 1);
    apply(s, "material.4.metallic=0.5");
    EXPECT_EQ(std::get<PhysicalMaterial>(s.materials[4].model).metallic, 0.5);
}

TEST(Overrides, WrongPartsAreToldWithTheNearestSpelling) {
    EXPECT_EQ(problem_of("materail.chrome.roughness=1"), "'materail' is nothing that can be set (did you mean 'material'?)");
    EXPECT_EQ(problem_of("material.crome.roughness=1"), "there is no material 'crome' (did you mean 'chrome'?)");
    EXPECT_EQ(problem_of("material.chrome.roughnes=1"), "'roughnes' is no field of material (did you mean 'roughness'?)");
    EXPECT_EQ(problem_of("camera.projection=ortographic"), "'ortographic' is no choice for projection (did you mean 'orthographic'?)");
    EXPECT_EQ(problem_of("material.chrome.roughness=2"), "is 2, must be from 0 to 1 ()");
    EXPECT_EQ(problem_of("shape.ball.radius=-3"), "is -3 mm, must be at least 0 mm ()");
    EXPECT_EQ(problem_of("settings.width=wide"), "is a text, must be a whole number ()");
    EXPECT_EQ(problem_of("settings.width=1e999"), "is a text, must be a whole number ()");
    EXPECT_EQ(problem_of("camera.position=1,2"), "has 2 elements, must have 3 ()");
    for (const char* bad : {"", "=", "settings", "settings=3", "settings.width", "material.roughness=1", "camera.x.position=1,2,3", "a.b=c", "..=.", "light.key.color=#12345g"}) {
        EXPECT_NE(problem_of(bad), "no problem") << bad;
    }
}

TEST(Overrides, NoCameraIsTold) {
    Scene scene;
    const auto done = io::apply_override(scene, "camera.position=1,2,3");
    ASSERT_FALSE(done);
    EXPECT_FALSE(scene.camera);
}

TEST(Overrides, AFailedOneChangesNothing) {
    Scene s = some_scene();
    EXPECT_FALSE(io::apply_override(s, "environment.zenith=-1"));
    EXPECT_FALSE(s.environment);
    s.materials[3].model = ClassicMaterial{};  // one of the twins has no such field
    EXPECT_FALSE(io::apply_override(s, "material.twin.metallic=1"));
    EXPECT_EQ(std::get<PhysicalMaterial>(s.materials[2].model).metallic, 0);
}
