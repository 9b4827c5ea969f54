// What a page knows of the objects of a scene, and what it has to be told.
#pragma once

#include <vector>

#include "app/server/replies.h"
#include "math/bounds.h"
#include "scene/scene.h"

namespace crescente::app {

// null where there is nothing, or nothing that ends; corners in units of so many metres.
ReplyJson bounds_json(const math::Bounds& box, double metres);

class ToldObjects {
public:
    // The page knows nothing.
    void forget();

    // Adds to the message `scene` what the page does not know yet: all objects and roots (`objects`, `roots`) if it knows nothing, else the objects that are other than they were, each with its index and the
    // members that differ (`changed`), those that are gone (`gone`), and the roots if there are others. From then on the page knows.
    void tell(const scene::Scene& scene, ReplyJson& json);

private:
    struct Told {
        bool there = false;
        scene::Node node;
        std::size_t shape_kind = 0, pieces = 0;  // of its shape
        math::Bounds bounds;                     // in its own space
    };
    static Told look_at(const scene::Scene& scene, std::uint32_t index, const math::Bounds& bounds);
    static ReplyJson differences(const scene::Scene& scene, std::uint32_t index, const Told& before, const Told& now);

    bool knows_ = false;
    std::vector<Told> told_;  // by index
    std::vector<scene::NodeId> roots_;
};

}  // namespace crescente::app
