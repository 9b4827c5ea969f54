// Small scenes that are hard for accelerators. A scene is a pure function of its recipe, so that a failure can be repeated.
#pragma once

#include <cmath>
#include <cstdint>
#include <deque>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "accel/accelerator.h"

namespace crescente::accel::testing {

class Random {
public:
    explicit Random(std::uint64_t seed) : engine_(seed) {}

    double uniform(double low = 0, double high = 1) { return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53; }
    std::size_t below(std::size_t count) { return engine_() % count; }
    bool chance(double probability) { return uniform() < probability; }
    Vec3 in_cube(double half = 1) { return {uniform(-half, half), uniform(-half, half), uniform(-half, half)}; }
    Vec3 direction() {
        const double z = uniform(-1, 1), angle = uniform(0, 2 * pi), r = std::sqrt(std::max(0.0, 1 - z * z));
        return normalize({r * std::cos(angle), r * std::sin(angle), z});
    }

private:
    std::mt19937_64 engine_;
};

struct TestScene {
    std::string name;
    std::uint64_t seed = 0;
    std::deque<geometry::Shape> shapes;  // a deque: instances point at them
    std::vector<Instance> instances;
    std::vector<Vec3> targets;  // vertices, edge midpoints and centres, in the world
    Vec3 center;
    double radius = 1;

    TestScene() = default;
    TestScene(TestScene&&) = default;
    TestScene(const TestScene&) = delete;
};

struct Recipe {
    std::string name;
    std::uint64_t seed = 1;
    double scale = 1;  // the scene fills a cube of half edge `scale` about `offset`
    Vec3 offset{};
};

inline geometry::Mesh sphere_mesh(int rings, int segments, double bumps = 0) {
    geometry::Mesh mesh;
    mesh.positions.push_back({0, 0, 1});
    for (int i = 1; i < rings; ++i) {
        for (int j = 0; j < segments; ++j) {
            const double theta = pi * i / rings, phi = 2 * pi * j / segments;
            const double r = 1 + bumps * std::sin(5 * theta) * std::sin(3 * phi);
            mesh.positions.push_back(Vec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)} * r);
        }
    }
    mesh.positions.push_back({0, 0, -1});
    const auto at = [&](int ring, int segment) { return static_cast<std::uint32_t>(1 + (ring - 1) * segments + segment % segments); };
    const auto last = static_cast<std::uint32_t>(mesh.positions.size() - 1);
    for (int j = 0; j < segments; ++j) {
        mesh.triangles.push_back({0, at(1, j), at(1, j + 1)});
        for (int i = 1; i + 1 < rings; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
        mesh.triangles.push_back({at(rings - 1, j), last, at(rings - 1, j + 1)});
    }
    return mesh;
}

// Flat squares of two triangles each in the plane z = height, parallel to the axes.
inline geometry::Mesh grid_mesh(int n, double height) {
    geometry::Mesh mesh;
    for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) mesh.positions.push_back({2.0 * i / n - 1, 2.0 * j / n - 1, height});
    }
    const auto at = [&](int i, int j) { return static_cast<std::uint32_t>(j * (n + 1) + i); };
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}

// A block with round holes through it along z and a dome on it: planes, cylinders, a sphere and a torus, trimmed.
inline geometry::Brep drilled_block(double band) {
    using namespace geometry;
    std::vector<Face> faces;
    const auto rectangle = [=](double u0, double u1, double v0, double v1) {
        return Loop{{LinePiece{{u0, v0}, {u1, v0}}, band}, {LinePiece{{u1, v0}, {u1, v1}}, band}, {LinePiece{{u1, v1}, {u0, v1}}, band}, {LinePiece{{u0, v1}, {u0, v0}}, band}};
    };
    const auto circle = [=](double u, double v, double r) { return Loop{{ArcPiece{{u, v}, {r, 0}, {0, r}, 0, 2 * pi}, band}}; };
    const auto add = [&](FaceSurface surface, std::vector<Loop> loops, bool reversed, double u0, double u1, double v0, double v1) {
        Face face;
        face.surface = std::move(surface), face.loops = std::move(loops), face.reversed = reversed;
        face.u0 = u0, face.u1 = u1, face.v0 = v0, face.v1 = v1;
        faces.push_back(std::move(face));
    };
    for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-0.5, 0.5}) {
            Frame frame;
            frame.x = frame.y = frame.z = {};
            frame.x[(axis + 1) % 3] = frame.y[(axis + 2) % 3] = frame.z[axis] = 1;
            frame.origin[axis] = side;
            std::vector<Loop> loops{rectangle(-0.5, 0.5, -0.5, 0.5)};
            for (int k = 0; k < 4 && axis == 2; ++k) loops.push_back(circle(k & 1 ? 0.3 : -0.3, k & 2 ? 0.3 : -0.3, 0.1));
            if (axis == 2 && side > 0) loops.push_back(circle(0, 0, 0.2));
            add(PlaneSurface{frame}, loops, side < 0, -0.5, 0.5, -0.5, 0.5);
        }
    }
    for (int k = 0; k < 4; ++k) {
        Frame frame;
        frame.origin = {k & 1 ? 0.3 : -0.3, k & 2 ? 0.3 : -0.3, 0};
        add(CylinderSurface{frame, 0.1}, {rectangle(0, 2 * pi, -0.5, 0.5)}, true, 0, 2 * pi, -0.5, 0.5);
    }
    Frame top;
    top.origin = {0, 0, 0.5};
    add(SphereSurface{top, 0.2}, {rectangle(0, 2 * pi, 0, pi / 2)}, false, 0, 2 * pi, 0, pi / 2);
    top.origin = {0, 0, 0.2};
    add(TorusSurface{top, 0.6, 0.1}, {}, false, 0, 2 * pi, 0, 2 * pi);
    auto brep = Brep::make(faces);
    return brep ? std::move(*brep) : Brep();
}

inline geometry::Shape random_shape(Random& random) {
    switch (random.below(10)) {
        case 0: return geometry::Sphere{random.uniform(0.3, 1)};
        case 1: {
            const Vec3 a = random.in_cube(), b = random.in_cube();
            return geometry::Box{min(a, b), max(a, b)};
        }
        case 2: return geometry::Cone{random.uniform(0.2, 1), random.chance(0.5) ? 0 : random.uniform(0.1, 0.5), 1, random.chance(0.5)};
        case 3: return geometry::Cylinder{random.uniform(0.1, 0.8), random.uniform(0.3, 1), random.chance(0.5)};
        case 4: return geometry::Torus{random.uniform(0.4, 0.8), random.uniform(0.05, 0.3)};
        case 5: return geometry::Disk{random.uniform(0.5, 1), random.chance(0.5) ? 0 : random.uniform(0.1, 0.4)};
        case 6: {
            geometry::Polygon polygon;
            const int corners = 3 + static_cast<int>(random.below(5));
            auto& outer = polygon.loops.emplace_back();
            for (int i = 0; i < corners; ++i) outer.push_back({std::cos(2 * pi * i / corners), 0, std::sin(2 * pi * i / corners)});
            if (random.chance(0.5)) polygon.loops.push_back({{0.2, 0, 0}, {0, 0, 0.2}, {-0.2, 0, 0}});
            return polygon;
        }
        case 7: {
            geometry::Bicubic patches;  // two sheets that may cross themselves and each other
            patches.points.resize(2);
            for (auto& points : patches.points) {
                for (std::size_t i = 0; i < 16; ++i) {
                    points[i] = Vec3{double(i / 4) / 1.5 - 1, double(i % 4) / 1.5 - 1, 0} * 0.7 + random.in_cube() * 0.5;
                }
            }
            patches.prepare();
            return patches;
        }
        case 8: {
            geometry::Revolution turned;  // with poles
            turned.profile.push_back({geometry::CurveKind::arc, 3, false, {{0, -1, 0}, {random.uniform(0.3, 1.2), 0.2, 0}, {0, 1, 0}}, {}, {}});
            if (random.chance(0.5)) turned.directrix = {1, 0.5, 1, 0.7};
            turned.prepare();
            return turned;
        }
        default: {
            geometry::Mesh mesh;  // one free triangle
            mesh.positions = {random.in_cube(), random.in_cube(), random.in_cube()};
            mesh.triangles = {{0, 1, 2}};
            return mesh;
        }
    }
}

// Rotation, scaling that differs by axis (up to 10:1), sometimes a mirror or a shear.
inline Affine random_place(Random& random, double size) {
    const auto stretch = [&] { return size * std::pow(10.0, random.uniform(-1, 0)) * (random.chance(0.2) ? -1 : 1); };
    Affine place = Affine::rotation(random.direction(), random.uniform(0, 2 * pi)) * Affine::scaling({stretch(), stretch(), stretch()});
    if (random.chance(0.3)) {
        Affine shear;
        shear.y.x = random.uniform(-1, 1);
        place = place * shear;
    }
    if (random.chance(0.2)) place = Affine::scaling({stretch(), stretch(), stretch()});  // parallel to the axes
    place.origin = random.in_cube();
    return place;
}

class SceneBuilder {
public:
    explicit SceneBuilder(const Recipe& recipe)
        : random(recipe.seed), frame_(Affine::translation(recipe.offset) * Affine::scaling({recipe.scale, recipe.scale, recipe.scale})) {
        scene_.name = recipe.name;
        scene_.seed = recipe.seed;
        scene_.center = recipe.offset;
        scene_.radius = recipe.scale;
    }

    const geometry::Shape& shape(geometry::Shape s) { return scene_.shapes.emplace_back(std::move(s)); }

    void place(const geometry::Shape& s, const Affine& where, bool opaque) {
        static constexpr std::uint8_t one_sided[] = {1};
        Instance& instance = scene_.instances.emplace_back(s, frame_ * where, opaque);
        if (scene_.instances.size() % 5 == 3) instance.one_sided = one_sided;
        scene_.targets.push_back(instance.to_world.point({0, 0, 0}));
        if (const auto* mesh = std::get_if<geometry::Mesh>(&s)) {
            const std::size_t step = 1 + mesh->triangles.size() / 100;
            for (std::size_t i = 0; i < mesh->triangles.size(); i += step) {
                const auto [a, b, c] = mesh->triangles[i];
                scene_.targets.push_back(instance.to_world.point(mesh->positions[a]));
                scene_.targets.push_back(instance.to_world.point((mesh->positions[b] + mesh->positions[c]) * 0.5));
            }
        } else if (const Bounds box = geometry::bounds(s); box.bounded()) {
            for (int i = 0; i < 8; ++i) scene_.targets.push_back(instance.to_world.point(box.corner(i)));
        }
    }
    void place(geometry::Shape&& s, const Affine& where, bool opaque) { place(shape(std::move(s)), where, opaque); }

    bool opaque() { return random.chance(0.6); }
    TestScene finish() { return std::move(scene_); }

    Random random;

private:
    TestScene scene_;
    Affine frame_;
};

inline TestScene shapes_of_all_kinds(const Recipe& recipe) {
    SceneBuilder build(recipe);
    for (int i = 0; i < 120; ++i) {
        const Affine place = random_place(build.random, 0.4);
        build.place(random_shape(build.random), place, build.opaque());
    }
    return build.finish();
}

inline TestScene shapes_on_a_plane(const Recipe& recipe) {
    SceneBuilder build(recipe);
    for (int i = 0; i < 30; ++i) {
        const Affine place = random_place(build.random, 0.4);
        build.place(random_shape(build.random), place, build.opaque());
    }
    build.place(geometry::Plane{}, Affine::translation({0, -0.5, 0}), true);
    build.place(geometry::Plane{}, Affine::translation({0, -0.5, 0}), false);
    build.place(geometry::Plane{}, Affine::rotation({1, 2, 3}, 1), false);
    return build.finish();
}

inline TestScene instanced_meshes(const Recipe& recipe) {
    SceneBuilder build(recipe);
    const auto& ball = build.shape(sphere_mesh(8, 10, 0.1));
    const auto& grid = build.shape(grid_mesh(5, 0));
    for (int i = 0; i < 3; ++i) build.place(ball, random_place(build.random, 0.5), build.opaque());
    for (int i = 0; i < 3; ++i) build.place(grid, random_place(build.random, 0.7), build.opaque());
    build.place(sphere_mesh(6, 8), random_place(build.random, 0.6), build.opaque());  // shown once
    build.place(grid_mesh(4, 0.25), Affine{}, build.opaque());
    return build.finish();
}

inline TestScene instanced_breps(const Recipe& recipe) {
    SceneBuilder build(recipe);
    const auto& block = build.shape(drilled_block(1e-7));
    const auto& loose = build.shape(drilled_block(1e-2));
    for (int i = 0; i < 3; ++i) build.place(block, random_place(build.random, 0.7), build.opaque());
    for (int i = 0; i < 3; ++i) build.place(loose, random_place(build.random, 0.7), build.opaque());
    build.place(drilled_block(0), random_place(build.random, 0.7), build.opaque());  // shown once
    build.place(block, Affine::scaling({0.5, 0.5, 0.5}), build.opaque());
    return build.finish();
}

// One mesh of 960 triangles, shown once.
inline TestScene one_mesh(const Recipe& recipe) {
    SceneBuilder build(recipe);
    build.place(sphere_mesh(21, 24, 0.2), Affine::rotation({1, 1, 0}, 0.7), true);
    return build.finish();
}

// Whatever is hit ties with something else.
inline TestScene coincident(const Recipe& recipe) {
    SceneBuilder build(recipe);
    const auto& grid = build.shape(grid_mesh(4, 0));
    const auto& finer = build.shape(grid_mesh(5, 0));
    const auto& ball = build.shape(sphere_mesh(6, 8));
    for (int round = 0; round < 3; ++round) {
        build.place(grid, Affine{}, build.opaque());
        build.place(finer, Affine{}, build.opaque());
        build.place(grid_mesh(3, 0), Affine{}, build.opaque());
    }
    const Affine place = random_place(build.random, 0.8);
    for (int round = 0; round < 3; ++round) build.place(ball, place, build.opaque());
    for (int i = 0; i < 10; ++i) {
        const Affine where = random_place(build.random, 0.4);
        const geometry::Shape& s = build.shape(random_shape(build.random));
        for (int copy = 0; copy < 3; ++copy) build.place(s, where, build.opaque());
    }
    for (int i = -2; i < 2; ++i) {  // a row of boxes with common faces
        build.place(geometry::Box{{0.25 * i, 0, 0}, {0.25 * (i + 1), 0.25, 0.25}}, Affine{}, build.opaque());
    }
    return build.finish();
}

// Details of 1e-5 of the scene.
inline TestScene tiny_in_huge(const Recipe& recipe) {
    SceneBuilder build(recipe);
    const auto& ball = build.shape(sphere_mesh(5, 6));
    const auto cluster = [&](Vec3 at) {
        for (int i = 0; i < 12; ++i) {
            Affine place = random_place(build.random, 1e-5);
            place.origin = at + build.random.in_cube(2e-5);
            if (i % 4 == 0) {
                build.place(ball, place, build.opaque());
            } else {
                build.place(random_shape(build.random), place, build.opaque());
            }
        }
    };
    cluster({0.9, 0.8, -0.7});
    cluster({0, 0, 0});
    build.place(geometry::Box{{-1, -1, -1}, {1, 1, 1}}, Affine{}, true);
    build.place(geometry::Sphere{0.5}, Affine{}, false);
    return build.finish();
}

// Meshes and shapes flattened to a thousandth and turned.
inline TestScene flattened(const Recipe& recipe) {
    SceneBuilder build(recipe);
    const auto& ball = build.shape(sphere_mesh(8, 10, 0.1));
    const auto flat = [&] {
        Affine place = Affine::rotation(build.random.direction(), build.random.uniform(0, 6)) * Affine::scaling({0.7, 0.0007, 0.7}) *
                       Affine::rotation(build.random.direction(), build.random.uniform(0, 6));
        place.origin = build.random.in_cube(0.5);
        return place;
    };
    for (int i = 0; i < 3; ++i) build.place(ball, flat(), build.opaque());
    for (int i = 0; i < 30; ++i) {
        const Affine place = flat();
        build.place(random_shape(build.random), place, build.opaque());
    }
    return build.finish();
}

// Modelled far from its own origin and placed back: coordinates of 1e4 sizes in the shape's space.
inline TestScene modelled_far_away(const Recipe& recipe) {
    SceneBuilder build(recipe);
    const Vec3 away{10000, -20000, 15000};
    geometry::Mesh ball = sphere_mesh(8, 10, 0.1);
    for (Vec3& p : ball.positions) p += away;
    const auto& shape = build.shape(ball);
    for (int i = 0; i < 3; ++i) {
        const Affine place = random_place(build.random, 0.5);
        build.place(shape, place * Affine::translation(-away), build.opaque());
    }
    for (Vec3& p : ball.positions) p += away;
    build.place(ball, Affine::rotation({1, 2, 1}, 1) * Affine::scaling({0.8, 0.8, 0.8}) * Affine::translation(away * -2), build.opaque());
    build.place(geometry::Box{away, away + Vec3{1, 1, 1}}, Affine::translation(-away), build.opaque());
    return build.finish();
}

using SceneMaker = TestScene (*)(const Recipe&);

inline const std::map<std::string, SceneMaker>& scene_makers() {
    static const std::map<std::string, SceneMaker> makers{
        {"shapes_of_all_kinds", shapes_of_all_kinds}, {"shapes_on_a_plane", shapes_on_a_plane}, {"instanced_meshes", instanced_meshes}, {"instanced_breps", instanced_breps},
        {"one_mesh", one_mesh},         {"coincident", coincident}, {"tiny_in_huge", tiny_in_huge},
        {"flattened", flattened},       {"modelled_far_away", modelled_far_away},
    };
    return makers;
}

inline TestScene make_scene(const Recipe& recipe) { return scene_makers().at(recipe.name)(recipe); }

}  // namespace crescente::accel::testing
