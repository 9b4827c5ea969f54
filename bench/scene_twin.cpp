// A scene as `crescente render` would see it, told to another renderer: meshes, and what a script needs to build the rest (bench/cycles_scene.py).
//
//   scene_twin FOLDER MODEL [options of crescente render]
//
// Writes FOLDER/scene.json and FOLDER/meshes.bin. CAD files are told as triangles (2e-4 of each part's diagonal at most from the surface, true normals at
// their corners), with the camera and the lights that the exact model gets. Textures are not told, and of glTF files no materials: who needs them reads them from the model's file.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <utility>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/cli/load.h"
#include "io/cad_reader.h"
#include "io/cad_scene.h"
#include "render/fresnel.h"
#include "render/lobes.h"
#include "scene/hierarchy.h"
#include "scene/validate.h"

namespace crescente::bench {
namespace {

using Json = nlohmann::ordered_json;
using math::Rgb;
using math::Vec3;

constexpr double deflection = 2e-4;
constexpr int layer_cells = 64;

Json told(Vec3 v) { return {v.x, v.y, v.z}; }
Json told(Rgb c) { return {c.r, c.g, c.b}; }
Json told(const math::Affine& a) { return {told(a.x), told(a.y), told(a.z), told(a.origin)}; }

// Little-endian floats and whole numbers of 32 bits, one after the other.
class Numbers {
public:
    template <class T>
    void add(T value) {
        static_assert(sizeof(T) == 4);
        bytes_.append(reinterpret_cast<const char*>(&value), 4);
    }
    std::size_t count() const { return bytes_.size() / 4; }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

Json told(const geometry::Mesh& mesh, Numbers& numbers) {
    Json json{{"kind", "mesh"}, {"vertices", mesh.positions.size()}, {"triangles", mesh.triangles.size()}, {"normals", !mesh.normals.empty()}, {"at", numbers.count()}};
    for (const Vec3 p : mesh.positions) {
        for (int k = 0; k < 3; ++k) numbers.add(static_cast<float>(p[k]));
    }
    for (const auto& triangle : mesh.triangles) {
        for (const std::uint32_t i : triangle) numbers.add(i);
    }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) numbers.add(static_cast<std::uint32_t>(mesh.slots.empty() ? 0 : mesh.slots[t]));
    for (std::uint32_t t = 0; !mesh.normals.empty() && t < mesh.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            const Vec3 n = mesh.corner_normal(t, corner);
            for (int k = 0; k < 3; ++k) numbers.add(static_cast<float>(n[k]));
        }
    }
    return json;
}

std::optional<Json> told(const geometry::Shape& shape, Numbers& numbers) {
    if (const auto* mesh = std::get_if<geometry::Mesh>(&shape)) return told(*mesh, numbers);
    if (const auto* sphere = std::get_if<geometry::Sphere>(&shape)) return Json{{"kind", "sphere"}, {"radius", sphere->radius}};
    if (const auto* box = std::get_if<geometry::Box>(&shape)) return Json{{"kind", "box"}, {"lower", told(box->lower)}, {"upper", told(box->upper)}};
    if (const auto* disk = std::get_if<geometry::Disk>(&shape); disk && disk->inner_radius == 0) return Json{{"kind", "disk"}, {"radius", disk->radius}};
    return std::nullopt;
}

// Of a metal that is given by its complex index, what it reflects at normal incidence is told as its color.
std::optional<Json> told(const scene::Material& material) {
    scene::PhysicalMaterial m;
    if (const auto* physical = std::get_if<scene::PhysicalMaterial>(&material.model)) {
        m = *physical;
    } else {  // what a classic material comes to that only scatters evenly
        const auto& classic = std::get<scene::ClassicMaterial>(material.model);
        scene::ClassicMaterial evenly;
        evenly.diffuse = classic.diffuse;
        if (classic != evenly) return std::nullopt;
        m.base_color = classic.diffuse, m.ior = 1, m.roughness = 1;
    }
    if (m.k != Rgb{} && m.metallic == 1) m.base_color *= render::fresnel_conductor(1, std::exchange(m.eta, {}), std::exchange(m.k, {}));
    const scene::PhysicalMaterial plain;
    scene::PhysicalMaterial untold = m;
    untold.base_color = plain.base_color, untold.metallic = plain.metallic, untold.roughness = plain.roughness, untold.emissive = plain.emissive, untold.ior = plain.ior;
    untold.transmission = plain.transmission, untold.clearcoat = plain.clearcoat, untold.clearcoat_roughness = plain.clearcoat_roughness, untold.opacity = plain.opacity;
    untold.double_sided = plain.double_sided;
    if (m.sheen_color == Rgb{}) untold.sheen_roughness = plain.sheen_roughness;
    if (untold != plain || !material.textures.empty()) return std::nullopt;
    return Json{{"name", material.name}, {"base_color", told(m.base_color)}, {"metallic", m.metallic}, {"roughness", m.roughness}, {"emissive", told(m.emissive)}, {"ior", m.ior},
                {"transmission", m.transmission}, {"clearcoat", m.clearcoat}, {"clearcoat_roughness", m.clearcoat_roughness}, {"opacity", m.opacity}};
}

std::optional<Json> told(const scene::Light& light) {
    if (light.kind != scene::LightKind::rectangle || light.two_sided) return std::nullopt;
    return Json{{"name", light.name}, {"position", told(light.position)}, {"direction", told(normalize(light.direction))}, {"up", told(upward_of(light))}, {"width", light.width},
                {"height", light.height}, {"radiance", told(light.color * static_cast<float>(light.intensity / visible_area(light)))}, {"visible", light.visible}};
}

Json told(const scene::Environment& e) {
    return {{"zenith", told(e.zenith)}, {"horizon", told(e.horizon)}, {"nadir", told(e.nadir)}, {"strength", e.strength}, {"backdrop", e.backdrop},
            {"backdrop_bottom", told(e.backdrop_bottom)}, {"backdrop_top", told(e.backdrop_top)}, {"image", e.image}, {"rotation", e.rotation}, {"intensity", e.intensity}};
}

// Reflectance of the rough layer of physical materials of index 1.5 towards the viewer, as scale * f0 + bias: rows by roughness, columns by the root of the cosine.
Json layer_table() {
    render::CosineTable<float> law;
    for (std::size_t i = 0; i < law.size(); ++i) law[i] = static_cast<float>(render::fresnel_rise(1.5).at(render::tabled_cosine(i)));
    Json rows = Json::array();
    for (int i = 0; i < layer_cells; ++i) {
        const double roughness = i / double(layer_cells - 1);
        const render::FacetSums facets = render::tabled_facet_sums(std::max(double(render::smoothest_alpha), roughness * roughness));
        const render::CosineTable<float> rise = render::reflectance(facets.shares, law);
        for (int j = 0; j < layer_cells; ++j) {
            const double root = j / double(layer_cells - 1), bias = render::at_cosine(rise, root * root);
            rows.push_back({render::at_cosine(facets.sums, root * root).whole() - bias, bias});
        }
    }
    return rows;
}

// Triangles in place of exact faces; all else stays as it was put about these.
Expected<void> tessellate(io::Loaded& loaded) {
    std::map<std::filesystem::path, scene::Scene> files;
    for (const auto& [shape, source] : loaded.sources) {
        if (!files.contains(source.file)) {
            const auto model = io::read_cad_anew(source.file, {deflection, {}}, {});
            if (!model) return tl::unexpected<Error>(model.error());
            std::vector<io::UntraceableFace> none;
            files[source.file] = io::cad_scene(*model, none).scene;
        }
        const auto& triangles = files[source.file].shapes;
        auto& exact = loaded.scene.shapes[shape];
        if (source.index >= triangles.size() || !std::holds_alternative<geometry::Mesh>(triangles[source.index].shape)) {
            return failure(ErrorKind::input, {source.file.string(), exact.name, "has no triangles", ""});
        }
        exact.shape = triangles[source.index].shape;
    }
    return {};
}

int fail(const Error& error) {
    std::cerr << error.text() << '\n';
    return 1;
}

// with_materials: false where who is told has them from the model's file.
int write(const scene::Scene& scene, const std::string& folder, bool with_materials) {
    Json json;
    Problems untold;
    const auto keep = [&](Json& list, std::optional<Json> value, const std::string& name, const char* reason) {
        if (!value) return untold.push_back({"", name, reason, ""});
        list.push_back(std::move(*value));
    };
    const scene::Camera& camera = *scene.camera;
    if (camera.projection != scene::Projection::perspective) untold.push_back({"", "camera", "only perspective views are told", ""});
    json["camera"] = {{"position", told(camera.position)}, {"target", told(camera.target)}, {"up", told(camera.up)}, {"field_of_view", camera.field_of_view}};
    json["size"] = {scene.settings.width, scene.settings.height};
    json["materials"] = json["lights"] = json["shapes"] = json["objects"] = Json::array();
    for (const auto& m : scene.materials) {
        if (with_materials) keep(json["materials"], told(m), m.name, "only plain physical materials, and classic ones with nothing but a diffuse share, are told");
    }
    for (const auto& light : scene.lights) keep(json["lights"], told(light), light.name, "only rectangles with one side are told");
    if (scene.environment) json["environment"] = told(*scene.environment);
    Numbers numbers;
    for (const auto& named : scene.shapes) keep(json["shapes"], told(named.shape, numbers), named.name, "only meshes, spheres, boxes and whole disks are told");
    scene::for_each_appearance(scene, [&](std::uint32_t node, const math::Affine& to_world, const std::vector<scene::MaterialId>& materials) {
        Json slots = Json::array();
        for (const auto m : materials) slots.push_back(m.value);
        json["objects"].push_back({{"name", scene.nodes[node].name}, {"shape", scene.nodes[node].shape.value}, {"materials", slots}, {"to_world", told(to_world)}});
    });
    json["layer"] = layer_table();
    if (!untold.empty()) return fail({ErrorKind::input, std::move(untold)});
    std::ofstream(folder + "/scene.json") << json;
    std::ofstream(folder + "/meshes.bin", std::ios::binary) << numbers.bytes();
    return 0;
}

int main(int argc, char** argv) {
    CLI::App parser("A scene told to another renderer");
    std::string folder;
    app::SceneOptions options;
    parser.add_option("FOLDER", folder)->required();
    app::add_scene_options(parser, options);
    CLI11_PARSE(parser, argc, argv);
    const auto request = app::understand(options);
    if (!request) return fail(request.error());
    auto loaded = app::load(*request, {});
    if (!loaded) return fail(loaded.error());
    if (const auto made = tessellate(*loaded); !made) return fail(made.error());
    const auto extension = std::filesystem::path(request->file).extension();
    return write(loaded->scene, folder, extension != ".glb" && extension != ".gltf");
}

}  // namespace
}  // namespace crescente::bench

int main(int argc, char** argv) { return crescente::bench::main(argc, argv); }
