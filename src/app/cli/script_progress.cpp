#include "app/cli/script_progress.h"

#include <nlohmann/json.hpp>

#include "base/checksum.h"

namespace crescente::app {
namespace {

using Json = nlohmann::json;

// Of the lines up to this one.
std::uint64_t checksum_until(std::uint32_t line, const std::vector<io::ScriptLine>& lines) {
    std::uint64_t sum = 0;
    for (const io::ScriptLine& l : lines) {
        if (l.number <= line) sum = checksum(l.text, sum);
    }
    return sum;
}

// A whole number of the object, 0 if there is none.
std::uint64_t number(const Json& object, const char* key) {
    const auto found = object.find(key);
    return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>() : 0;
}

// The progress that a note tells; `lines` must begin with those that had been played. The note may be hostile.
Expected<ScriptProgress> progress_of(const std::string& note, const std::vector<io::ScriptLine>& lines, const std::string& script, const std::string& checkpoint) {
    const Json json = Json::parse(note, nullptr, false);
    if (!json.is_object() || !json.contains("line") || !json.contains("script")) {
        return failure(ErrorKind::input, {checkpoint, "", "is not of a script of edits", ""});
    }
    ScriptProgress progress;
    const std::uint64_t line = number(json, "line");
    if (line > 0xffffffff) return failure(ErrorKind::input, {checkpoint, "", "is of a script with more lines than there can be", ""});
    progress.line = static_cast<std::uint32_t>(line);
    if (number(json, "script") != checksum_until(progress.line, lines)) {
        return failure(ErrorKind::input, {checkpoint, "", "is of another script: the lines of " + script + " up to " + std::to_string(line) + " are not those that had been played", ""});
    }
    const auto fresh = json.find("fresh");
    if (fresh == json.end() || !fresh->is_object()) return progress;
    const auto seconds = fresh->find("seconds");
    progress.fresh = FreshRender{{number(*fresh, "camera"), number(*fresh, "reflected"), number(*fresh, "refracted"), number(*fresh, "shadow"), number(*fresh, "path")},
                                 seconds != fresh->end() && seconds->is_number() ? seconds->get<double>() : 0};
    return progress;
}

Expected<void> replay(const std::vector<io::ScriptLine>& lines, std::uint32_t last, const std::string& script, render::Session& session, render::History& history) {
    for (const io::ScriptLine& line : lines) {
        const bool grows_or_shows = std::holds_alternative<io::Advance>(line.step) || std::holds_alternative<io::SavePicture>(line.step);
        if (line.number > last || grows_or_shows) continue;
        if (const auto made = make_edits(line, script, session, history); !made) return tl::unexpected(made.error());
    }
    return {};
}

}  // namespace

std::string note_of(const ScriptProgress& progress, const std::vector<io::ScriptLine>& lines) {
    Json note = {{"line", progress.line}, {"script", checksum_until(progress.line, lines)}};
    if (progress.fresh) {
        const render::RayCounts& rays = progress.fresh->rays;
        note["fresh"] = {{"camera", rays.camera}, {"reflected", rays.reflected}, {"refracted", rays.refracted}, {"shadow", rays.shadow}, {"path", rays.path}, {"seconds", progress.fresh->seconds}};
    }
    return note.dump();
}

Expected<ScriptSession> begin_script(Checkpoints& checkpoints, scene::Scene scene, const std::vector<io::ScriptLine>& lines, const std::string& script) {
    const auto head = checkpoints.head();
    if (!head) return tl::unexpected(head.error());
    if (*head) {
        const auto progress = progress_of((*head)->note, lines, script, checkpoints.file());
        auto session = render::Session::open(scene);
        if (!session) return tl::unexpected(session.error());
        render::History history;
        Expected<void> fits = progress ? replay(lines, progress->line, script, *session, history) : tl::unexpected(progress.error());
        fits = fits ? checkpoints.begin(*session) : checkpoints.refuse(fits.error());
        if (!fits) return tl::unexpected(fits.error());
        if (checkpoints.resumed()) return ScriptSession{std::move(*session), std::move(history), *progress};
    }
    auto session = render::Session::open(std::move(scene));
    if (!session) return tl::unexpected(session.error());
    return ScriptSession{std::move(*session), {}, {}};
}

}  // namespace crescente::app
