// crescente render MODEL -o PICTURE
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

#include "app/cli/checkpoints.h"
#include "app/cli/command.h"
#include "app/cli/load.h"
#include "app/cli/picture_options.h"
#include "app/cli/progress.h"
#include "app/cli/quantities.h"
#include "app/cli/scene_options.h"
#include "app/cli/stats_json.h"
#include "app/cli/stop.h"
#include "base/atomic_file.h"
#include "io/content_hash.h"
#include "render/session.h"

namespace crescente::app {
namespace {

using Clock = std::chrono::steady_clock;

// As the user wrote them.
struct RenderOptions {
    SceneOptions scene;
    PictureOptions picture;
    CheckpointOptions checkpoint;
    std::string stats_file;
    std::optional<std::string> time, replay, pick;
    bool quiet = false;
};

struct Pixel {
    int x = 0, y = 0;
};

// What they ask for.
struct Request {
    SceneRequest scene;
    CheckpointRequest checkpoint;
    std::optional<std::chrono::duration<double>> time;
    std::optional<Pixel> replay, pick;
};

// Wall time of the parts of a run, seconds; cpu: of all threads, cpu_render: of building and rendering.
struct RunTimes {
    double load = 0, render = 0, write = 0, total = 0, cpu = 0, cpu_render = 0;
};

// Why the picture stopped growing.
enum class Ending { complete, time, asked, insisted };

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return static_cast<double>(t.tv_sec) + static_cast<double>(t.tv_usec) * 1e-6; };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

Expected<Request> understand(const RenderOptions& options) {
    Request request;
    Problems problems;
    const auto keep = [&](auto value, auto& place) {
        if (value) {
            place = std::move(*value);
        } else {
            problems.insert(problems.end(), value.error().problems.begin(), value.error().problems.end());
        }
    };
    keep(app::understand(options.scene), request.scene);
    keep(app::understand(options.checkpoint), request.checkpoint);
    if (options.time) keep(parse_duration("--time", *options.time), request.time);
    const auto keep_pixel = [&](const char* option, const std::optional<std::string>& text, std::optional<Pixel>& place) {
        if (!text) return;
        std::vector<double> numbers;
        keep(parse_numbers(option, *text), numbers);
        constexpr double widest = 65536;
        const auto pixel = [&](double n) { return n >= 0 && n < widest && n == static_cast<int>(n); };
        if (numbers.size() == 2 && pixel(numbers[0]) && pixel(numbers[1])) {
            place = Pixel{static_cast<int>(numbers[0]), static_cast<int>(numbers[1])};
        } else if (!numbers.empty()) {
            problems.push_back({"", option, "'" + *text + "' is not a pixel", "write x,y, counted from the top left"});
        }
    };
    keep_pixel("--replay", options.replay, request.replay);
    keep_pixel("--pick", options.pick, request.pick);
    if (!problems.empty()) return tl::unexpected<Error>({ErrorKind::usage, std::move(problems)});
    return request;
}

// Lines of what is seen through a pixel.
std::string pick_text(const scene::Scene& scene, const std::optional<render::Pick>& pick) {
    if (!pick) return "nothing is there: the background\n";
    const auto name_or = [](const std::string& name, const char* kind, std::uint32_t index) { return name.empty() ? std::string(kind) + " " + std::to_string(index) : name; };
    std::ostringstream out;
    out << "object    ";
    for (const scene::NodeId& id : pick->path) out << (&id == &pick->path.front() ? "" : " / ") << name_or(scene.nodes[id.value].name, "node", id.value);
    const geometry::Shape& shape = scene.shapes[scene.nodes[pick->path.back().value].shape.value].shape;
    out << "\nshape     " << geometry::shape_names[shape.index()] << ", face " << pick->face << "\nmaterial  "
        << (pick->material.valid() ? name_or(scene.materials[pick->material.value].name, "material", pick->material.value) : "the default material");
    const auto coordinates = [&](const char* label, math::Vec3 v) { out << "\n" << label << v.x << " " << v.y << " " << v.z; };
    out << std::setprecision(9);
    coordinates("position  ", pick->position);
    coordinates("normal    ", pick->normal);
    return out.str() + "\n";
}

// Every output that cannot be written, before anything is rendered.
Expected<void> check_outputs(const RenderOptions& options, const Request& request) {
    OutputCheck all;
    for (const std::string& output : options.picture.outputs) all.add(io::can_write(output));
    if (!options.stats_file.empty()) all.add(can_write_file(options.stats_file));
    all.add(check(request.checkpoint));
    return all.result();
}

// Lets the picture grow until it is complete, the time is over or the user has seen enough. The first whole picture is
// always waited for.
Ending grow(render::Session& session, const Request& request, const StopRequests& stop, Checkpoints& checkpoints, ProgressDisplay& display) {
    constexpr auto between_updates = std::chrono::milliseconds(100);
    const auto start = Clock::now();
    const auto end = request.time ? start + std::chrono::duration_cast<Clock::duration>(*request.time) : Clock::time_point::max();
    render::Progress progress;
    while (true) {
        const auto update = Clock::now() + between_updates;
        progress = progress.first_picture ? session.advance({std::min(update, end), &stop.asked()})
                                          : session.advance({update, &stop.insisted()});
        display.show(progress, session);
        if (progress.done) return Ending::complete;
        if (stop.insisted()) return Ending::insisted;
        if (!progress.first_picture) continue;
        if (stop.asked()) return Ending::asked;
        checkpoints.look(session);
        if (Clock::now() >= end) return Ending::time;
    }
}

std::string summary(const render::Stats& stats, const render::RayCounts& rays_before, const scene::Settings& settings, const RunTimes& times,
                    const std::string& output) {
    const double rate = static_cast<double>(stats.rays.total() - rays_before.total()) / std::max(times.render, 1e-9);
    const auto count = [](std::uint64_t n) { return human_count(static_cast<double>(n)); };
    char bytes[32];
    std::snprintf(bytes, sizeof bytes, "%.0f", stats.bytes_per_pixel);
    return (output.empty() ? "" : output + "\n") + "  " + std::to_string(settings.width) + "x" + std::to_string(settings.height) + " in " +
           human_time(times.total) + " (load " + human_time(times.load) + ", render " + human_time(times.render) + ", " +
           std::to_string(stats.threads) + (stats.threads == 1 ? " thread)\n" : " threads)\n") + "  rays: " + count(stats.rays.total()) +
           " (camera " + count(stats.rays.camera) + ", reflected " + count(stats.rays.reflected) + ", refracted " +
           count(stats.rays.refracted) + ", shadow " + count(stats.rays.shadow) +
           (stats.rays.path > 0 ? ", sampled " + count(stats.rays.path) : "") + "), " + human_rate(rate) + "\n" +
           "  kept: " + count(stats.nodes) + " nodes, " + bytes + " bytes per pixel\n";
}

const char* ending_name(Ending ending) {
    switch (ending) {
        case Ending::complete: return "complete";
        case Ending::time: return "time";
        case Ending::asked:
        case Ending::insisted: return "signal";
    }
    return "";
}

ExitCode render(const RenderOptions& options, const Invocation& invocation) {
    const auto start = Clock::now();
    RunTimes times;

    const auto request = understand(options);
    if (!request) return fail(request.error());
    if (const auto writable = check_outputs(options, *request); !writable) return fail(writable.error());

    auto loaded = [&] {
        LoadingDisplay display(options.quiet);
        return load(request->scene, read_options(request->scene.cache, request->scene.verbose, display));
    }();
    if (!loaded) return fail(loaded.error());
    warn(loaded->warnings);
    if (const auto writable = check_alpha(options.picture.outputs, loaded->scene); !writable) return fail(writable.error());
    const auto hash = io::content_hash(options.scene.file);
    if (!hash) return fail(hash.error());
    times.load = seconds_since(start);
    const double cpu_loaded = cpu_seconds();

    const scene::Settings settings = loaded->scene.settings;
    for (const auto& [option, pixel] : {std::pair{"--replay", request->replay}, {"--pick", request->pick}}) {
        if (pixel && (pixel->x >= settings.width || pixel->y >= settings.height)) return fail({ErrorKind::usage, {{"", option, "the pixel is outside the picture", ""}}});
    }
    if (settings.order == scene::Order::automatic && !request->time) {
        prefer_finish(loaded->scene.settings, request->replay || request->pick || needs_all_layers(options.picture.outputs));
    }
    auto session = render::Session::open(std::move(loaded->scene));
    if (!session) return fail(session.error());

    Checkpoints checkpoints(request->checkpoint);
    if (const auto begun = checkpoints.begin(*session); !begun) return fail(begun.error());

    const StopRequests stop;
    const auto render_start = Clock::now();
    Ending ending;
    {
        ProgressDisplay display(options.quiet, request->time);
        display.announce("rendering " + std::to_string(settings.width) + "x" + std::to_string(settings.height));
        ending = grow(*session, *request, stop, checkpoints, display);
    }
    times.render = seconds_since(render_start);
    times.cpu_render = cpu_seconds() - cpu_loaded;
    if (ending == Ending::insisted) {
        note("stopped; nothing was written");
        return exit_stopped;
    }
    const auto saved = checkpoints.end(*session);  // before the picture: that could be made again from it

    const render::Stats stats = session->stats();
    nlohmann::ordered_json report = {{"version", CRESCENTE_VERSION},
                                     {"command", invocation.command_line},
                                     {"scene", {{"file", options.scene.file}, {"hash", *hash}, {"hash_function", "xxh64"}}},
                                     {"width", settings.width},
                                     {"height", settings.height},
                                     {"ended_by", ending_name(ending)}};
    report.update(stats_json(stats));
    if (checkpoints.wanted()) report["checkpoint"] = checkpoints.json();
    report["time"] = {{"load", times.load}, {"build", stats.build_seconds}, {"render", times.render}};

    if (!options.picture.outputs.empty()) {
        const auto write_start = Clock::now();
        const scene::Image picture = session->picture(needs_all_layers(options.picture.outputs));
        io::ImageOptions image = image_options(options.picture, session->scene(), picture);
        image.metadata = {{"Software", std::string("Crescente ") + CRESCENTE_VERSION},
                          {"Command", invocation.command_line},
                          {"SceneHash", "xxh64:" + *hash},
                          {"Statistics", report.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)}};
        for (const std::string& output : options.picture.outputs) {
            if (const auto written = io::write_image(picture, output, image); !written) return fail(written.error());
        }
        times.write = seconds_since(write_start);
    }

    times.total = seconds_since(start);
    times.cpu = cpu_seconds();
    report["time"]["write"] = times.write;
    report["time"]["total"] = times.total;
    report["time"]["cpu"] = times.cpu;
    report["time"]["cpu_render"] = times.cpu_render;
    if (!options.stats_file.empty()) {
        const std::string text = report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
        if (const auto written = write_atomically(options.stats_file, text); !written) return fail(written.error());
    }

    if (!options.quiet) {
        if (ending == Ending::time) note("the time was over before the picture was complete: it is whole, but not yet as fine as asked");
        if (ending == Ending::asked) note("stopped before the picture was complete: it is whole, but not yet as fine as asked");
        if (ending != Ending::complete && checkpoints.wanted() && saved) note("--resume goes on from " + checkpoints.file());
        std::string outputs;
        for (const std::string& output : options.picture.outputs) outputs += (outputs.empty() ? "" : ", ") + output;
        std::cout << summary(stats, checkpoints.rays_before(), settings, times, outputs);
    }
    if (request->replay) std::cout << session->describe(request->replay->x, request->replay->y);
    if (request->pick) std::cout << pick_text(session->scene(), session->pick(request->pick->x, request->pick->y));
    std::cout.flush();
    if (!saved) return fail(saved.error());
    return std::cout ? exit_ok : fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
}

}  // namespace

Command add_render(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("render", "Render a picture");
    const auto options = std::make_shared<RenderOptions>();
    add_scene_options(*parser, options->scene);
    add_picture_options(*parser, options->picture, true);
    parser->add_option("--time", options->time, "Stop rendering after this time (10s, 2m): the picture is whole at any moment")->option_text("TIME");
    add_checkpoint_options(*parser, options->checkpoint);
    parser->add_option("--stats", options->stats_file, "Write counters and times as JSON")->option_text("FILE");
    parser->add_option("--replay", options->replay, "Print the ray tree of a pixel, counted from the top left")->option_text("X,Y");
    parser->add_option("--pick", options->pick, "Print what is seen through a pixel: object, face, material, position, normal")->option_text("X,Y");
    parser->add_flag("-q,--quiet", options->quiet, "No progress and no summary");
    parser->footer(
        "Ctrl-C once finishes with the picture so far, twice stops at once and writes nothing.\n\n"
        "Examples:\n"
        "  crescente render engine.glb -o engine.png\n"
        "  crescente render engine.glb -o engine.png -o engine.exr --size 1920x1080 --camera iso --time 10s\n"
        "  crescente render engine.glb -o engine.png --size 16000x9000 --checkpoint engine.ck --resume --fresh\n"
        "  crescente render balls4.nff -o balls.png --depth 4 --set settings.contrast=0.05 --stats balls.json");
    return {parser, [options](const Invocation& invocation) { return render(*options, invocation); }};
}

}  // namespace crescente::app
