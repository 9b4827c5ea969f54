// How far a script of edits has got, kept in the checkpoints of its session, and going on from there.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "app/cli/checkpoints.h"
#include "app/cli/edit_report.h"
#include "io/edit_script.h"

namespace crescente::app {

struct ScriptProgress {
    std::uint32_t line = 0;            // of the last line that was played; 0: none
    std::optional<FreshRender> fresh;  // what the render before the first line cost, once it is done
};

// As the note of a checkpoint. `lines`: of the script.
std::string note_of(const ScriptProgress& progress, const std::vector<io::ScriptLine>& lines);

struct ScriptSession {
    render::Session session;
    render::History history;
    ScriptProgress progress;
};

// The session in which the script is played: of the scene, or, if that was asked for, as the checkpoint has it. The scene then comes about by the edits of the
// lines that had been played, which trace nothing. Errors: as of Session::open; input where the checkpoint does not fit the model or the script.
Expected<ScriptSession> begin_script(Checkpoints& checkpoints, scene::Scene scene, const std::vector<io::ScriptLine>& lines, const std::string& script);

}  // namespace crescente::app
