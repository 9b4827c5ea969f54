// Things of a scene by the names that users give them.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "base/spelling.h"
#include "io/json_text.h"
#include "scene/draft.h"

namespace crescente::io {

// What a thing goes by: its name, or its index where it has none.
inline std::string name_of(const std::string& name, std::size_t index) { return name.empty() ? std::to_string(index) : name; }

// The indices of all things that go by the name.
template <class Things>
std::vector<std::uint32_t> find_named(const Things& things, std::string_view name) {
    std::vector<std::uint32_t> found;
    for (std::size_t i = 0; i < things.size(); ++i) {
        const std::string& own = things[i].name;
        if (own.empty() ? std::to_string(i) == name : own == name) found.push_back(static_cast<std::uint32_t>(i));
    }
    return found;
}

// The hint for a name that no thing goes by. Not all of very many are looked at.
template <class Things>
std::string nearest_named(const Things& things, std::string_view name) {
    constexpr std::size_t most_candidates = 10000;
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(things.size(), most_candidates); ++i) names.push_back(name_of(things[i].name, i));
    return spelling_hint(name, names);
}

// A node, and below which other one it is meant: none where a name says nothing of that.
struct ObjectPlace {
    scene::NodeId node, parent;
};

// The objects that the scene shows or hides, by name; those that were removed, and groups that nothing shows, are not among them.
class ObjectNames {
public:
    explicit ObjectNames(const scene::Draft& draft);

    // All that the reference means: those of a name; failing that, by a path of names ("car/wheel"), each a child of the one before, the first anywhere; or
    // the one of an index. An object without a name goes by its index. Names may have slashes. None and a problem where it means nothing.
    std::vector<ObjectPlace> find(const Json& reference, const Place& place, ProblemList& problems) const;

    // The same where one is wanted: a problem if there are more.
    std::optional<ObjectPlace> find_one(const Json& reference, const Place& place, ProblemList& problems) const;

private:
    std::vector<ObjectPlace> find_text(std::string_view text) const;
    std::string hint(std::string_view text) const;
    std::string key(std::uint32_t node) const { return name_of(draft_.nodes[node].name, node); }

    const scene::Draft& draft_;
    std::vector<std::uint32_t> shown_;  // in the order of their indices
};

}  // namespace crescente::io
