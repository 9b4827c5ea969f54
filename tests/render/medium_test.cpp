// What a medium takes of the light, wherever the camera, the lamp and other bodies are: Beer and Lambert on one axis.
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

const Rgb water{0.1f, 0.05f, 0.2f}, ink{0.3f, 0.7f, 0.1f};

// Everything lies on the z axis, which the picture looks down so narrowly that all its rays are as long. A block of water from z = -5 to 5.
Build tank(double eye) {
    Build s(2, 2);
    s.camera().position = {0, 0, eye}, s.camera().target = {0, 0, eye - 1};
    s.camera().field_of_view = 0.002;
    ClassicMaterial m = glass({1, 1, 1}, 1);
    m.attenuation = water;
    s.place(box({-5, -5, -5}, {5, 5, 5}), s.material(m));
    return s;
}
geometry::Box plate(double lower, double upper) { return box({-2, -2, lower}, {2, 2, upper}); }

Rgb left(Rgb attenuation, double length) {
    return {float(std::exp(-attenuation.r * length)), float(std::exp(-attenuation.g * length)), float(std::exp(-attenuation.b * length))};
}
void expect_all(const Build& s, Rgb expected) {
    for (const auto projection : {scene::Projection::perspective, scene::Projection::orthographic}) {
        scene::Scene scene = s.scene;
        // An orthographic camera is nowhere: it knows only the bodies whose surface it sees from inside.
        if (projection == scene::Projection::orthographic && std::abs(scene.camera->position.z) < 5) continue;
        scene.camera->projection = projection, scene.camera->height = 0.002;
        const scene::Image picture = picture_of(scene);
        for (int i = 0; i < 4; ++i) expect_near(pixel(picture, i % 2, i / 2), expected, 2e-5);
    }
}

TEST(Medium, WhereverTheCameraIs) {
    for (const auto& [eye, inside] : {std::pair{10.0, 10.0}, {4.0, 9.0}, {-4.5, 0.5}, {-6.0, 0.0}}) {
        SCOPED_TRACE(eye);
        Build s = tank(eye);
        s.place(plate(-8, -7), s.material(glow({1, 1, 1})));
        expect_all(s, left(water, inside));
    }
}

TEST(Medium, ABodyInItIsSeenThroughIt) {
    for (const auto& [eye, inside] : {std::pair{10.0, 8.0}, {4.0, 7.0}}) {
        Build s = tank(eye);
        s.place(plate(-4, -3), s.material(glow({1, 1, 1})));
        expect_all(s, left(water, inside));
    }
}

TEST(Medium, AMirrorInItSendsLightBackThroughIt) {
    for (const auto& [eye, to_mirror] : {std::pair{10.0, 7.0}, {4.0, 6.0}}) {
        for (const auto& [lamp, from_mirror] : {std::pair{4.5, 6.5}, {12.0, 7.0}}) {  // behind the camera, inside or outside
            if (eye > lamp) continue;
            Build s = tank(eye);
            s.place(plate(-3, -2), s.material(mirror({1, 1, 1})));
            s.place(plate(lamp, lamp + 1), s.material(glow({1, 1, 1})));
            expect_all(s, left(water, to_mirror + from_mirror));
        }
    }
}

TEST(Medium, BodiesInBodiesAbsorbEachOnItsOwn) {
    Build s = tank(10);
    ClassicMaterial m = glass({1, 1, 1}, 1);
    m.attenuation = ink;
    s.place(plate(-1, 1), s.material(m));
    s.place(plate(-8, -7), s.material(glow({1, 1, 1})));
    expect_all(s, left(water, 10) * left(ink, 2));
    s.place(plate(-0.5, 0), s.material(mirror({1, 1, 1})));
    s.place(plate(12, 13), s.material(glow({1, 1, 1})));
    expect_all(s, left(water, 10) * left(ink, 2));
}

TEST(Medium, LightComesThroughIt) {
    for (const double eye : {10.0, 0.0}) {
        const double seen = std::min(5.0, eye) + 3;
        for (const double lamp : {2.0, 9.0, 11.0}) {
            SCOPED_TRACE(lamp);
            Build s = tank(eye);
            s.place(plate(-4, -3), s.material(matte({1, 1, 1})));
            s.steady_light({0, 0, lamp});
            expect_all(s, left(water, seen + std::min(5.0, lamp) + 3));
        }
        Build s = tank(eye);
        s.place(plate(-4, -3), s.material(matte({1, 1, 1})));
        scene::Light& sun = s.light();
        sun.kind = scene::LightKind::directional, sun.direction = {0, 0, -1};
        expect_all(s, left(water, seen + 8));
    }
}

// An absorbing surface without an end, as that of a sea: what lies below is in it, the sky is not.
TEST(Medium, ASurfaceWithoutEndIsASea) {
    for (const double eye : {3.0, -1.0}) {
        Build s(2, 2);
        s.camera().position = {0, 0, eye}, s.camera().target = {0, 0, -10};
        s.camera().field_of_view = 0.002;
        ClassicMaterial m = glass({1, 1, 1}, 1);
        m.attenuation = water;
        s.place(geometry::Plane{}, s.material(m), Affine::rotation({1, 0, 0}, 0.5 * pi));
        s.place(plate(-5, -4), s.material(matte({1, 1, 1})));
        s.steady_light({0, 0, 2});
        expect_all(s, left(water, 4 + std::min(0.0, eye) + 4));
    }
}

}  // namespace
}  // namespace crescente::render::testing
