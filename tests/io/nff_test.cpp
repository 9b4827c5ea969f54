#include "io/nff.h"

#include <numbers>

#include "reader_check.h"
#include "scene/validate.h"

namespace crescente::io {
namespace {

const std::string view = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 320 200\n";

Expected<Loaded> read(const std::string& text) { return read_nff(text, "test.nff"); }

const scene::ClassicMaterial& classic(const scene::Scene& scene, std::size_t i) {
    return std::get<scene::ClassicMaterial>(scene.materials.at(i).model);
}

template <class Shape>
const Shape& shape(const Loaded& loaded, std::size_t i) {
    return std::get<Shape>(loaded.scene.shapes.at(i).shape);
}

TEST(Nff, BallsOfTheStandardProceduralDatabases) {
    REQUIRE_ASSET("spd/nff/balls4.nff");
    const auto loaded = read_nff_file(asset("spd/nff/balls4.nff"));
    ASSERT_TRUE(loaded) << loaded.error().text();
    const scene::Scene& scene = loaded->scene;
    std::size_t spheres = 0;
    for (const auto& s : scene.shapes) spheres += std::holds_alternative<geometry::Sphere>(s.shape);
    EXPECT_EQ(spheres, 7381u);
    EXPECT_EQ(triangles_in(scene), 2u);  // the ground, in two
    EXPECT_EQ(appearances_in(scene), 7382u);
    ASSERT_EQ(scene.lights.size(), 3u);
    for (const auto& light : scene.lights) {
        EXPECT_DOUBLE_EQ(light.intensity, 1 / std::numbers::sqrt3);
        EXPECT_EQ(light.falloff, scene::Falloff::none);
        EXPECT_TRUE(light.shadows);
    }
    ASSERT_EQ(scene.materials.size(), 2u);
    const auto& ball = classic(scene, 1);
    EXPECT_EQ(ball.diffuse, (math::Rgb{0.5f, 0.45f, 0.35f}));
    EXPECT_EQ(ball.specular, math::gray(0.5f));
    EXPECT_EQ(ball.reflection, math::gray(0.5f));
    EXPECT_DOUBLE_EQ(ball.shininess, 3.0827);
    EXPECT_FALSE(ball.fresnel);
    ASSERT_TRUE(scene.camera);
    EXPECT_EQ(scene.camera->position, (math::Vec3{2.1, 1.3, 1.7}));
    EXPECT_EQ(scene.camera->up, (math::Vec3{0, 0, 1}));
    EXPECT_DOUBLE_EQ(scene.camera->field_of_view, math::pi / 4);
    EXPECT_DOUBLE_EQ(scene.camera->near, 0.01);
    EXPECT_EQ(scene.settings.width, 512);
    EXPECT_EQ(scene.settings.depth, 4);
    ASSERT_TRUE(scene.environment);
    EXPECT_EQ(scene.environment->zenith, (math::Rgb{0.078f, 0.361f, 0.753f}));
    EXPECT_EQ(scene.environment->zenith, scene.environment->nadir);
    EXPECT_EQ(scene.environment->strength, 0);
    EXPECT_TRUE(scene::validate(scene, "balls4.nff").empty());
}

TEST(Nff, MountTeapotAndTetra) {
    REQUIRE_ASSET("spd/nff/mount6.nff");
    const auto mount = read_nff_file(asset("spd/nff/mount6.nff"));
    ASSERT_TRUE(mount) << mount.error().text();
    EXPECT_EQ(triangles_in(mount->scene), 8192u);
    EXPECT_EQ(mount->scene.shapes.size(), 5u);  // four spheres, and all faces in one mesh
    EXPECT_EQ(classic(mount->scene, 0).transmission, math::gray(0.9f));
    EXPECT_EQ(classic(mount->scene, 0).ior, 1.5);
    EXPECT_EQ(classic(mount->scene, 1).ior, 1);  // 0 in the file, of no effect where nothing is transmitted
    EXPECT_EQ(mount->scene.lights.at(0).intensity, 1);

    const auto teapot = read_nff_file(asset("spd/nff/teapot12.nff"));
    ASSERT_TRUE(teapot) << teapot.error().text();
    EXPECT_EQ(triangles_in(teapot->scene), 9120u + 2 * 144u);
    std::size_t smooth = 0;
    for (const auto& s : teapot->scene.shapes) {
        const auto& mesh = std::get<geometry::Mesh>(s.shape);
        if (mesh.normals.empty()) continue;
        smooth += mesh.triangles.size();
        ASSERT_EQ(mesh.normals.size(), 3 * mesh.triangles.size());
        for (const auto& n : mesh.normals) ASSERT_NEAR(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
    }
    EXPECT_EQ(smooth, 9120u);

    const auto tetra = read_nff_file(asset("spd/nff/tetra6.nff"));
    ASSERT_TRUE(tetra) << tetra.error().text();
    EXPECT_EQ(triangles_in(tetra->scene), 4096u);
    for (const auto* loaded : {&mount, &teapot, &tetra}) EXPECT_TRUE(scene::validate((*loaded)->scene, "spd").empty());
}

TEST(Nff, ConesAndCylindersStandWhereTheFileSays) {
    const auto loaded = read(view + "f 1 1 1 1 0 1 0 1\nc\n1 2 3 0.5\n4 2 3 0.25\nc 0 0 0 2 0 0 7 2\nc 0 0 0 -1 0 1 0 -1\n");
    ASSERT_TRUE(loaded) << loaded.error().text();
    const auto& cone = shape<geometry::Cone>(*loaded, 0);
    EXPECT_EQ(cone.base_radius, 0.5);
    EXPECT_EQ(cone.top_radius, 0.25);
    EXPECT_DOUBLE_EQ(cone.height, 3);
    EXPECT_FALSE(cone.capped);
    const math::Affine& place = loaded->scene.nodes.at(1).transform;
    EXPECT_EQ(place.point({0, 0, 0}), (math::Vec3{1, 2, 3}));
    EXPECT_NEAR(length(place.point({0, 3, 0}) - math::Vec3{4, 2, 3}), 0, 1e-12);
    EXPECT_NEAR(place.determinant(), 1, 1e-12);
    EXPECT_EQ(shape<geometry::Cylinder>(*loaded, 1).height, 7);
    EXPECT_EQ(shape<geometry::Cylinder>(*loaded, 2).radius, 1);
    EXPECT_TRUE(warns_of(*loaded, "negative radii"));
}

TEST(Nff, ConvexFacesAreGatheredByMaterialOthersStayPolygons) {
    const auto loaded = read(view +
                             "f 1 0 0 1 0 1 0 1\np 3\n0 0 0\n1 0 0\n0 1 0\n"
                             "f 0 1 0 1 0 1 0 1\np 4\n0 0 0 1 0 0 1 1 0 0 1 0\n"
                             "f 1 0 0 1 0 1 0 1\np 5\n0 0 0 2 0 0 2 2 0 1 3 0 0 2 0\n"   // convex: three more of the first material
                             "p 4\n0 0 0\n2 0 0\n0.5 0.5 0\n0 2 0\n"                       // a dart
                             "p 5\n0 1 0\n0.588 -0.809 0\n-0.951 0.309 0\n0.951 0.309 0\n-0.588 -0.809 0\n");  // a pentagram
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_EQ(loaded->scene.materials.size(), 2u);
    ASSERT_EQ(loaded->scene.shapes.size(), 4u);
    EXPECT_EQ(shape<geometry::Mesh>(*loaded, 0).triangles.size(), 4u);
    EXPECT_EQ(shape<geometry::Polygon>(*loaded, 1).loops.at(0).size(), 4u);
    EXPECT_EQ(shape<geometry::Polygon>(*loaded, 2).loops.at(0).size(), 5u);
    EXPECT_EQ(shape<geometry::Mesh>(*loaded, 3).triangles.size(), 2u);
}

TEST(Nff, FacesWithoutAreaAreDroppedAndTold) {
    const auto loaded = read(view + "f 1 1 1 1 0 1 0 1\np 3\n0 0 0\n1 1 1\n2 2 2\np 3\n0 0 0\n1 0 0\n0 1 0\n");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(triangles_in(loaded->scene), 1u);
    EXPECT_TRUE(warns_of(*loaded, "1 polygons have no area"));
}

TEST(Nff, LightsWithoutColourShareOneBrightness) {
    const auto loaded = read(view + "l 1 2 3\nl 4 5 6 0.5 0.25 0.125 # coloured\ns 0 0 0 1\n");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_DOUBLE_EQ(loaded->scene.lights.at(0).intensity, std::numbers::sqrt2 / 2);
    EXPECT_EQ(loaded->scene.lights.at(1).intensity, 1);
    EXPECT_EQ(loaded->scene.lights.at(1).color, (math::Rgb{0.5f, 0.25f, 0.125f}));
}

TEST(Nff, TransmissionTakesTheColourAndAmbientTheExtension) {
    const auto loaded = read(view + "f 0.5 1 0.25 0.1 0.2 30 0.8 1.3 0.5\ns 0 0 0 1\n");
    ASSERT_TRUE(loaded) << loaded.error().text();
    const auto& glass = classic(loaded->scene, 0);
    EXPECT_EQ(glass.transmission, (math::Rgb{0.4f, 0.8f, 0.2f}));
    EXPECT_EQ(glass.ambient, (math::Rgb{0.25f, 0.5f, 0.125f}));
    EXPECT_EQ(glass.ior, 1.3);
    EXPECT_EQ(glass.shininess, 30);
}

TEST(Nff, AllProblemsAreToldWithTheirLines) {
    const auto loaded = read("b 0 0 nan\nv\nform 0 0 5\nat 0 0 0\nup 0 1 0\nangle 190\nresolution 10.5 10\nq 1 2 3\ns 0 0 0\nl 1e999 0 0\n"
                             "c 0 0 0 1 0 0 0 1\nc 0 0 0 -1 0 1 0 1\np 2\n0 0 0\n1 1 1\nf 1 1 1 1 1 1 0.5 0\ns 0 0 0 0\n");
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().kind, ErrorKind::input);
    const Error& error = loaded.error();
    EXPECT_TRUE(tells(error, "line 1: 'nan' is not a finite number"));
    EXPECT_TRUE(tells(error, "line 3: unexpected 'form' (did you mean 'from'?)"));
    EXPECT_TRUE(tells(error, "line 6: the angle must be between"));
    EXPECT_TRUE(tells(error, "line 7: the resolution"));
    EXPECT_TRUE(tells(error, "line 8: unexpected 'q'"));
    EXPECT_TRUE(tells(error, "line 9: a value is missing: s:"));
    EXPECT_TRUE(tells(error, "line 10: '1e999' is not a finite number"));
    EXPECT_TRUE(tells(error, "line 11: base and apex"));
    EXPECT_TRUE(tells(error, "line 12: the radii of a cone must have the same sign"));
    EXPECT_TRUE(tells(error, "line 13: a polygon has"));
    EXPECT_TRUE(tells(error, "line 16: a transmitting fill"));
    EXPECT_TRUE(tells(error, "line 17: the radius of a sphere"));
    EXPECT_EQ(error.problems.size(), 12u) << error.text();
}

TEST(Nff, AViewMustBeComplete) {
    const auto loaded = read("v\nfrom 0 0 5\nat 0 0 0\nangle 40\nresolution 10 10\ns 0 0 0 1\n");
    ASSERT_FALSE(loaded);
    EXPECT_TRUE(tells(loaded.error(), "line 1: the view lacks 'up'")) << loaded.error().text();
}

TEST(Nff, ProblemsAreBounded) {
    std::string text = view;
    for (int i = 0; i < 1000; ++i) text += "wrong\n";
    const auto loaded = read(text);
    ASSERT_FALSE(loaded);
    EXPECT_EQ(loaded.error().problems.size(), 50u);
}

TEST(Nff, NumbersInAllTheirForms) {
    const auto loaded = read(view + "s +1 -.5 2.e-1 1E0\r\ns 1e-400 0 0 0.00001#comment\n#\n\t s\n0\n0\n0\n1");
    ASSERT_TRUE(loaded) << loaded.error().text();
    EXPECT_EQ(loaded->scene.nodes.at(1).transform.origin, (math::Vec3{1, -0.5, 0.2}));
    EXPECT_EQ(loaded->scene.nodes.at(2).transform.origin.x, 0);
    EXPECT_EQ(loaded->scene.shapes.size(), 3u);
    EXPECT_TRUE(warns_of(*loaded, "3 objects come before the first fill"));
}

TEST(Nff, APolygonCannotPromiseMoreThanTheFileHolds) {
    const auto loaded = read(view + "p 4000000000\n0 0 0\n1 0 0\n0 1 0\n");
    ASSERT_FALSE(loaded);
    EXPECT_TRUE(tells(loaded.error(), "more vertices than the rest of the file can hold"));
}

TEST(Nff, AFileCutAnywhereIsAnErrorOrAShorterScene) {
    const std::string whole = view + "b 0.1 0.2 0.3\nl 1 2 3\nf 1 0.5 0.25 0.5 0.5 10 0.5 1.5\ns 0 0 0 1\nc 0 0 0 1 0 1 0 0\n"
                                     "p 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\npp 3\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n";
    const auto complete = read(whole);
    ASSERT_TRUE(complete);
    std::size_t errors = 0;
    for_each_cut(whole, whole.size(), read, [&](std::size_t length, const Expected<Loaded>& cut) {
        if (cut) {
            EXPECT_LE(cut->scene.shapes.size(), complete->scene.shapes.size());
            return;
        }
        ++errors;
        EXPECT_EQ(cut.error().kind, ErrorKind::input);
        EXPECT_FALSE(cut.error().problems.empty()) << length;
    });
    EXPECT_GT(errors, whole.size() / 2);
}

}  // namespace
}  // namespace crescente::io
