// Small scenes for the tests of the engine, built in code, and a word for rendering them.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>
#include <functional>
#include <string>

#include "accel/random_scenes.h"
#include "io/formats.h"
#include "render/session.h"
#include "scene/validate.h"

namespace crescente::render::testing {

using namespace math;
using accel::testing::Random;
using accel::testing::grid_mesh;
using accel::testing::sphere_mesh;
using scene::ClassicMaterial;
using scene::MaterialId;
using scene::NodeId;
using scene::PhysicalMaterial;

// A scene that is added to piece by piece. Settings: small, one thread, everything exact.
struct Build {
    scene::Scene scene;

    Build(int width, int height) {
        scene.camera.emplace();
        scene::Settings& s = scene.settings;
        s.width = width, s.height = height, s.threads = 1, s.supersampling = 0;
    }
    scene::Settings& settings() { return scene.settings; }
    scene::Camera& camera() { return *scene.camera; }

    MaterialId material(const ClassicMaterial& m) { return keep({"", m}); }
    MaterialId material(const PhysicalMaterial& m) { return keep({"", m}); }

    scene::ShapeId shape(geometry::Shape s) {
        scene.shapes.push_back({"", std::move(s)});
        return {static_cast<std::uint32_t>(scene.shapes.size() - 1)};
    }
    // A node that is not yet anywhere.
    NodeId node(scene::Node n) {
        scene.nodes.push_back(std::move(n));
        return {static_cast<std::uint32_t>(scene.nodes.size() - 1)};
    }
    NodeId place(geometry::Shape s, MaterialId m, const Affine& at = {}) {
        const NodeId id = node({"", at, shape(std::move(s)), {m}, {}, true});
        scene.roots.push_back(id);
        return id;
    }
    scene::Light& light() { return scene.lights.emplace_back(); }
    // A light that is the same at every distance, as in NFF.
    scene::Light& steady_light(Vec3 position, Rgb color = {1, 1, 1}) {
        scene::Light& l = light();
        l.position = position, l.color = color, l.falloff = scene::Falloff::none;
        return l;
    }
    void uniform_environment(Rgb radiance, double strength) {
        scene.environment.emplace();
        scene.environment->zenith = scene.environment->horizon = scene.environment->nadir = radiance;
        scene.environment->strength = strength;
    }

private:
    MaterialId keep(scene::Material m) {
        scene.materials.push_back(std::move(m));
        return {static_cast<std::uint32_t>(scene.materials.size() - 1)};
    }
};

inline ClassicMaterial matte(Rgb diffuse) {
    ClassicMaterial m;
    m.diffuse = diffuse;
    return m;
}
// Shines by itself, and does nothing else.
inline ClassicMaterial glow(Rgb emission) {
    ClassicMaterial m;
    m.diffuse = {}, m.emission = emission;
    return m;
}
inline ClassicMaterial mirror(Rgb reflection) {
    ClassicMaterial m;
    m.diffuse = {}, m.reflection = reflection;
    return m;
}
inline ClassicMaterial glass(Rgb transmission, double ior, bool fresnel = false) {
    ClassicMaterial m;
    m.diffuse = {}, m.transmission = transmission, m.ior = ior, m.fresnel = fresnel;
    if (fresnel) m.reflection = {1, 1, 1};
    return m;
}

inline geometry::Box box(Vec3 lower, Vec3 upper) {
    geometry::Box b;
    b.lower = lower, b.upper = upper;
    return b;
}
inline geometry::Sphere sphere(double radius) {
    geometry::Sphere s;
    s.radius = radius;
    return s;
}
inline Affine at(Vec3 place) { return Affine::translation(place); }

// The session of a valid scene.
inline Session opened(scene::Scene scene) {
    const Problems problems = scene::validate(scene, "test");
    for (const Problem& p : problems) ADD_FAILURE() << p.text();
    auto session = Session::open(std::move(scene));
    if (!session) throw std::runtime_error(session.error().text());
    return std::move(*session);
}
inline Session finished(scene::Scene scene) {
    Session session = opened(std::move(scene));
    EXPECT_TRUE(session.advance(Deadline::never()).done);
    return session;
}
inline scene::Image picture_of(scene::Scene scene) { return finished(std::move(scene)).picture(); }

inline Rgb pixel(const scene::Image& image, int x, int y) {
    const float* v = &image.layers[0].values[3 * (static_cast<std::size_t>(y) * image.width + x)];
    return {v[0], v[1], v[2]};
}
inline const scene::Layer& layer(const scene::Image& image, const std::string& name) {
    for (const scene::Layer& l : image.layers) {
        if (l.name == name) return l;
    }
    throw std::runtime_error("no layer " + name);
}
// Channel values of a pixel in a layer.
inline std::vector<float> values(const scene::Image& image, const std::string& name, int x, int y) {
    const scene::Layer& l = layer(image, name);
    const std::size_t n = l.channels.size(), first = n * (static_cast<std::size_t>(y) * image.width + x);
    return {l.values.begin() + static_cast<std::ptrdiff_t>(first), l.values.begin() + static_cast<std::ptrdiff_t>(first + n)};
}

// Equal to the bit, in every layer.
inline ::testing::AssertionResult same_picture(const scene::Image& a, const scene::Image& b) {
    if (a.width != b.width || a.height != b.height || a.layers.size() != b.layers.size()) return ::testing::AssertionFailure() << "other shape";
    for (std::size_t l = 0; l < a.layers.size(); ++l) {
        const auto &x = a.layers[l].values, &y = b.layers[l].values;
        if (x.size() != y.size()) return ::testing::AssertionFailure() << "layer " << a.layers[l].name << ": other size";
        if (std::memcmp(x.data(), y.data(), x.size() * sizeof(float)) == 0) continue;
        std::size_t differing = 0, first = x.size();
        for (std::size_t i = x.size(); i-- > 0;) {
            if (std::memcmp(&x[i], &y[i], sizeof(float)) != 0) ++differing, first = i;
        }
        const std::size_t channels = a.layers[l].channels.size();
        return ::testing::AssertionFailure() << "layer " << a.layers[l].name << ": " << differing << " values differ, first at pixel "
                                             << first / channels % a.width << "," << first / channels / a.width << ": " << x[first] << " and " << y[first];
    }
    return ::testing::AssertionSuccess();
}

// Of the values of the color layer; the pictures have the same size.
inline double mean_difference(const scene::Image& a, const scene::Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.layers[0].values.size(); ++i) sum += std::abs(double(a.layers[0].values[i]) - double(b.layers[0].values[i]));
    return sum / static_cast<double>(a.layers[0].values.size());
}

inline void expect_near(Rgb got, Rgb expected, double tolerance) {
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(got[k], expected[k], tolerance) << "channel " << k;
}

// A mesh of a sphere whose corners have the sphere's own normals.
inline geometry::Mesh smooth_sphere_mesh(int rings, int segments) {
    geometry::Mesh mesh = sphere_mesh(rings, segments);
    for (const Vec3& p : mesh.positions) mesh.normals.push_back({float(p.x), float(p.y), float(p.z)});
    return mesh;
}

inline std::filesystem::path spd_file(const std::string& name) {
    return std::filesystem::path(CRESCENTE_SHARED) / "assets" / "spd" / "nff" / (name + ".nff");
}

// Everything at once: mirrors, glass, coloured panes, metal and plastic, every kind of light and shape.
inline scene::Scene still_life() {
    Build s(75, 53);
    s.settings().supersampling = 2, s.settings().depth = 6, s.settings().tile = 32;
    s.camera().position = {0, 2.2, 7}, s.camera().target = {0, 0.8, 0};
    ClassicMaterial floor = matte({0.7f, 0.6f, 0.5f});
    floor.reflection = {0.15f, 0.15f, 0.2f};
    s.place(geometry::Plane{}, s.material(floor));
    ClassicMaterial chrome = mirror({0.8f, 0.85f, 0.9f});
    chrome.specular = {0.6f, 0.6f, 0.6f}, chrome.highlight = scene::Highlight::blinn;
    s.place(sphere(0.8), s.material(chrome), at({-1.6, 0.8, 0}));
    ClassicMaterial clear = glass({0.9f, 0.95f, 0.9f}, 1.5, true);
    clear.attenuation = {0.3f, 0.05f, 0.2f};
    s.place(sphere(0.7), s.material(clear), at({0.2, 0.7, 1.4}));
    const MaterialId red = s.material(glass({0.9f, 0.2f, 0.1f}, 1)), blue = s.material(glass({0.1f, 0.3f, 0.9f}, 1));
    s.place(box({0.9, 0, -0.5}, {0.95, 1.6, 0.9}), red);
    s.place(box({1.2, 0, -0.6}, {1.25, 1.4, 0.8}), blue, Affine::rotation({0, 1, 0}, 0.2));
    PhysicalMaterial gold;
    gold.base_color = {1, 0.77f, 0.34f}, gold.metallic = 1, gold.roughness = 0.15;
    s.place(geometry::Torus{}, s.material(gold), at({0.6, 0.3, -1.2}) * Affine::rotation({1, 0, 0.3}, 0.6) * Affine::scaling({0.8, 1.1, 0.8}));
    PhysicalMaterial plastic;
    plastic.base_color = {0.2f, 0.5f, 0.3f}, plastic.roughness = 0.3, plastic.opacity = 0.7;
    s.place(geometry::Cone{}, s.material(plastic), at({2.3, 0, -0.5}));
    s.place(geometry::Cylinder{}, s.material(matte({0.3f, 0.3f, 0.8f})), at({-2.9, 0, -1}) * Affine::rotation({0, 0, 1}, -0.1));
    s.place(smooth_sphere_mesh(7, 10), s.material(plastic), at({-0.4, 0.5, 2.9}) * Affine::scaling({0.35, 0.5, 0.3}));
    scene::Light& spot = s.light();
    spot.position = {2, 5, 4}, spot.direction = {-0.4, -1, -0.8}, spot.intensity = 40;
    spot.inner_angle = 0.2, spot.outer_angle = 0.7;
    scene::Light& lamp = s.light();
    lamp.position = {-4, 3, 3}, lamp.falloff = scene::Falloff::classic, lamp.linear = 0.2, lamp.quadratic = 0.05, lamp.color = {1, 0.8f, 0.6f};
    scene::Light& sun = s.light();
    sun.kind = scene::LightKind::directional, sun.direction = {0.5, -1, -0.3}, sun.intensity = 0.4;
    s.scene.environment = scene::Environment{{0.2f, 0.3f, 0.6f}, {0.5f, 0.5f, 0.5f}, {0.1f, 0.1f, 0.1f}, true, {0.1f, 0.1f, 0.2f}, {0.3f, 0.3f, 0.4f}, false, 0.5, 0, {}, {}, {}};
    return s.scene;
}

// One group in many places, stretched and mirrored.
inline scene::Scene instances() {
    Build s(64, 48);
    s.settings().supersampling = 1, s.settings().depth = 4, s.settings().tile = 24;
    s.camera().position = {3, 4, 9};
    const MaterialId shiny = s.material(mirror({0.5f, 0.5f, 0.4f})), tinted = s.material(glass({0.6f, 0.8f, 0.5f}, 1.3)),
                     dull = s.material(matte({0.8f, 0.4f, 0.3f}));
    const NodeId ball = s.node({"ball", at({0, 0.5, 0}), s.shape(sphere(0.5)), {}, {}, true});
    const NodeId block = s.node({"block", at({0.6, 0, 0}), s.shape(box({-0.3, -0.3, -0.3}, {0.3, 0.3, 0.3})), {tinted}, {}, true});
    const NodeId group = s.node({"group", {}, {}, {}, {ball, block}, true});
    Random random(7);
    for (int i = 0; i < 24; ++i) {
        const Affine place = at(random.in_cube(3)) * Affine::rotation(random.direction(), random.uniform(0, 6)) *
                             Affine::scaling({random.uniform(0.3, 2), random.uniform(0.3, 2), i % 3 ? 1.0 : -0.7});
        s.scene.roots.push_back(s.node({"", place, {}, {i % 2 ? shiny : dull}, {group}, true}));
    }
    s.steady_light({5, 8, 6}, {0.7f, 0.7f, 0.7f});
    s.steady_light({-6, 5, 2}, {0.3f, 0.2f, 0.4f});
    return s.scene;
}

// Surfaces that lie in one another, of different colours: who is seen must not depend on anything but identity.
inline scene::Scene coincident() {
    Build s(66, 50);
    s.settings().supersampling = 1, s.settings().depth = 4, s.settings().tile = 20;
    s.camera().position = {2, 3, 6};
    const Rgb colors[] = {{0.9f, 0.1f, 0.1f}, {0.1f, 0.9f, 0.1f}, {0.1f, 0.1f, 0.9f}, {0.8f, 0.8f, 0.1f}};
    for (int i = 0; i < 4; ++i) {
        ClassicMaterial m = matte(colors[i]);
        m.reflection = {0.3f, 0.3f, 0.3f};
        if (i == 3) m.transmission = {0.4f, 0.5f, 0.3f};
        const MaterialId id = s.material(m);
        s.place(grid_mesh(6, 0), id, Affine::scaling({1.0 + 0.25 * i, 1.0 + 0.25 * i, 1}));
        s.place(box({-1 + 0.5 * i, -1, -1}, {-0.5 + 0.5 * i, 1, 1}), id);
        s.place(sphere_mesh(6, 9), id, at({0, 1.2, 0}));
    }
    s.steady_light({3, 6, 5});
    return s.scene;
}

}  // namespace crescente::render::testing
