#include "app/cli/edit_player.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "app/cli/report.h"
#include "io/edit_text.h"

namespace crescente::app {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

Clock::time_point in_seconds(double seconds) {
    constexpr double longest = 1e6;
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(std::min(seconds, longest)));
}

// The place of a level among the choices of the setting.
int level_index(const std::string& name) {
    for (const auto& field : scene::Settings::fields()) {
        if (field.info.name != "level") continue;
        return static_cast<int>(std::find(field.info.choices.begin(), field.info.choices.end(), name) - field.info.choices.begin());
    }
    return 0;
}

std::string line_text(std::uint32_t number) { return "line " + std::to_string(number); }

using Reports = std::vector<render::EditReport>;

Expected<Reports> make_edit(const io::ScriptLine& line, const io::Json& json, const std::string& script, render::Session& session, render::History& history) {
    Problems warnings;
    auto edits = io::read_edit(json, session.scene(), script, &warnings);
    warn(warnings);
    if (!edits) return tl::unexpected(std::move(edits.error()));
    auto report = history.edit(session, std::move(*edits), script);
    if (!report) {
        for (Problem& problem : report.error().problems) problem.place = line_text(line.number) + (problem.place.empty() ? "" : ", " + problem.place);
        return tl::unexpected(std::move(report.error()));
    }
    Reports reports;
    reports.push_back(std::move(*report));
    return reports;
}

Expected<Reports> go_through_history(const io::ScriptLine& line, int times, bool undo, const std::string& script, render::Session& session, render::History& history) {
    const std::size_t there = undo ? history.undoable() : history.redoable();
    if (there < static_cast<std::size_t>(times)) {
        const std::string reason = std::string(there == 0 ? "no edit" : there == 1 ? "one edit only" : std::to_string(there) + " edits only") + " can be " +
                                   (undo ? "taken back" : "made again");
        return failure(ErrorKind::input, {script, line_text(line.number) + (undo ? ", /undo" : ", /redo"), reason, ""});
    }
    Reports reports;
    for (int i = 0; i < times; ++i) {
        auto report = undo ? history.undo(session) : history.redo(session);
        if (!report) return tl::unexpected(std::move(report.error()));
        reports.push_back(std::move(*report));
    }
    return reports;
}

}  // namespace

Expected<Reports> make_edits(const io::ScriptLine& line, const std::string& script, render::Session& session, render::History& history) {
    if (const auto* json = std::get_if<io::Json>(&line.step)) return make_edit(line, *json, script, session, history);
    if (const auto* undo = std::get_if<io::Undo>(&line.step)) return go_through_history(line, undo->times, true, script, session, history);
    return go_through_history(line, std::get<io::Redo>(line.step).times, false, script, session, history);
}

std::size_t tiles_of(const scene::Settings& settings) {
    const auto across = [&](int pixels) { return static_cast<std::size_t>((pixels + settings.tile - 1) / settings.tile); };
    return across(settings.width) * across(settings.height);
}

EditPlayer::EditPlayer(render::Session& session, render::History& history, std::string script, const std::atomic<bool>& stop, std::function<Expected<void>(const std::string&)> save,
                       std::function<void(const PlayedEdit&)> finished, std::function<void()> pause)
    : session_(session), history_(history), script_(std::move(script)), stop_(stop), save_(std::move(save)), finished_(std::move(finished)), pause_(std::move(pause)) {
    progress_.done = true;
}

Expected<void> EditPlayer::play(const io::ScriptLine& line) {
    if (const auto* advance = std::get_if<io::Advance>(&line.step)) {
        advanced_ = true;
        grow(*advance);
        return {};
    }
    settle();
    if (const auto* picture = std::get_if<io::SavePicture>(&line.step)) {
        if (stop_) return {};
        return save_(picture->file);
    }
    begin(line);
    const auto reports = make_edits(line, script_, session_, history_);
    if (!reports) {
        edit_.reset();
        return tl::unexpected(reports.error());
    }
    for (const render::EditReport& report : *reports) take(report);
    return {};
}

void EditPlayer::finish() {
    settle();
    end();
    grow({});
}

void EditPlayer::begin(const io::ScriptLine& line) {
    end();
    session_.refresh(frame_);
    before_ = frame_.image;
    stats_before_ = session_.stats();
    edit_ = PlayedEdit{};
    edit_->line = line.number;
    edit_->text = line.text;
    advanced_ = false;
    elapsed_ = 0;
}

void EditPlayer::take(const render::EditReport& report) {
    edit_->began_anew = edit_->began_anew || report.began_anew;
    edit_->accelerator_kept = edit_->accelerator_kept && report.accelerator_kept;
    edit_->edit_seconds += report.seconds;
    elapsed_ += report.seconds;
    progress_ = session_.advance({Clock::now(), nullptr});  // does nothing, but tells what is to be done
}

void EditPlayer::end() {
    if (!edit_) return;
    const render::Stats stats = session_.stats();
    edit_->rays = stats.rays - stats_before_.rays;
    const std::size_t all = tiles_of(session_.scene().settings);
    edit_->tiles = edit_->began_anew ? all : std::min<std::size_t>(all, stats.revised_tiles - stats_before_.revised_tiles);
    if (progress_.done) edit_->converged = elapsed_;
    finished_(*edit_);
    edit_.reset();
}

void EditPlayer::settle() {
    if (edit_ && !advanced_) grow({});
}

bool EditPlayer::enough(const io::Advance& until, double grown) const {
    return progress_.done || stop_ || (until.seconds && grown >= *until.seconds) ||
           (until.level && level_index(progress_.level) > static_cast<int>(*until.level));
}

void EditPlayer::grow(const io::Advance& until) {
    constexpr double quantum = 0.002, share = 1.0 / 8, longest = 0.5;
    double grown = 0;
    while (!enough(until, grown)) {
        const bool looking = edit_ && !edit_->first;
        // Pictures are compared every few milliseconds at first, then at every eighth of the time more.
        double step = looking ? std::max(quantum, elapsed_ * share) : until.level ? quantum : longest;
        step = std::min(step, longest);
        if (until.seconds) step = std::min(step, *until.seconds - grown);
        const auto start = Clock::now();
        progress_ = session_.advance({in_seconds(step), &stop_});
        const double seconds = seconds_since(start);
        grown += seconds, elapsed_ += seconds;
        if (looking) look_for_change();
        pause_();
    }
}

// A view from elsewhere is new once it is whole; in the others what an edit does not touch stays as it was.
void EditPlayer::look_for_change() {
    if (edit_->first || (edit_->began_anew && !progress_.first_picture)) return;
    const auto start = Clock::now();
    session_.refresh(frame_);
    const double seconds = seconds_since(start);
    if (different_pixels(before_, frame_.image) > 0) edit_->first = elapsed_ + seconds;
}

std::size_t different_pixels(const scene::Image& a, const scene::Image& b) {
    const std::size_t pixels = static_cast<std::size_t>(b.width) * static_cast<std::size_t>(b.height);
    if (a.width != b.width || a.height != b.height || a.layers.size() != b.layers.size()) return pixels;
    std::vector<bool> differs(pixels, false);
    for (std::size_t l = 0; l < a.layers.size(); ++l) {
        const scene::Layer &x = a.layers[l], &y = b.layers[l];
        if (x.name != y.name || x.values.size() != y.values.size()) return pixels;
        if (pixels == 0 || std::memcmp(x.values.data(), y.values.data(), x.values.size() * sizeof(float)) == 0) continue;
        const std::size_t channels = x.values.size() / pixels;
        for (std::size_t i = 0; i < pixels; ++i) {
            if (std::memcmp(&x.values[i * channels], &y.values[i * channels], channels * sizeof(float)) != 0) differs[i] = true;
        }
    }
    return static_cast<std::size_t>(std::count(differs.begin(), differs.end(), true));
}

}  // namespace crescente::app
