#include "scenes.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "io/formats.h"
#include "scene/studio.h"
#include "scene/validate.h"

namespace crescente::bench {

using math::Vec3;

scene::Scene bumpy_sphere() {
    constexpr std::uint32_t around = 1000, down = 500;
    geometry::Mesh mesh;
    for (std::uint32_t i = 0; i <= down; ++i) {
        for (std::uint32_t j = 0; j < around; ++j) {
            const double theta = math::pi * i / down, phi = 2 * math::pi * j / around;
            const double r = 1 + 0.05 * std::sin(12 * theta) * std::sin(theta) * std::cos(16 * phi);
            mesh.positions.push_back(Vec3{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)} * r);
        }
    }
    const auto at = [](std::uint32_t i, std::uint32_t j) { return i * around + j % around; };
    for (std::uint32_t i = 0; i < down; ++i) {
        for (std::uint32_t j = 0; j < around; ++j) {
            if (i > 0) mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j)});
            if (i + 1 < down) mesh.triangles.push_back({at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)});
        }
    }
    std::vector<Vec3> sums(mesh.positions.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        const Vec3 n = cross(mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a]);
        for (const std::uint32_t corner : {a, b, c}) sums[corner] += n;
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const Vec3 n = length(sums[i]) > 0 ? normalize(sums[i]) : normalize(mesh.positions[i]);
        mesh.normals.push_back({static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
    }

    scene::Scene scene;
    scene.shapes.push_back({"bumpy sphere", std::move(mesh)});
    scene.nodes.emplace_back().shape = {0};
    scene.roots = {{0}};
    scene::Light light;
    light.position = {5, 6, 7};
    light.falloff = scene::Falloff::none;
    scene.lights = {light};
    scene.camera.emplace();
    scene.camera->position = {0, 0.8, 2.6};
    return scene;
}

std::string root() { return CRESCENTE_ROOT; }

scene::Scene load(const std::string& file_name) {
    const std::string file = std::string(CRESCENTE_ROOT "/scenes/") + file_name;
    auto loaded = io::read_scene(file);
    const auto fail = [&](const std::string& reason) {
        std::fprintf(stderr, "%s: %s\n", file.c_str(), reason.c_str());
        std::exit(1);
    };
    if (!loaded) fail(loaded.error().text());
    if (const auto problems = scene::validate(loaded->scene, file); !problems.empty()) fail(problems.front().text());
    if (!loaded->scene.camera) scene::add_studio(loaded->scene);
    return std::move(loaded->scene);
}

}  // namespace crescente::bench
