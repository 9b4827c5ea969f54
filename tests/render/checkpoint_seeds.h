// What the seeds of tests/fuzz/corpus/checkpoint are of. The first byte of a seed says what the others are: 't' the one tile of a checkpoint whose head is right,
// anything else a whole file; checksums are put right, so that what lies behind them is reached.
#pragma once

#include <unistd.h>

#include <stdexcept>
#include <string>

#include "render/checkpoint_file.h"
#include "render/session.h"

namespace crescente::render::testing {

// A mirror, a pane of coloured glass full of holes and a mesh on a floor: one tile of few nodes.
inline scene::Scene seed_scene() {
    scene::Scene s;
    s.camera.emplace();
    s.camera->position = {0, 1, 5};
    const auto material = [&](math::Rgb diffuse, math::Rgb reflection) {
        scene::ClassicMaterial m;
        m.diffuse = diffuse, m.reflection = reflection;
        s.materials.push_back({"", m});
    };
    material({0.6f, 0.5f, 0.4f}, {});
    material({}, {0.8f, 0.8f, 0.8f});
    scene::PhysicalMaterial glass;
    glass.base_color = {0.2f, 0.7f, 0.3f}, glass.roughness = 0, glass.ior = 1.2, glass.transmission = 0.8, glass.opacity = 0.7;
    s.materials.push_back({"", glass});
    geometry::Mesh mesh;
    mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0.5}, {1.5, 1.5, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 3, 2}};
    geometry::Box pane;
    pane.lower = {-0.6, -0.5, 1}, pane.upper = {0.5, 0.9, 1.1};
    const geometry::Shape shapes[] = {geometry::Plane{}, geometry::Sphere{}, pane, mesh};
    for (std::uint32_t i = 0; i < std::size(shapes); ++i) {
        s.shapes.push_back({"", shapes[i]});
        scene::Node node;
        node.shape.value = i;
        node.materials = {{i == 3 ? 0 : i}};
        node.transform = math::Affine::translation({0, i == 0 ? -1.0 : 0, i == 3 ? -2.0 : 0});
        s.roots.push_back({i});
        s.nodes.push_back(std::move(node));
    }
    s.lights.emplace_back();
    s.lights[0].position = {2, 4, 3}, s.lights[0].falloff = scene::Falloff::none;
    scene::Settings& settings = s.settings;
    settings.width = 8, settings.height = 6, settings.tile = 8, settings.depth = 3, settings.supersampling = 1, settings.threads = 1;
    return s;
}

// The checkpoint that the session would leave.
inline std::string saved(Session& session) {
    const auto file = std::filesystem::temp_directory_path() / ("crescente-seed-" + std::to_string(getpid()) + ".checkpoint");
    const auto size = session.save(file);
    if (!size) throw std::runtime_error(size.error().text());
    std::string bytes = bytes_of(file);
    std::filesystem::remove(file);
    return bytes;
}

// Where the first tile's section begins.
inline std::size_t end_of_head(std::string_view checkpoint) {
    std::uint64_t length;
    std::memcpy(&length, &checkpoint[21], sizeof length);
    return 37 + length;
}

// The file that a seed stands for; it must not be empty.
inline std::string file_of_seed(std::string_view seed) {
    static const std::string head = [] {
        auto session = Session::open(seed_scene());
        if (!session) throw std::runtime_error(session.error().text());
        const std::string bytes = saved(*session);
        return bytes.substr(0, end_of_head(bytes));
    }();
    std::string bytes(seed.substr(1));
    if (seed[0] == 't') bytes = head + std::string(16, '\xff') + bytes;
    return resealed(std::move(bytes));
}

}  // namespace crescente::render::testing
