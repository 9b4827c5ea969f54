// crescente bench SCENE: one table over accelerators and switches.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>

#include "app/cli/command.h"
#include "app/cli/load.h"
#include "app/cli/progress.h"
#include "app/cli/quantities.h"
#include "app/cli/scene_options.h"
#include "app/cli/stats_json.h"
#include "app/cli/stop.h"
#include "render/session.h"
#include "scene/hierarchy.h"

namespace crescente::app {
namespace {

using Json = nlohmann::ordered_json;
using scene::AcceleratorKind;
using scene::SubpixelShortcut;

struct BenchOptions {
    SceneOptions scene;
    int repeat = 3;
    bool json = false;
};

// One line of the table: what differs from the defaults.
struct Row {
    const char* name;
    void (*apply)(scene::Settings&);
};
constexpr Row rows[] = {
    {"embree", [](scene::Settings& s) { s.accelerator = AcceleratorKind::embree; }},
    {"embree, shadow cache", [](scene::Settings& s) { s.accelerator = AcceleratorKind::embree, s.shadow_cache = true; }},
    {"embree, shortcut exact",
     [](scene::Settings& s) { s.accelerator = AcceleratorKind::embree, s.subpixel_shortcut = SubpixelShortcut::exact; }},
    {"embree, shortcut trust",
     [](scene::Settings& s) { s.accelerator = AcceleratorKind::embree, s.subpixel_shortcut = SubpixelShortcut::trust; }},
    {"kay-kajiya", [](scene::Settings& s) { s.accelerator = AcceleratorKind::kay_kajiya; }},
    {"kay-kajiya, no octant rejection",
     [](scene::Settings& s) { s.accelerator = AcceleratorKind::kay_kajiya, s.octant_rejection = false; }},
    {"kay-kajiya, no priority queue",
     [](scene::Settings& s) { s.accelerator = AcceleratorKind::kay_kajiya, s.priority_queue = false; }},
    {"kay-kajiya, shadow cache", [](scene::Settings& s) { s.accelerator = AcceleratorKind::kay_kajiya, s.shadow_cache = true; }},
    {"linear", [](scene::Settings& s) { s.accelerator = AcceleratorKind::linear; }},
};

// A row with its measurements.
struct Measured {
    const Row* row;
    scene::Settings settings;
    std::string note;    // why it is measured at another size, or not at all
    bool skipped = false;
    std::vector<double> times;
    render::Stats stats;  // of the last run: the counters are the same in each

    double median() const {
        std::vector<double> sorted = times;
        std::sort(sorted.begin(), sorted.end());
        return (sorted[(sorted.size() - 1) / 2] + sorted[sorted.size() / 2]) / 2;
    }
    double per_ray() const { return median() / std::max(1.0, static_cast<double>(stats.rays.total())); }
};

std::uint64_t count_parts(const scene::Scene& scene) {
    std::uint64_t parts = 0;
    scene::for_each_appearance(scene, [&](std::uint32_t node, const math::Affine&, const std::vector<scene::MaterialId>&) {
        parts += geometry::parts(scene.shapes[scene.nodes[node].shape.value].shape);
    });
    return parts;
}

// Brute force tries every part for every ray: where that would take minutes it gets a smaller picture, or none.
void restrain_linear(std::uint64_t parts, Measured& measured) {
    constexpr std::uint64_t most_parts = 20'000;
    constexpr double affordable = 3e7;  // parts times pixels: some ten seconds at dozens of rays a pixel
    auto& settings = measured.settings;
    if (parts > most_parts) {
        measured.skipped = true;
        measured.note = "skipped: " + std::to_string(parts) + " parts are too many for brute force";
        return;
    }
    const double cost = static_cast<double>(parts) * settings.width * settings.height;
    if (cost <= affordable) return;
    const double shrink = std::sqrt(affordable / cost);
    settings.width = std::max(1, static_cast<int>(settings.width * shrink));
    settings.height = std::max(1, static_cast<int>(settings.height * shrink));
    measured.note = "at " + std::to_string(settings.width) + "x" + std::to_string(settings.height) + ", ratio of the time per ray";
}

Expected<void> measure(const scene::Scene& scene, Measured& measured, const StopRequests& stop) {
    scene::Scene copy = scene;
    copy.settings = measured.settings;
    auto session = render::Session::open(std::move(copy));
    if (!session) return tl::unexpected<Error>(session.error());
    while (!stop.asked() && !session->advance({std::chrono::steady_clock::time_point::max(), &stop.asked()}).done) {
    }
    measured.stats = session->stats();
    measured.times.push_back(measured.stats.render_seconds);
    return {};
}

// Time of a row over that of the first; per ray where the picture has another size.
double ratio(const Measured& row, const Measured& first) {
    const bool same_size = row.settings.width == first.settings.width && row.settings.height == first.settings.height;
    return same_size ? row.median() / first.median() : row.per_ray() / first.per_ray();
}

std::uint64_t memory(const render::Stats& stats) { return stats.accelerator_bytes + stats.peak_forest_bytes; }

void print_table(const std::vector<Measured>& table) {
    std::printf("%-32s %9s %9s %9s %9s %9s %9s %9s %9s %9s %9s %9s %7s\n", "", "time", "build", "camera", "reflected", "refracted", "shadow",
                "boxes", "shapes", "cache hit", "sc. wrong", "memory", "ratio");
    const auto count = [](std::uint64_t n) { return human_count(static_cast<double>(n)); };
    for (const Measured& m : table) {
        if (m.skipped) {
            std::printf("%-32s %s\n", m.row->name, m.note.c_str());
            continue;
        }
        const render::Stats& s = m.stats;
        const bool shortcut = m.settings.subpixel_shortcut != SubpixelShortcut::off;
        char wrong[32] = "-";
        if (shortcut) {
            std::snprintf(wrong, sizeof wrong, "%.2g %%",
                          100.0 * static_cast<double>(s.tests.shortcut_wrong) / std::max(1.0, static_cast<double>(s.tests.shortcut_rays)));
        }
        std::printf("%-32s %9s %9s %9s %9s %9s %9s %9s %9s %9s %9s %9s %7.3f%s%s\n", m.row->name, human_time(m.median()).c_str(),
                    human_time(s.build_seconds).c_str(), count(s.rays.camera).c_str(), count(s.rays.reflected).c_str(),
                    count(s.rays.refracted).c_str(), count(s.rays.shadow).c_str(),
                    s.tests.box_tests ? count(s.tests.box_tests).c_str() : "-", count(s.tests.shape_tests).c_str(),
                    count(s.tests.shadow_cache_hits).c_str(), wrong, human_bytes(static_cast<double>(memory(s))).c_str(),
                    ratio(m, table.front()), m.note.empty() ? "" : "  ", m.note.c_str());
    }
}

Json table_json(const std::vector<Measured>& table) {
    Json list = Json::array();
    for (const Measured& m : table) {
        Json row = {{"name", m.row->name}, {"skipped", m.skipped}, {"note", m.note}};
        if (!m.skipped) {
            row["width"] = m.settings.width;
            row["height"] = m.settings.height;
            row["time"] = m.median();
            row["times"] = m.times;
            row["build_time"] = m.stats.build_seconds;
            row["ratio"] = ratio(m, table.front());
            row["stats"] = stats_json(m.stats);
        }
        list.push_back(std::move(row));
    }
    return list;
}

ExitCode bench(const BenchOptions& options) {
    const auto request = understand(options.scene);
    if (!request) return fail(request.error());
    auto loaded = [&] {
        LoadingDisplay display(false);
        return load(*request, read_options(request->cache, request->verbose, display));
    }();
    if (!loaded) return fail(loaded.error());
    warn(loaded->warnings);
    const scene::Scene& scene = loaded->scene;
    const std::uint64_t parts = count_parts(scene);

    std::vector<Measured> table;
    for (const Row& row : rows) {
        Measured measured{&row, scene.settings, {}, false, {}, {}};
        row.apply(measured.settings);
        if (measured.settings.accelerator == AcceleratorKind::linear) restrain_linear(parts, measured);
        table.push_back(std::move(measured));
    }

    // Every row once, then every row again: a drift of the machine's speed meets all alike.
    const StopRequests stop;
    for (int turn = 0; turn < options.repeat; ++turn) {
        for (Measured& measured : table) {
            if (measured.skipped) continue;
            if (const auto done = measure(scene, measured, stop); !done) return fail(done.error());
            if (stop.asked()) {
                note("stopped; an unfinished table would mislead");
                return exit_stopped;
            }
        }
    }

    if (options.json) {
        const Json json = {{"version", CRESCENTE_VERSION}, {"scene", options.scene.file},     {"parts", parts},
                           {"width", scene.settings.width}, {"height", scene.settings.height}, {"repeat", options.repeat},
                           {"rows", table_json(table)}};
        std::puts(json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
    } else {
        std::printf("%s: %llu parts, %dx%d, %d thread%s, median of %d\n\n", options.scene.file.c_str(), static_cast<unsigned long long>(parts),
                    scene.settings.width, scene.settings.height, table.front().stats.threads, table.front().stats.threads == 1 ? "" : "s",
                    options.repeat);
        print_table(table);
    }
    return std::fflush(stdout) == 0 ? exit_ok : fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
}

}  // namespace

Command add_bench(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("bench", "Compare accelerators and switches on a scene");
    const auto options = std::make_shared<BenchOptions>();
    add_scene_options(*parser, options->scene);
    parser->remove_option(parser->get_option("--accel"));  // the table has them all
    parser->add_option("--repeat", options->repeat, "How often each row is measured; the median counts")->option_text("N")->check(CLI::Range(1, 1000));
    parser->add_flag("--json", options->json, "Print JSON");
    parser->footer("Example:\n  crescente bench balls4.nff --size 512x512 --threads 1 --repeat 5");
    return {parser, [options](const Invocation&) { return bench(*options); }};
}

}  // namespace crescente::app
