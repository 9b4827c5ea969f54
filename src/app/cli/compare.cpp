// crescente compare MODEL: a CAD file's exact surfaces against OpenCASCADE's triangles of them, seen by the same camera.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "app/cli/command.h"
#include "app/cli/load.h"
#include "app/cli/progress.h"
#include "app/cli/quantities.h"
#include "app/cli/scene_options.h"
#include "io/cad_reader.h"
#include "io/cad_scene.h"
#include "io/image_file.h"
#include "render/session.h"
#include "scene/validate.h"

namespace crescente::app {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

struct CompareOptions {
    SceneOptions scene;
    double deflection = 2e-4;
    std::string output;
    bool json = false;
};

// One of the two, seen.
struct Seen {
    scene::Image image;
    render::Stats stats;
    double open_seconds = 0;        // from the file to a scene
    std::uint64_t shape_bytes = 0;
    std::uint64_t pieces = 0;       // faces, or triangles

    const std::vector<float>& layer(std::size_t index) const { return image.layers[index].values; }
    bool covers(std::size_t pixel) const { return std::isfinite(layer(1)[pixel]); }
    double depth(std::size_t pixel) const { return layer(1)[pixel]; }
};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

void count_shapes(const scene::Scene& scene, Seen& view) {
    for (const auto& named : scene.shapes) {
        if (const auto* brep = std::get_if<geometry::Brep>(&named.shape)) view.shape_bytes += brep->bytes(), view.pieces += brep->face_count();
        if (const auto* mesh = std::get_if<geometry::Mesh>(&named.shape)) {
            view.shape_bytes += mesh->positions.size() * sizeof(mesh->positions[0]) + mesh->triangles.size() * (sizeof(mesh->triangles[0]) + sizeof(mesh->slots[0])) +
                                mesh->normals.size() * sizeof(mesh->normals[0]);
            view.pieces += mesh->triangles.size();
        }
    }
}

Expected<void> look(scene::Scene scene, Seen& view) {
    scene.settings.level = scene::Level::visible;
    scene.settings.keep = true;  // the layers come from the kept nodes
    count_shapes(scene, view);
    auto session = render::Session::open(std::move(scene));
    if (!session) return tl::unexpected<Error>(std::move(session.error()));
    while (!session->advance({Clock::time_point::max(), nullptr}).done) {
    }
    view.image = session->picture(true);
    view.stats = session->stats();
    return {};
}

struct Difference {
    std::uint64_t both = 0, only_exact = 0, only_triangles = 0;
    std::uint64_t silhouette = 0;  // pixels of the exact view beside one that it does not cover
    double mean = 0, largest = 0;  // of the depths where both see the same surface, mm
};

// Depths further apart than this are of different surfaces.
Difference difference_of(const Seen& exact, const Seen& triangles, double same_surface) {
    Difference d;
    const int width = exact.image.width, height = exact.image.height;
    std::uint64_t same = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
            const bool e = exact.covers(pixel), t = triangles.covers(pixel);
            d.only_exact += e && !t, d.only_triangles += t && !e, d.both += e && t;
            if (e) {
                const bool inside = x > 0 && x + 1 < width && y > 0 && y + 1 < height && exact.covers(pixel - 1) && exact.covers(pixel + 1) &&
                                    exact.covers(pixel - static_cast<std::size_t>(width)) && exact.covers(pixel + static_cast<std::size_t>(width));
                d.silhouette += !inside;
            }
            if (!e || !t) continue;
            const double apart = std::abs(exact.depth(pixel) - triangles.depth(pixel));
            if (apart > same_surface) continue;
            constexpr double millimetres = 1000;
            d.mean += apart * millimetres, ++same;
            d.largest = std::max(d.largest, apart * millimetres);
        }
    }
    if (same > 0) d.mean /= static_cast<double>(same);
    return d;
}

// Exact, triangles, and where they differ, side by side: lit from the camera; red: only the exact one covers the pixel, blue: only the triangles do, yellow:
// how far their normals turn from each other, white from 20 degrees on.
scene::Image side_by_side(const Seen& exact, const Seen& triangles, math::Vec3 forward) {
    const int width = exact.image.width, height = exact.image.height;
    scene::Image image{3 * width, height, {{"color", {"R", "G", "B"}, std::vector<float>(static_cast<std::size_t>(width) * height * 9)}}};
    const auto normal = [](const Seen& view, std::size_t pixel) {
        const float* n = &view.layer(3)[3 * pixel];
        return math::Vec3{n[0], n[1], n[2]};
    };
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
            const auto put = [&](int panel, math::Rgb c) {
                float* to = &image.layers[0].values[3 * (static_cast<std::size_t>(y) * image.width + static_cast<std::size_t>(panel) * width + x)];
                to[0] = c.r, to[1] = c.g, to[2] = c.b;
            };
            const auto lit = [&](const Seen& view) {
                constexpr float background = 0.02f;
                if (!view.covers(pixel)) return math::gray(background);
                return math::gray(0.05f + 0.75f * static_cast<float>(std::abs(dot(normal(view, pixel), forward))));
            };
            put(0, lit(exact)), put(1, lit(triangles));
            const bool e = exact.covers(pixel), t = triangles.covers(pixel);
            if (e != t) put(2, e ? math::Rgb{0.9f, 0, 0} : math::Rgb{0, 0.1f, 0.9f});
            if (!e || !t) continue;
            const double turn = std::acos(std::clamp(dot(normal(exact, pixel), normal(triangles, pixel)), -1.0, 1.0));
            const float share = static_cast<float>(std::min(1.0, turn / (20 * math::pi / 180)));
            put(2, {0.05f + 0.95f * share, 0.05f + 0.8f * share, 0.05f + 0.95f * share * share});
        }
    }
    return image;
}

Json view_json(const Seen& view) {
    return {{"pieces", view.pieces},
            {"open_seconds", view.open_seconds},
            {"build_seconds", view.stats.build_seconds},
            {"rays_per_second", static_cast<double>(view.stats.rays.total()) / std::max(view.stats.render_seconds, 1e-9)},
            {"shape_bytes", view.shape_bytes},
            {"accelerator_bytes", view.stats.accelerator_bytes}};
}

void print(const CompareOptions& options, const Seen& exact, const Seen& triangles, const Difference& d) {
    std::printf("%-12s %12s %10s %10s %14s %12s %12s\n", "", "pieces", "open", "build", "camera rays", "shapes", "accelerator");
    for (const auto& [name, view] : {std::pair<const char*, const Seen&>{"exact", exact}, {"triangles", triangles}}) {
        std::printf("%-12s %12llu %10s %10s %14s %12s %12s\n", name, static_cast<unsigned long long>(view.pieces), human_time(view.open_seconds).c_str(),
                    human_time(view.stats.build_seconds).c_str(),
                    human_rate(static_cast<double>(view.stats.rays.total()) / std::max(view.stats.render_seconds, 1e-9)).c_str(),
                    human_bytes(static_cast<double>(view.shape_bytes)).c_str(), human_bytes(static_cast<double>(view.stats.accelerator_bytes)).c_str());
    }
    std::printf("\ndeflection %g of each part's diagonal\n", options.deflection);
    std::printf("silhouette %llu pixels; %llu covered by the exact surfaces only, %llu by the triangles only: %.3g %% of the silhouette\n",
                static_cast<unsigned long long>(d.silhouette), static_cast<unsigned long long>(d.only_exact), static_cast<unsigned long long>(d.only_triangles),
                100.0 * static_cast<double>(d.only_exact + d.only_triangles) / static_cast<double>(std::max<std::uint64_t>(1, d.silhouette)));
    std::printf("depth      mean %.3g mm, largest %.3g mm apart where both see the same surface\n", d.mean, d.largest);
}

ExitCode compare(const CompareOptions& options) {
    auto request = understand(options.scene);
    if (!request) return fail(request.error());
    if (!options.output.empty()) {
        if (const auto writable = io::can_write(options.output); !writable) return fail(writable.error());
    }
    request->studio = false;  // nothing but the model
    Seen exact, triangles;
    LoadingDisplay display(options.json);
    const io::ReadOptions reading = read_options(request->cache, request->verbose, display);

    auto start = Clock::now();
    auto loaded = load(*request, reading);
    if (!loaded) return fail(loaded.error());
    exact.open_seconds = seconds_since(start);
    if (!loaded->cad) return fail({ErrorKind::usage, {{options.scene.file, "", "is no CAD file: there are no exact surfaces to compare", "STEP, IGES or BREP"}}});
    warn(loaded->warnings);

    start = Clock::now();
    const auto model = io::read_cad_anew(options.scene.file, {options.deflection, {}}, reading);
    if (!model) return fail(model.error());
    std::vector<io::UntraceableFace> none;
    scene::Scene tessellated = io::cad_scene(*model, none).scene;
    triangles.open_seconds = seconds_since(start);
    tessellated.camera = loaded->scene.camera;
    tessellated.settings = loaded->scene.settings;
    if (Problems problems = scene::validate(tessellated, options.scene.file); !problems.empty()) return fail({ErrorKind::input, std::move(problems)});

    const math::Bounds box = scene::bounds(loaded->scene);
    const math::Vec3 forward = normalize(loaded->scene.camera->target - loaded->scene.camera->position);
    if (const auto seen = look(std::move(loaded->scene), exact); !seen) return fail(seen.error());
    if (const auto seen = look(std::move(tessellated), triangles); !seen) return fail(seen.error());
    constexpr double near = 0.01;  // of the diagonal
    const Difference difference = difference_of(exact, triangles, near * length(box.upper - box.lower));

    if (!options.output.empty()) {
        io::ImageOptions image;
        if (const auto written = io::write_image(side_by_side(exact, triangles, forward), options.output, image); !written) return fail(written.error());
    }
    if (options.json) {
        const Json json = {{"file", options.scene.file},
                           {"deflection", options.deflection},
                           {"exact", view_json(exact)},
                           {"triangles", view_json(triangles)},
                           {"pixels", {{"both", difference.both}, {"only_exact", difference.only_exact}, {"only_triangles", difference.only_triangles}, {"silhouette", difference.silhouette}}},
                           {"depth_mm", {{"mean", difference.mean}, {"largest", difference.largest}}}};
        std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    } else {
        print(options, exact, triangles, difference);
    }
    return std::fflush(stdout) == 0 ? exit_ok : fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
}

}  // namespace

Command add_compare(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("compare", "Compare the exact surfaces of a CAD file with triangles of them");
    const auto options = std::make_shared<CompareOptions>();
    add_scene_options(*parser, options->scene);
    parser->add_option("--deflection", options->deflection, "How far triangles may stray, as a share of each part's diagonal")
        ->option_text("X")->check(CLI::Range(1e-7, 0.5));
    parser->add_option("-o,--output", options->output, "Picture of three panels: exact, triangles, where they differ")->option_text("FILE");
    parser->add_flag("--json", options->json, "Print JSON");
    parser->footer("Example:\n  crescente compare part.step --deflection 1e-3 -o difference.png");
    return {parser, [options](const Invocation&) { return compare(*options); }};
}

}  // namespace crescente::app
