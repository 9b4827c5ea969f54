#include "render/history.h"

#include <algorithm>

namespace crescente::render {
namespace {

// Whether `later` gives a value to the very thing that `earlier` does, so that without `earlier` all would be the same.
bool covers(const scene::Edit& later, const scene::Edit& earlier) {
    if (later.index() != earlier.index()) return false;
    return std::visit([&]<class Kind>(const Kind& kind) {
        const Kind& other = std::get<Kind>(earlier);
        if constexpr (std::is_same_v<Kind, scene::SetMaterial>) return kind.material == other.material;
        else if constexpr (std::is_same_v<Kind, scene::SetLight>) return kind.light == other.light;
        else if constexpr (std::is_same_v<Kind, scene::SetShape>) return kind.shape == other.shape;
        else if constexpr (std::is_same_v<Kind, scene::SetNode>) return kind.node == other.node;
        else return std::is_same_v<Kind, scene::SetRoots> || std::is_same_v<Kind, scene::SetCamera> || std::is_same_v<Kind, scene::SetEnvironment> || std::is_same_v<Kind, scene::SetSettings>;
    }, later);
}

bool moves_lights(const scene::Edit& edit) { return std::holds_alternative<scene::InsertLight>(edit) || std::holds_alternative<scene::RemoveLight>(edit); }

// What takes back an edit, and then those before it. A long gesture that sets one thing again and again needs what undoes its first step only.
std::vector<scene::Edit> joined(std::vector<scene::Edit> undo, std::vector<scene::Edit> before) {
    if (std::none_of(before.begin(), before.end(), moves_lights) && std::none_of(undo.begin(), undo.end(), moves_lights)) {
        std::erase_if(undo, [&](const scene::Edit& edit) { return std::any_of(before.begin(), before.end(), [&](const scene::Edit& later) { return covers(later, edit); }); });
    }
    std::move(before.begin(), before.end(), std::back_inserter(undo));
    return undo;
}

}  // namespace

Expected<EditReport> History::edit(Session& session, Edits edits, const std::string& file, const std::string& gesture) {
    auto report = session.edit(std::move(edits), file);
    if (!report) return report;
    Edits undo = std::exchange(report->undo, {});
    if (!gesture.empty() && gesture == gesture_ && !undo_.empty()) undo_.back() = joined(std::move(undo), std::move(undo_.back()));
    else undo_.push_back(std::move(undo));
    if (undo_.size() > most_) undo_.erase(undo_.begin());
    gesture_ = gesture;
    redo_.clear();
    return report;
}

Expected<EditReport> History::play_last(Session& session, std::vector<Edits>& from, std::vector<Edits>& to) {
    auto report = session.edit(from.back());
    if (!report) return report;
    gesture_.clear();
    from.pop_back();
    to.push_back(std::exchange(report->undo, {}));
    return report;
}

}  // namespace crescente::render
