// crescente edit MODEL SCRIPT
#include <algorithm>
#include <filesystem>
#include <functional>
#include <iostream>
#include <iterator>
#include <memory>

#include "app/cli/checkpoints.h"
#include "app/cli/command.h"
#include "app/cli/edit_report.h"
#include "app/cli/load.h"
#include "app/cli/picture_options.h"
#include "app/cli/progress.h"
#include "app/cli/script_progress.h"
#include "app/cli/stop.h"
#include "base/atomic_file.h"
#include "io/content_hash.h"
#include "io/scene_file.h"
#include "io/text_file.h"

namespace crescente::app {
namespace {

struct EditOptions {
    SceneOptions scene;
    PictureOptions picture;
    CheckpointOptions checkpoint;
    std::string script, report_file;
    bool check = false, quiet = false;
};

// Whether that output is not a picture but the scene itself.
bool is_scene(const std::filesystem::path& output) { return output.extension() == ".json"; }

// Every picture, the report and the checkpoint, before anything is rendered.
Expected<void> check_outputs(const EditOptions& options, const CheckpointRequest& checkpoint, const std::vector<io::ScriptLine>& lines) {
    OutputCheck all;
    for (const std::string& output : options.picture.outputs) all.add(is_scene(output) ? can_write_file(output) : io::can_write(output));
    if (!options.report_file.empty()) all.add(can_write_file(options.report_file));
    all.add(check(checkpoint));
    for (const io::ScriptLine& line : lines) {
        const auto* picture = std::get_if<io::SavePicture>(&line.step);
        if (!picture) continue;
        auto writable = io::can_write(picture->file);
        if (!writable) {
            for (Problem& problem : writable.error().problems) problem.hint += (problem.hint.empty() ? "" : "; ") + options.script + ", line " + std::to_string(line.number);
        }
        all.add(writable);
    }
    return all.result();
}

Expected<std::vector<io::ScriptLine>> read_script(const std::string& file) {
    const auto text = io::read_whole_file(file);
    if (!text) return tl::unexpected(text.error());
    return io::read_edit_script(*text, file);
}

Expected<void> write_pictures(const render::Session& session, const std::vector<std::string>& outputs, const PictureOptions& options, const Invocation& invocation) {
    if (outputs.empty()) return {};
    const scene::Image picture = session.picture(needs_all_layers(outputs));
    io::ImageOptions image = image_options(options, session.scene(), picture);
    image.metadata = {{"Software", std::string("Crescente ") + CRESCENTE_VERSION}, {"Command", invocation.command_line}};
    for (const std::string& output : outputs) {
        if (auto written = io::write_image(picture, output, image); !written) return written;
    }
    return {};
}

// Renders to the end. Nothing if the user stopped it.
std::optional<FreshRender> render_fresh(render::Session& session, const StopRequests& stop, const std::function<void()>& pause, bool quiet) {
    constexpr auto between_updates = std::chrono::milliseconds(100);
    ProgressDisplay display(quiet, std::nullopt);
    const scene::Settings& settings = session.scene().settings;
    display.announce("rendering " + std::to_string(settings.width) + "x" + std::to_string(settings.height));
    render::Progress progress;
    while (!progress.done) {
        progress = session.advance({std::chrono::steady_clock::now() + between_updates, &stop.asked()});
        display.show(progress, session);
        if (stop.asked()) return std::nullopt;
        pause();
    }
    const render::Stats stats = session.stats();
    return FreshRender{stats.rays, stats.build_seconds + stats.render_seconds};
}

ExitCode stopped() {
    note("stopped; the last picture and the report were not written");
    return exit_stopped;
}

ExitCode edit(const EditOptions& options, const Invocation& invocation) {
    const auto request = understand(options.scene);
    if (!request) return fail(request.error());
    const auto checkpoint = understand(options.checkpoint);
    if (!checkpoint) return fail(checkpoint.error());
    const auto lines = read_script(options.script);
    if (!lines) return fail(lines.error());
    if (const auto writable = check_outputs(options, *checkpoint, *lines); !writable) return fail(writable.error());

    auto loaded = [&] {
        LoadingDisplay display(options.quiet);
        return load(*request, read_options(request->cache, request->verbose, display));
    }();
    if (!loaded) return fail(loaded.error());
    warn(loaded->warnings);
    std::vector<std::string> pictures;
    std::remove_copy_if(options.picture.outputs.begin(), options.picture.outputs.end(), std::back_inserter(pictures), is_scene);
    if (const auto writable = check_alpha(pictures, loaded->scene); !writable) return fail(writable.error());
    const auto hash = io::content_hash(options.scene.file);
    if (!hash) return fail(hash.error());

    Checkpoints checkpoints(*checkpoint);
    auto begun = begin_script(checkpoints, std::move(loaded->scene), *lines, options.script);
    if (!begun) return fail(begun.error());
    render::Session& session = begun->session;
    ScriptProgress& progress = begun->progress;
    const auto look = [&] { checkpoints.look(session, note_of(progress, *lines)); };
    // What is done is kept, however early the script ends.
    const auto ended = [&](ExitCode code) {
        const auto saved = checkpoints.end(session, note_of(progress, *lines));
        return saved ? code : fail(saved.error());
    };

    const StopRequests stop;
    if (!progress.fresh) progress.fresh = render_fresh(session, stop, look, options.quiet);
    if (!progress.fresh) return ended(stopped());
    const FreshRender fresh = *progress.fresh;

    const auto say = [&](const std::string& text) {
        if (!options.quiet) std::cout << text << std::flush;
    };
    const scene::Settings first = session.scene().settings;
    say(report_head(first, tiles_of(first), session.stats().threads, fresh));
    std::vector<PlayedEdit> edits;
    EditPlayer player(
        session, begun->history, options.script, stop.asked(), [&](const std::string& file) { return write_pictures(session, {file}, options.picture, invocation); },
        [&](const PlayedEdit& played) {
            edits.push_back(played);
            say(report_row(played, tiles_of(session.scene().settings), fresh));
        },
        look);
    const std::uint32_t played_before = progress.line;
    if (played_before > 0) player.go_on();
    for (const io::ScriptLine& line : *lines) {
        if (stop.asked()) return ended(stopped());
        if (line.number <= played_before) continue;
        if (const auto played = player.play(line); !played) return ended(fail(played.error()));
        const bool unsaved = stop.asked() && std::holds_alternative<io::SavePicture>(line.step);
        if (!unsaved) progress.line = line.number;
    }
    player.finish();
    if (stop.asked()) return ended(stopped());
    const auto saved = checkpoints.end(session, note_of(progress, *lines));
    say(report_sums(edits, fresh));

    nlohmann::ordered_json report = {{"version", CRESCENTE_VERSION},
                                     {"command", invocation.command_line},
                                     {"scene", {{"file", options.scene.file}, {"hash", *hash}, {"hash_function", "xxh64"}}},
                                     {"script", options.script},
                                     {"language_version", io::edit_language_version},
                                     {"width", first.width},
                                     {"height", first.height},
                                     {"tiles", tiles_of(first)},
                                     {"threads", session.stats().threads},
                                     {"fresh", fresh_json(fresh)},
                                     {"edits", edits_json(edits, fresh)},
                                     {"sum", sums_json(edits)}};
    if (checkpoints.wanted()) {
        report["checkpoint"] = checkpoints.json();
        report["checkpoint"]["played_before"] = played_before;
    }
    bool equal = true;
    if (options.check) {
        auto again = render::Session::open(session.scene());
        if (!again) return fail(again.error());
        const auto cost = render_fresh(*again, stop, [] {}, options.quiet);
        if (!cost) return stopped();
        const std::size_t different = different_pixels(session.picture(true), again->picture(true));
        equal = different == 0;
        report["check"] = {{"equal", equal}, {"different_pixels", different}};
        report["check"].update(fresh_json(*cost));
        say(equal ? "check: the picture is that of a fresh render, to the bit\n"
                  : "check: " + std::to_string(different) + " pixels differ from a fresh render\n");
    }
    if (const auto written = write_pictures(session, pictures, options.picture, invocation); !written) return fail(written.error());
    for (const std::string& output : options.picture.outputs) {
        if (!is_scene(output)) continue;
        if (const auto written = io::write_scene_file(output, session.scene(), loaded->sources); !written) return fail(written.error());
    }
    if (!options.report_file.empty()) {
        const std::string text = report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
        if (const auto written = write_atomically(options.report_file, text); !written) return fail(written.error());
    }
    std::cout.flush();
    if (!std::cout) return fail({ErrorKind::output, {{"", "standard output", "cannot be written", ""}}});
    if (!equal) note("the picture after the edits is not that of a fresh render: please report it, with model and script");
    if (!saved) return fail(saved.error());
    return equal ? exit_ok : exit_different;
}

}  // namespace

Command add_edit(CLI::App& app) {
    CLI::App* parser = app.add_subcommand("edit", "Play a script of edits on a scene, and tell what each costs");
    const auto options = std::make_shared<EditOptions>();
    add_scene_options(*parser, options->scene);
    parser->add_option("SCRIPT", options->script, "Edits, a JSON object a line (see docs/edits.md)")->required()->option_text(" ");
    add_picture_options(*parser, options->picture, false);
    add_checkpoint_options(*parser, options->checkpoint);
    parser->add_option("--json", options->report_file, "Write what each edit cost as JSON")->option_text("FILE");
    parser->add_flag("--check", options->check, "At the end compare with a fresh render; exit code 1 if any bit differs");
    parser->add_flag("-q,--quiet", options->quiet, "No progress and no table");
    parser->footer(
        "A line is an edit, or {\"undo\": 1}, {\"redo\": 1}, {\"advance\": {\"seconds\": 0.1}}, {\"picture\": \"file.png\"}. An edit that no advance follows\n"
        "is let grow to the end.\n\n"
        "Examples:\n"
        "  crescente edit engine.glb edits.jsonl -o edited.png --size 1920x1080\n"
        "  crescente edit scene.json edits.jsonl --check --json costs.json\n"
        "  crescente edit part.step edits.jsonl -o edited.json");
    return {parser, [options](const Invocation& invocation) { return edit(*options, invocation); }};
}

}  // namespace crescente::app
