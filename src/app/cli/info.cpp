// crescente info MODEL: what is in a file, and what is wrong with it.
#include <array>
#include <cstdio>
#include <iostream>
#include <map>
#include <memory>

#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "app/cli/info_cad.h"
#include "app/cli/progress.h"
#include "io/content_hash.h"
#include "app/cli/quantities.h"
#include "io/formats.h"
#include "scene/hierarchy.h"
#include "scene/validate.h"

namespace crescente::app {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    std::string file;
    bool json = false, no_cache = false, verbose = false;
};

std::string lower_extension(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return extension;
}

std::string format_name(const std::string& file) {
    const std::string extension = lower_extension(file);
    for (const io::Format& format : io::formats()) {
        for (const std::string& known : format.extensions) {
            if (known == extension) return format.name;
        }
    }
    return "unknown";
}

std::uint64_t shape_bytes(const geometry::Shape& shape) {
    if (const auto* brep = std::get_if<geometry::Brep>(&shape)) return sizeof shape + brep->bytes();
    const auto* mesh = std::get_if<geometry::Mesh>(&shape);
    if (!mesh) return sizeof shape;
    return sizeof shape + mesh->positions.size() * sizeof(mesh->positions[0]) + mesh->triangles.size() * sizeof(mesh->triangles[0]) +
           mesh->normals.size() * sizeof(mesh->normals[0]) + mesh->slots.size() * sizeof(mesh->slots[0]);
}

std::uint64_t scene_bytes(const scene::Scene& scene) {
    std::uint64_t bytes = scene.materials.size() * sizeof(scene::Material) + scene.lights.size() * sizeof(scene::Light);
    for (const auto& named : scene.shapes) bytes += sizeof named.name + named.name.size() + shape_bytes(named.shape);
    for (const auto& node : scene.nodes) {
        bytes += sizeof node + node.name.size() + node.children.size() * sizeof(scene::NodeId) + node.materials.size() * sizeof(scene::MaterialId);
    }
    return bytes;
}

Json vector_json(math::Vec3 v) { return {v.x, v.y, v.z}; }

Json shapes_json(const scene::Scene& scene) {
    std::array<std::uint64_t, std::size(geometry::shape_names)> counts{};
    for (const auto& named : scene.shapes) ++counts[named.shape.index()];
    Json shapes = Json::object();
    for (std::size_t kind = 0; kind < counts.size(); ++kind) {
        if (counts[kind]) shapes[std::string(geometry::shape_names[kind])] = counts[kind];
    }
    return shapes;
}

Json problems_json(const Problems& problems) {
    Json list = Json::array();
    for (const Problem& p : problems) list.push_back({{"file", p.file}, {"place", p.place}, {"reason", p.reason}, {"hint", p.hint}});
    return list;
}

// What needs a hierarchy without cycles: appearances and bounds.
void add_world(const scene::Scene& scene, Json& json) {
    std::uint64_t appearances = 0, triangles = 0;
    scene::for_each_appearance(scene, [&](std::uint32_t node, const math::Affine&, const std::vector<scene::MaterialId>&) {
        ++appearances;
        const auto* mesh = std::get_if<geometry::Mesh>(&scene.shapes[scene.nodes[node].shape.value].shape);
        if (mesh) triangles += mesh->triangles.size();
    });
    json["instances"] = appearances;
    json["triangles_shown"] = triangles;
    const math::Bounds box = scene::bounds(scene);
    if (box.empty()) {
        json["bounds"] = nullptr;
        return;
    }
    const double unit = scene.unit.metres;
    json["bounds"] = {{"metres", {{"lower", vector_json(box.lower)}, {"upper", vector_json(box.upper)}}},
                      {"unit", {{"lower", vector_json(box.lower / unit)}, {"upper", vector_json(box.upper / unit)}}}};
}

Json describe(const InfoOptions& options, const io::Loaded& loaded, const Problems& problems, const std::string& hash) {
    const scene::Scene& scene = loaded.scene;
    std::uint64_t triangles = 0;
    for (const auto& named : scene.shapes) {
        if (const auto* mesh = std::get_if<geometry::Mesh>(&named.shape)) triangles += mesh->triangles.size();
    }
    Json json = {
        {"file", options.file},
        {"format", format_name(options.file)},
        {"hash", "xxh64:" + hash},
        {"name", scene.name},
        {"unit", {{"name", scene.unit.name}, {"metres", scene.unit.metres}}},
        {"shapes", shapes_json(scene)},
        {"triangles", triangles},
        {"nodes", scene.nodes.size()},
        {"materials", scene.materials.size()},
        {"lights", scene.lights.size()},
        {"camera", scene.camera.has_value()},
        {"memory", scene_bytes(scene)},
    };
    if (problems.empty()) add_world(scene, json);
    if (loaded.cad) json["cad"] = cad_json(loaded);
    json["warnings"] = problems_json(loaded.warnings);
    json["problems"] = problems_json(problems);
    return json;
}

std::string corner_text(const Json& v) {
    char text[96];
    std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
    return text;
}

void print(const Json& json) {
    const auto line = [](const std::string& name, const std::string& value) { std::printf("%-11s%s\n", name.c_str(), value.c_str()); };
    const auto number = [&](const char* name) { return std::to_string(json.at(name).get<std::uint64_t>()); };
    line("file", json["file"]);
    line("format", json["format"]);
    line("hash", json["hash"]);
    if (!json["name"].get<std::string>().empty()) line("name", json["name"]);
    const double metres = json["unit"]["metres"];
    char unit[64];
    std::snprintf(unit, sizeof unit, "%s (%.6g m)", json["unit"]["name"].get<std::string>().c_str(), metres);
    line("unit", unit);
    std::string shapes;
    for (const auto& [kind, count] : json["shapes"].items()) shapes += (shapes.empty() ? "" : ", ") + std::to_string(count.get<std::uint64_t>()) + " " + kind;
    line("shapes", shapes.empty() ? "none" : shapes);
    line("triangles", number("triangles"));
    line("nodes", number("nodes"));
    if (json.contains("instances")) line("instances", number("instances") + " showing " + number("triangles_shown") + " triangles");
    line("materials", number("materials"));
    line("lights", number("lights"));
    line("camera", json["camera"].get<bool>() ? "yes" : "none (the studio frames the scene)");
    if (json.contains("bounds") && json["bounds"].is_object()) {
        for (const char* measure : {"unit", "metres"}) {
            if (metres == 1 && std::string_view(measure) == "unit") continue;
            const Json& box = json["bounds"][measure];
            line("bounds", corner_text(box["lower"]) + " to " + corner_text(box["upper"]) + " " +
                               (std::string_view(measure) == "unit" ? json["unit"]["name"].get<std::string>() : "m"));
        }
    } else if (json.contains("bounds")) {
        line("bounds", "empty");
    }
    line("memory", human_bytes(json["memory"].get<double>()));
}

ExitCode info(const InfoOptions& options) {
    const auto loaded = [&] {
        LoadingDisplay display(options.json);
        return io::read_scene(options.file, read_options(!options.no_cache, options.verbose, display));
    }();
    if (!loaded) return fail(loaded.error());
    const auto hash = io::content_hash(options.file);
    if (!hash) return fail(hash.error());
    const Problems problems = scene::validate(loaded->scene, options.file);

    const Json json = describe(options, *loaded, problems, *hash);
    if (options.json) {
        std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    } else {
        print(json);
        if (loaded->cad) std::fputs(cad_text(*loaded).c_str(), stdout);
    }
    if (std::fflush(stdout) != 0) return fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
    warn(loaded->warnings);
    return problems.empty() ? exit_ok : fail({ErrorKind::input, problems});
}

}  // namespace

Command add_info(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("info", "Tell what is in a scene or model file, and what is wrong with it");
    const auto options = std::make_shared<InfoOptions>();
    parser->add_option("MODEL", options->file, "Scene or model file")->required()->option_text(" ");
    parser->add_flag("--json", options->json, "Print JSON");
    parser->add_flag("--no-cache", options->no_cache, "Read a CAD file anew, and keep nothing of it");
    parser->add_flag("-v,--verbose", options->verbose, "Tell what the libraries that read the file have to say");
    parser->footer("Exit code 3 if the scene cannot be rendered as it is.");
    return {parser, [options](const Invocation&) { return info(*options); }};
}

}  // namespace crescente::app
