#include "render/history.h"

namespace crescente::render {

Expected<EditReport> History::edit(Session& session, Edits edits, const std::string& file) {
    auto report = session.edit(std::move(edits), file);
    if (!report) return report;
    undo_.push_back(std::exchange(report->undo, {}));
    redo_.clear();
    return report;
}

Expected<EditReport> History::play_last(Session& session, std::vector<Edits>& from, std::vector<Edits>& to) {
    auto report = session.edit(from.back());
    if (!report) return report;
    from.pop_back();
    to.push_back(std::exchange(report->undo, {}));
    return report;
}

}  // namespace crescente::render
