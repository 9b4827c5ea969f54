#include "io/scene_names.h"

#include <set>

namespace crescente::io {

using scene::NodeId;

ObjectNames::ObjectNames(const scene::Draft& draft) : draft_(draft) {
    std::vector<bool> seen(draft.nodes.size(), false);
    std::vector<NodeId> open = draft.roots;
    while (!open.empty()) {
        const NodeId node = open.back();
        open.pop_back();
        if (node.value >= seen.size() || seen[node.value]) continue;
        seen[node.value] = true;
        const auto& children = draft.nodes[node.value].children;
        open.insert(open.end(), children.begin(), children.end());
    }
    for (std::uint32_t i = 0; i < seen.size(); ++i) {
        if (seen[i]) shown_.push_back(i);
    }
}

std::vector<ObjectPlace> ObjectNames::find_text(std::string_view text) const {
    std::vector<ObjectPlace> found;
    for (const std::uint32_t i : shown_) {
        if (key(i) == text) found.push_back({NodeId{i}, {}});
    }
    if (!found.empty() || text.find('/') == std::string_view::npos) return found;

    // A node and how much of the text led to it; shared nodes are come by on many ways.
    std::set<std::pair<std::uint32_t, std::size_t>> seen;
    std::set<std::pair<std::uint32_t, std::uint32_t>> places;
    std::vector<std::pair<std::uint32_t, std::size_t>> open;
    const auto enter = [&](std::uint32_t node, std::size_t from) {
        const std::string name = key(node);
        const std::size_t end = from + name.size();
        if (end < text.size() && text[end] == '/' && text.substr(from, name.size()) == name && seen.insert({node, end + 1}).second) open.push_back({node, end + 1});
    };
    for (const std::uint32_t i : shown_) enter(i, 0);
    while (!open.empty()) {
        const auto [node, from] = open.back();
        open.pop_back();
        for (const NodeId child : draft_.nodes[node].children) {
            if (key(child.value) == text.substr(from)) places.insert({child.value, node});
            else enter(child.value, from);
        }
    }
    for (const auto& [node, parent] : places) found.push_back({NodeId{node}, NodeId{parent}});
    return found;
}

// Of a path the last part that is not known is the one to mend.
std::string ObjectNames::hint(std::string_view text) const {
    constexpr std::size_t most_candidates = 10000;
    std::vector<std::string> names;
    const auto slash = text.rfind('/');
    if (slash != std::string_view::npos) {
        const std::string_view head = text.substr(0, slash);
        for (const ObjectPlace& at : find_text(head)) {
            for (const NodeId child : draft_.nodes[at.node.value].children) {
                if (names.size() < most_candidates) names.push_back(std::string(head) + "/" + key(child.value));
            }
        }
        if (!names.empty()) return spelling_hint(text, names);
    }
    for (const std::uint32_t i : shown_) {
        if (names.size() < most_candidates) names.push_back(key(i));
    }
    return spelling_hint(text, names);
}

std::vector<ObjectPlace> ObjectNames::find(const Json& reference, const Place& place, ProblemList& problems) const {
    if (const auto* index = reference.integer()) {
        if (*index >= 0 && std::binary_search(shown_.begin(), shown_.end(), static_cast<std::uint64_t>(*index))) {
            return {{NodeId{static_cast<std::uint32_t>(*index)}, {}}};
        }
        problems.add(reference, place, "there is no object " + std::to_string(*index) + " in the scene");
        return {};
    }
    if (!reference.text()) {
        problems.add(reference, place, "is " + std::string(reference.kind()) + ", must be an object's name, path or index");
        return {};
    }
    const std::string& text = *reference.text();
    auto found = find_text(text);
    constexpr std::size_t longest = 1000;  // the search for a spelling is not free
    if (found.empty()) {
        problems.add(reference, place, "there is no object '" + text.substr(0, 300) + "'", problems.full() || text.size() > longest ? std::string{} : hint(text));
    }
    return found;
}

std::optional<ObjectPlace> ObjectNames::find_one(const Json& reference, const Place& place, ProblemList& problems) const {
    const auto found = find(reference, place, problems);
    if (found.size() == 1) return found.front();
    if (!found.empty()) {
        std::string indices;
        constexpr std::size_t most_told = 5;
        for (std::size_t i = 0; i < std::min(found.size(), most_told); ++i) indices += (i ? ", " : "") + std::to_string(found[i].node.value);
        if (found.size() > most_told) indices += ", ...";
        problems.add(reference, place, "there are " + std::to_string(found.size()) + " such objects, one must be meant", "by index: " + indices);
    }
    return std::nullopt;
}

}  // namespace crescente::io
