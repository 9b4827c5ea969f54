// Scripts of edits: a JSON object a line, an edit or what a session does between edits (docs/edits.md).
#pragma once

#include "io/edit_text.h"
#include "scene/settings.h"

namespace crescente::io {

struct Undo {
    int times = 1;
};
struct Redo {
    int times = 1;
};
struct Advance {  // until the first of them; to the end if neither is said
    std::optional<double> seconds;
    std::optional<scene::Level> level;  // which is then complete
};
struct SavePicture {
    std::string file;
};

struct ScriptLine {
    std::uint32_t number = 0;  // in the script, from 1
    std::string text;          // without what surrounds it
    std::variant<Json, Undo, Redo, Advance, SavePicture> step;  // Json: an edit, to be read against the scene of that moment
};

// The verbs of a script besides those of edits.
std::span<const Word> script_words();
std::span<const Word> advance_words();

// The lines of a script; blank ones and those that begin with // are left out. Of edits only JSON and verb are looked at. Errors (input): every
// problem of all lines, with line and JSON pointer.
Expected<std::vector<ScriptLine>> read_edit_script(std::string_view text, const std::string& file);

}  // namespace crescente::io
