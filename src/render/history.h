// Edits that can be taken back, and made again.
#pragma once

#include <vector>

#include "render/session.h"

namespace crescente::render {

// What the edits of one session undo. Edits of the session that go past it make what it remembers wrong.
class History {
public:
    // As Session::edit; what was taken back before is forgotten. The report's `undo` is kept here and left empty.
    Expected<EditReport> edit(Session& session, std::vector<scene::Edit> edits, const std::string& file = {});

    // Takes back the last edit that was not taken back, or makes again the last that was. There must be one. Errors: as Session::edit; nothing has
    // changed then.
    Expected<EditReport> undo(Session& session) { return play_last(session, undo_, redo_); }
    Expected<EditReport> redo(Session& session) { return play_last(session, redo_, undo_); }

    std::size_t undoable() const { return undo_.size(); }
    std::size_t redoable() const { return redo_.size(); }

private:
    using Edits = std::vector<scene::Edit>;
    static Expected<EditReport> play_last(Session& session, std::vector<Edits>& from, std::vector<Edits>& to);

    std::vector<Edits> undo_, redo_;
};

}  // namespace crescente::render
