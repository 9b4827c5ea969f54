// Rays per second on the exact faces of CAD files, hits in double, against Embree alone on triangles of the same files, in float: camera rays and rays
// scattered from what they hit, the same for both. One thread, processor time.
//
//   cad_bench [--repetitions N] [--deflection X] [--exact] FILE...
//
// Prints one JSON object a line; --exact: without triangles, whose making takes long. bench/run cad makes a table of it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "io/cad_reader.h"
#include "io/cad_scene.h"
#include "picture_rays.h"
#include "raw_embree.h"
#include "scene/studio.h"
#include "scene/validate.h"

namespace crescente::bench {
namespace {

constexpr int edge = 1024;  // of the picture, pixels

struct Options {
    int repetitions = 5;
    double deflection = 2e-4;  // of triangles, as a share of each part's diagonal
    bool exact = false;
    std::vector<std::string> files;
};

double processor_seconds() {
    timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

// One way to trace rays: millions a second, one figure a repetition.
struct Row {
    const char* name;
    std::size_t rays;
    std::function<std::size_t()> trace;
    std::vector<double> rates;
    std::size_t hits = 0;

    double median() {
        std::nth_element(rates.begin(), rates.begin() + static_cast<std::ptrdiff_t>(rates.size() / 2), rates.end());
        return rates[rates.size() / 2];
    }
};

bool measure(const std::string& file, const Options& options) {
    const auto fail = [&](const Error& error) {
        std::fprintf(stderr, "%s: %s\n", file.c_str(), error.text().c_str());
        return false;
    };
    auto loaded = io::read_scene(file);
    if (!loaded) return fail(loaded.error());
    scene::Scene scene = std::move(loaded->scene);
    if (Problems problems = scene::validate(scene, file); !problems.empty()) return fail({ErrorKind::input, std::move(problems)});
    {
        scene::Scene framed = scene;  // the camera of the studio without its lights and ground
        scene::add_studio(framed);
        scene.camera = framed.camera;
    }
    scene.settings.width = scene.settings.height = edge;
    const auto exact = render::world_of(scene);
    if (!exact) return fail(exact.error());

    std::unique_ptr<RawEmbree> triangles;
    std::size_t triangle_count = 0;
    scene::Scene tessellated;
    std::unique_ptr<render::World> coarse;
    if (!options.exact) {
        const auto model = io::read_cad_anew(file, {options.deflection, {}}, {});
        if (!model) fail(model.error());  // OpenCASCADE cannot make them: exact alone
        std::vector<io::UntraceableFace> none;
        if (model) {
            tessellated = io::cad_scene(*model, none).scene;
            if (Problems problems = scene::validate(tessellated, file); !problems.empty()) return fail({ErrorKind::input, std::move(problems)});
            tessellated.camera = scene.camera;
            auto world = render::world_of(tessellated);
            if (!world) return fail(world.error());
            coarse = std::move(*world);
            for (const accel::Instance& instance : coarse->instances) triangle_count += geometry::parts(*instance.shape);
            triangles = std::make_unique<RawEmbree>(coarse->instances);
        }
    }

    const PictureRays rays(**exact, edge, edge, nullptr);
    std::vector<Row> rows;
    std::vector<RawEmbree::Packets> packets;
    std::vector<RTCRayHit> single[2];
    packets.reserve(2);
    for (const auto& [name, of] : {std::pair<const char*, const Rays&>{"camera", rays.camera}, {"bounce", rays.bounce}}) {
        rows.push_back({name, of.rays.size(), [&exact, &of] { return trace(*(*exact)->accelerator, of, false); }, {}});
    }
    if (triangles) {
        for (const auto& [name, of] : {std::pair<const char*, const Rays&>{"camera_triangles", rays.camera}, {"bounce_triangles", rays.bounce}}) {
            packets.push_back(RawEmbree::pack(of.rays, of.coherence == accel::Coherence::coherent));
            rows.push_back({name, packets.back().nearest.size() * 16, [&triangles, &p = packets.back()] { return triangles->nearest(p); }, {}});
        }
        single[0] = RawEmbree::pack_singly(rays.camera.rays), single[1] = RawEmbree::pack_singly(rays.bounce.rays);
        rows.push_back({"camera_triangles_singly", single[0].size(), [&] { return triangles->nearest_singly(single[0]); }, {}});
        rows.push_back({"bounce_triangles_singly", single[1].size(), [&] { return triangles->nearest_singly(single[1]); }, {}});
    }
    for (int repetition = 0; repetition < options.repetitions; ++repetition) {
        for (Row& row : rows) {
            const double start = processor_seconds();
            row.hits = row.trace();
            row.rates.push_back(static_cast<double>(row.rays) / (processor_seconds() - start) * 1e-6);
        }
    }

    std::size_t faces = 0, leaves = 0;
    for (const accel::Instance& instance : (*exact)->instances) {
        if (const auto* brep = std::get_if<geometry::Brep>(instance.shape)) faces += brep->face_count(), leaves += brep->parts();
    }
    nlohmann::ordered_json json = {{"file", std::filesystem::path(file).filename().string()}, {"faces", faces}, {"leaves", leaves}, {"triangles", triangle_count}};
    json["hit_share"] = static_cast<double>(rays.bounce.rays.size()) / static_cast<double>(rays.camera.rays.size());
    json["bounce_hit_share"] = static_cast<double>(rows[1].hits) / static_cast<double>(std::max<std::size_t>(1, rows[1].rays));
    for (Row& row : rows) json[row.name] = row.median();
    std::puts(json.dump().c_str());
    std::fflush(stdout);
    return true;
}

}  // namespace
}  // namespace crescente::bench

int main(int argc, char** argv) {
    crescente::bench::Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string argument = argv[i];
        const bool has_value = i + 1 < argc;
        if (argument == "--repetitions" && has_value) options.repetitions = std::max(1, std::atoi(argv[++i]));
        else if (argument == "--deflection" && has_value) options.deflection = std::atof(argv[++i]);
        else if (argument == "--exact") options.exact = true;
        else options.files.push_back(argument);
    }
    bool all = !options.files.empty();
    for (const std::string& file : options.files) all = crescente::bench::measure(file, options) && all;
    return all ? 0 : 1;
}
