// What the page asks of a viewer.
#include <algorithm>

#include "app/cli/load.h"
#include "app/server/studio_edits.h"
#include "app/server/trees_json.h"
#include "app/server/viewer_work.h"
#include "io/edit_text.h"
#include "io/panorama_file.h"

namespace crescente::app {
namespace {

Error nothing_open() { return {ErrorKind::input, {{"", "", "no model is open", "send `open` first"}}}; }

// {"VERB": value}, as edits are told.
io::Json edit_of(const std::string& verb, io::Json value) {
    io::Json edit = io::Json::make_object();
    edit.object()->push_back({verb, std::move(value)});
    return edit;
}

}  // namespace

void Viewer::Work::attach(std::uint32_t page) {
    say_.page = page;
    if (page == 0) return;
    frames_.begin_anew();
    frames_.show(ShownLayer::color);
    sent_ = shown_ = looks_ = 0;
    unshown_ = true;
    next_frame_ = next_progress_ = Clock::now();
    progress_untold_ = true;
    opened_ = session_.has_value();
    if (!session_ && lost_) say_error(*lost_, {});
    if (session_) untold_ = SceneParts::all();
}

bool Viewer::Work::needs_session(const MessageId& id) {
    if (!session_) say_error(nothing_open(), id);
    return session_.has_value();
}

void Viewer::Work::carry_out(Message message) {
    if (!message.request) return say_error(message.request.error(), message.id);
    Request& request = *message.request;
    if (const auto* shown = std::get_if<FrameShown>(&request)) {
        if (shown->number <= sent_) shown_ = std::max(shown_, shown->number);
        return;
    }
    if (const auto* opened = std::get_if<OpenFile>(&request)) return open(opened->file, message.id);
    if (const auto* files = std::get_if<ListFiles>(&request)) return list_files(message.id, files->folder);
    if (const auto* until = std::get_if<GrowUntil>(&request); until && !session_) {
        wanted_level_ = until->level;
        return say_.text(edited_reply({}, edit_state(), message.id));
    }
    if (const auto* pause = std::get_if<Pause>(&request)) {
        paused_ = pause->paused;
        progress_untold_ = true;
        return;
    }
    if (!needs_session(message.id)) return;
    take_look();  // what follows is about what the camera sees
    if (auto* change = std::get_if<EditScene>(&request)) return edit(message, change->edit);
    if (const auto* undo = std::get_if<UndoEdits>(&request)) return walk_history(message.id, undo->times, true);
    if (const auto* redo = std::get_if<RedoEdits>(&request)) return walk_history(message.id, redo->times, false);
    if (const auto* until = std::get_if<GrowUntil>(&request)) return set_until(message.id, until->level);
    if (const auto* attend = std::get_if<Attend>(&request)) return session_->look_at(attend->area.value_or(render::Area{}));
    if (const auto* layer = std::get_if<ShowLayer>(&request)) {
        frames_.show(layer->layer);
        unshown_ = true;
        return;
    }
    if (const auto* at = std::get_if<PickAt>(&request)) return say_.text(picked_reply(session_->pick(at->x, at->y), session_->scene(), message.id));
    if (const auto* at = std::get_if<ReplayAt>(&request)) return replay(message.id, at->x, at->y);
    if (const auto* studio = std::get_if<SetStudio>(&request)) return set_studio(message, studio->name);
    if (const auto* ground = std::get_if<SetGround>(&request)) return set_ground(message, ground->ground);
    if (const auto* environment = std::get_if<EnvironmentFile>(&request)) return set_environment_file(message, environment->file);
    if (auto* wanted = std::get_if<Export>(&request)) return begin_export(message, std::move(*wanted));
    if (const auto* cancel = std::get_if<CancelExport>(&request)) return cancel_export(cancel->number);
}

void Viewer::Work::open(const std::string& name, const MessageId& id) {
    const auto fail = [&](const Error& error) {
        if (!session_) lost_ = error;
        say_error(error, id);
    };
    const auto found = settings_.files->find(name, settings_.uploads);
    if (!found) return fail(found.error());
    if (name.starts_with("upload/")) {
        if (const auto allowed = check_upload(*found, *settings_.files, settings_.uploads); !allowed) return fail(allowed.error());
    }
    io::ReadOptions options;
    options.cache = settings_.request.cache;
    options.cancelled = [this] { return box_.stopping_.load(); };
    auto last = Clock::time_point{};
    options.progress = [&](double fraction, std::string_view stage) {
        constexpr auto between = std::chrono::milliseconds(100);
        if (Clock::now() - last < between) return;
        last = Clock::now();
        say_.news(reply("opening", {{"file", name}, {"fraction", fraction}, {"stage", std::string(stage)}}));
    };
    say_.news(reply("opening", {{"file", name}, {"fraction", 0}, {"stage", "reading"}}));
    SceneRequest request = settings_.request;
    if (request.file != name) request.overrides.clear(), request.view = {};  // they are for the model that the program was begun with
    request.file = found->string();
    auto loaded = load(request, options);
    if (!loaded) return fail(loaded.error());
    {
        const std::lock_guard lock(box_.mutex_);  // the page may have told its size meanwhile
        if (box_.orders_.view) wanted_view_ = *box_.orders_.view;
    }
    scene::Settings& settings = loaded->scene.settings;
    if (wanted_view_.width > 0) settings.width = wanted_view_.width, settings.height = wanted_view_.height;
    if (wanted_level_) settings.level = *wanted_level_;
    auto session = render::Session::open(std::move(loaded->scene));
    if (!session) return fail(session.error());

    settings_.files->opened(*found);
    session_.emplace(std::move(*session));
    history_.forget();
    lost_.reset();
    file_ = found->string();
    title_ = name;
    warnings_ = std::move(loaded->warnings);
    note_sources(std::move(loaded->sources));
    look_.reset();
    fresh_rays_.reset();
    progress_ = {};
    frames_.begin_anew();
    rays_before_ = camera_rays_before_ = tiles_before_ = rays_told_ = 0;
    rays_told_at_ = Clock::now();
    fresh_from_ = 0;
    grown_seconds_ = 0;
    ++revision_;
    opened_ = true;
    untold_ = SceneParts::all();
    whole_first_ = unshown_ = progress_untold_ = true;
    next_frame_ = Clock::now();
    if (id) say_.text(reply("opened", {{"file", name}}, id));
}

// An upload is gone with its session: the user, who has the file, puts a saved scene beside it.
void Viewer::Work::note_sources(io::ShapeSources sources) {
    for (auto& [shape, source] : sources) {
        const auto below = source.file.lexically_relative(std::filesystem::weakly_canonical(settings_.uploads));
        if (!below.empty() && *below.begin() != "..") source.file = below;
    }
    sources_ = std::move(sources);
}

void Viewer::Work::list_files(const MessageId& id, const std::optional<std::string>& folder) {
    auto list = settings_.files->list(folder, settings_.uploads);
    if (!list) return say_error(list.error(), id);
    say_.text(reply("files", std::move(*list), id));
}

void Viewer::Work::after_edit(const render::EditReport& report, const SceneParts& parts) {
    const render::Stats stats = session_->stats();
    rays_before_ = stats.rays.total();
    camera_rays_before_ = stats.rays.camera;
    tiles_before_ = stats.revised_tiles;
    grown_seconds_ = 0;
    fresh_from_.reset();
    if (report.began_anew) {
        fresh_from_ = rays_before_;
        fresh_rays_.reset();
    }
    progress_ = session_->advance({Clock::now(), nullptr});  // does nothing, but tells what is to be done
    frames_.scene_changed();
    ++revision_;
    untold_ |= parts;
    unshown_ = progress_untold_ = true;
    next_frame_ = next_progress_ = Clock::now();
}

void Viewer::Work::apply(const Message& message, std::vector<scene::Edit> edits) {
    const SceneParts parts = parts_of(edits);
    const auto report = history_.edit(*session_, std::move(edits), {}, message.gesture);
    if (!report) return say_error(report.error(), message.id);
    after_edit(*report, parts);
    say_.text(edited_reply(*report, edit_state(), message.id));
}

void Viewer::Work::edit(Message& message, const io::Json& json) {
    const std::filesystem::path folder = std::filesystem::path(file_).parent_path();
    if (const auto allowed = check_named_files(json, *settings_.files, folder, settings_.uploads); !allowed) return say_error(allowed.error(), message.id);
    auto edits = io::read_edit(json, session_->scene(), file_);
    if (!edits) {
        for (Problem& problem : edits.error().problems) {
            if (problem.file == file_) problem.file.clear();  // it is the page's message that is wrong
        }
        return say_error(edits.error(), message.id);
    }
    apply(message, std::move(*edits));
}

void Viewer::Work::walk_history(const MessageId& id, int times, bool undo) {
    const std::size_t there = undo ? history_.undoable() : history_.redoable();
    if (there < static_cast<std::size_t>(times)) {
        return say_error({ErrorKind::input, {{"", undo ? "/undo" : "/redo", std::to_string(there) + " edits can be " + (undo ? "taken back" : "made again"), ""}}}, id);
    }
    render::EditReport whole;
    for (int i = 0; i < times; ++i) {
        const auto report = undo ? history_.undo(*session_) : history_.redo(*session_);
        if (!report) return say_error(report.error(), id);
        whole.began_anew = whole.began_anew || report->began_anew;
        whole.seconds += report->seconds;
    }
    after_edit(whole, SceneParts::all());
    keep_view();
    say_.text(edited_reply(whole, edit_state(), id));
}

Expected<render::EditReport> Viewer::Work::change_unseen(std::vector<scene::Edit> edits) {
    auto report = session_->edit(std::move(edits));
    if (report) after_edit(*report, {});
    return report;
}

// Settings are one value to undo: the size and the level that the page asked for since stay.
void Viewer::Work::keep_view() {
    scene::Settings settings = session_->scene().settings;
    if (wanted_view_.width > 0) settings.width = wanted_view_.width, settings.height = wanted_view_.height;
    if (wanted_level_) settings.level = *wanted_level_;
    if (settings == session_->scene().settings) return;
    if (const auto changed = change_unseen({scene::SetSettings{settings}}); !changed) say_error(changed.error(), {});
    untold_.settings = true;
}

void Viewer::Work::take_view() {
    if (!view_) return;
    wanted_view_ = *std::exchange(view_, {});
    if (!session_) return;
    const scene::Settings& settings = session_->scene().settings;
    if (settings.width == wanted_view_.width && settings.height == wanted_view_.height) return;
    whole_first_ = true;
    frames_.begin_anew();
    keep_view();
}

// The newest camera, once the picture of the one before is whole: so that a drag shows every camera that it takes.
bool Viewer::Work::take_look() {
    if (!look_ || !session_) return false;
    if (!progress_.first_picture && !whole_first_) return false;
    Look look = std::move(*look_);
    look_.reset();
    auto edits = io::read_edit(edit_of("camera", std::move(look.camera)), session_->scene(), {});
    if (!edits) {
        say_error(edits.error(), {});
        return false;
    }
    looks_ = look.number;
    unshown_ = true;
    if (edits->empty()) return false;
    frames_.begin_picture();
    if (const auto changed = change_unseen(std::move(*edits)); !changed) say_error(changed.error(), {});
    return true;
}

void Viewer::Work::set_until(const MessageId& id, scene::Level level) {
    wanted_level_ = level;
    scene::Settings settings = session_->scene().settings;
    const auto begun = level > settings.level ? fresh_from_ : std::nullopt;
    settings.level = level;
    const auto report = change_unseen({scene::SetSettings{settings}});
    if (!report) return say_error(report.error(), id);
    if (begun) fresh_from_ = begun;  // it is still a fresh picture that grows
    untold_.settings = true;
    say_.text(edited_reply(*report, edit_state(), id));
}

void Viewer::Work::set_studio(const Message& message, const std::optional<std::string>& name) {
    auto edits = studio_edits(session_->scene(), name);
    if (!edits) return say_error(edits.error(), message.id);
    apply(message, std::move(*edits));
}

void Viewer::Work::set_ground(const Message& message, scene::Ground ground) {
    auto edits = ground_edits(session_->scene(), ground);
    if (!edits) return say_error(edits.error(), message.id);
    apply(message, std::move(*edits));
}

void Viewer::Work::set_environment_file(const Message& message, const std::optional<std::string>& file) {
    scene::Environment around = session_->scene().environment.value_or(scene::Environment{});
    around.sky.clear(), around.image.clear();
    around.panorama.reset();
    if (file) {
        const auto found = settings_.files->find(*file, settings_.uploads);
        if (!found) return say_error(found.error(), message.id);
        around.image = found->string();
        const auto warnings = io::load_panorama(around, {});
        if (!warnings) return say_error(warnings.error(), message.id);
    }
    apply(message, {scene::SetEnvironment{std::move(around)}});
}

void Viewer::Work::replay(const MessageId& id, int x, int y) {
    const render::PixelTrees trees = session_->trees(x, y);
    say_.text(reply("replayed", {{"text", render::text_of(trees)}, {"trees", trees_json(trees, session_->scene().unit.metres)}}, id));
}

}  // namespace crescente::app
