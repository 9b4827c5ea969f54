// Edits that can be taken back, and made again.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "render/session.h"

namespace crescente::render {

// What the edits of one session undo. Edits of the session that go past it make what it remembers wrong.
class History {
public:
    History() = default;
    // `most`: how many edits can be taken back; older ones are forgotten.
    explicit History(std::size_t most) : most_(most) {}

    // As Session::edit; what was taken back before is forgotten. The report's `undo` is kept here and left empty. Consecutive edits with the same `gesture`,
    // such as the steps of a drag, are one; empty: an edit of its own.
    Expected<EditReport> edit(Session& session, std::vector<scene::Edit> edits, const std::string& file = {}, const std::string& gesture = {});

    // Takes back the last edit that was not taken back, or makes again the last that was. There must be one. Errors: as Session::edit; nothing has
    // changed then.
    Expected<EditReport> undo(Session& session) { return play_last(session, undo_, redo_); }
    Expected<EditReport> redo(Session& session) { return play_last(session, redo_, undo_); }

    // For another session.
    void forget() { undo_.clear(), redo_.clear(), gesture_.clear(); }

    std::size_t undoable() const { return undo_.size(); }
    std::size_t redoable() const { return redo_.size(); }

private:
    using Edits = std::vector<scene::Edit>;
    Expected<EditReport> play_last(Session& session, std::vector<Edits>& from, std::vector<Edits>& to);

    std::size_t most_ = std::numeric_limits<std::size_t>::max();
    std::string gesture_;  // of the last edit
    std::vector<Edits> undo_, redo_;
};

}  // namespace crescente::render
