// Plays a script of edits on a session, and measures what each costs.
#pragma once

#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "io/edit_script.h"
#include "render/history.h"

namespace crescente::app {

// What the edit of a line came to, until the next edit.
struct PlayedEdit {
    std::uint32_t line = 0;
    std::string text;                 // of the line
    std::size_t tiles = 0;            // whose trees it touched
    bool began_anew = false;          // no tree was kept
    bool accelerator_kept = true;
    render::RayCounts rays;           // traced since
    double edit_seconds = 0;          // in which the scene was changed, before any tree is
    std::optional<double> first;      // seconds to the first picture that differs from the one before; nothing: none does
    std::optional<double> converged;  // seconds to the finished picture, without those in which pictures were compared; nothing: it was not let grow to the end
};

// Makes the edits of a line, which must be an edit, an undo or a redo; nothing grows. Errors: of the line, of which then nothing is done.
Expected<std::vector<render::EditReport>> make_edits(const io::ScriptLine& line, const std::string& script, render::Session& session, render::History& history);

class EditPlayer {
public:
    // `save` writes the picture as it is; `finished` hears of each edit once the next begins; `pause` is called every now and then while
    // the picture grows. `stop` ends growing.
    EditPlayer(render::Session& session, render::History& history, std::string script, const std::atomic<bool>& stop, std::function<Expected<void>(const std::string& file)> save,
               std::function<void(const PlayedEdit&)> finished, std::function<void()> pause);

    // Errors: of the line, of which then nothing is done.
    Expected<void> play(const io::ScriptLine& line);

    // Before the first line, where the session goes on from a checkpoint: lets the picture grow to the end.
    void go_on() { grow({}); }

    // After the last line. Lets the picture grow to the end.
    void finish();

private:
    void begin(const io::ScriptLine& line);
    void take(const render::EditReport& report);
    void end();
    void settle();  // an edit that no `advance` followed grows to the end
    void grow(const io::Advance& until);
    bool enough(const io::Advance& until, double grown) const;
    void look_for_change();

    render::Session& session_;
    render::History& history_;
    std::string script_;
    const std::atomic<bool>& stop_;
    std::function<Expected<void>(const std::string&)> save_;
    std::function<void(const PlayedEdit&)> finished_;
    std::function<void()> pause_;

    std::optional<PlayedEdit> edit_;  // that is being measured
    bool advanced_ = false;           // the script lets it grow itself
    double elapsed_ = 0;              // seconds since the edit
    render::Stats stats_before_;
    render::Frame frame_;  // as it was last looked at
    scene::Image before_;
    render::Progress progress_;
};

// Tiles of the whole picture.
std::size_t tiles_of(const scene::Settings& settings);

// How many pixels differ, in any layer and to the bit; all if the pictures have other sizes or layers.
std::size_t different_pixels(const scene::Image& a, const scene::Image& b);

}  // namespace crescente::app
