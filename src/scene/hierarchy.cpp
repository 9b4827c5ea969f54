#include "scene/hierarchy.h"

namespace crescente::scene {

std::vector<NodeId> path_to(const Scene& scene, std::uint64_t identity) {
    struct Open {  // a list of nodes on the way down: the hierarchy may be too deep for recursion
        const std::vector<NodeId>* nodes;
        std::size_t next;
        std::uint64_t above;  // identity of the node whose children they are
    };
    std::vector<Open> open{{&scene.roots, 0, 0}};
    std::vector<NodeId> path;
    while (!open.empty()) {
        Open& at = open.back();
        if (at.next == at.nodes->size()) {
            open.pop_back();
            if (!path.empty()) path.pop_back();
            continue;
        }
        const NodeId id = (*at.nodes)[at.next++];
        if (!scene.nodes[id.value].visible) continue;
        const std::uint64_t own = identity_below(at.above, id);
        path.push_back(id);
        if (own == identity) return path;
        open.push_back({&scene.nodes[id.value].children, 0, own});
    }
    return path;
}

}  // namespace crescente::scene
