// A scene as edits that are being put together would make it: what they touch, over a scene that stays as it is.
#pragma once

#include <map>

#include "scene/edit.h"

namespace crescente::scene {

// Values by index, of which some were changed and some added at the end. The list that they began as must outlive it.
template <class Things>
class Overlay {
public:
    using value_type = typename Things::value_type;

    explicit Overlay(const Things& things) : things_(&things) {}

    std::size_t size() const { return things_->size() + added_.size(); }
    const value_type& operator[](std::size_t i) const {
        if (i >= things_->size()) return added_[i - things_->size()];
        const auto found = changed_.find(static_cast<std::uint32_t>(i));
        return found == changed_.end() ? (*things_)[i] : found->second;
    }
    // The value, to be changed.
    value_type& change(std::size_t i) {
        if (i >= things_->size()) return added_[i - things_->size()];
        return changed_.try_emplace(static_cast<std::uint32_t>(i), (*things_)[i]).first->second;
    }
    // Returns its index.
    std::uint32_t add(value_type value) {
        added_.push_back(std::move(value));
        return static_cast<std::uint32_t>(size() - 1);
    }

    const std::map<std::uint32_t, value_type>& changed() const { return changed_; }
    const std::vector<value_type>& added() const { return added_; }

private:
    const Things* things_;
    std::map<std::uint32_t, value_type> changed_;
    std::vector<value_type> added_;
};

// Edits are put together by changing its members; edits() then says what they come to.
struct Draft {
    explicit Draft(const Scene& scene);  // which must outlive it, as it is

    Overlay<std::deque<NamedShape>> shapes;
    Overlay<std::vector<Material>> materials;
    Overlay<std::vector<Node>> nodes;
    std::vector<NodeId> roots;
    std::vector<Light> lights;
    std::optional<Camera> camera;
    std::optional<Environment> environment;
    Settings settings;

    // What makes the scene that it began as what it is now, each thing once.
    std::vector<Edit> edits() const;

private:
    const Scene* scene_;
};

}  // namespace crescente::scene
