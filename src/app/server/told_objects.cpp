#include "app/server/told_objects.h"

#include <utility>

namespace crescente::app {
namespace {

using geometry::Shape;
using math::Bounds;

ReplyJson vector_json(math::Vec3 v) { return {v.x, v.y, v.z}; }

bool same(const Bounds& a, const Bounds& b) { return a.lower == b.lower && a.upper == b.upper; }

// Boxes of nodes in their own space, of their shapes and of what is visible below.
class NodeBounds {
public:
    explicit NodeBounds(const scene::Scene& scene) : scene_(scene), boxes_(scene.nodes.size()), known_(scene.nodes.size(), false) {}

    // Every node once, children before parents; without recursion, since hierarchies may be deep.
    const Bounds& of(std::uint32_t top) {
        std::vector<std::pair<std::uint32_t, std::size_t>> open{{top, 0}};
        while (!open.empty()) {
            auto& [index, next] = open.back();
            const scene::Node& node = scene_.nodes[index];
            if (known_[index]) {
                open.pop_back();
            } else if (next < node.children.size()) {
                const std::uint32_t child = node.children[next++].value;
                if (!known_[child]) open.emplace_back(child, 0);
            } else {
                finish(index);
                open.pop_back();
            }
        }
        return boxes_[top];
    }

private:
    void finish(std::uint32_t index) {
        const scene::Node& node = scene_.nodes[index];
        Bounds& box = boxes_[index];
        if (node.shape.valid()) {
            const Bounds own = geometry::bounds(scene_.shapes[node.shape.value].shape);
            if (own.bounded()) box.include(own);
        }
        for (const scene::NodeId child : node.children) {
            const Bounds& inner = boxes_[child.value];
            if (scene_.nodes[child.value].visible && inner.bounded()) box.include(math::transform(scene_.nodes[child.value].transform, inner));
        }
        known_[index] = true;
    }

    const scene::Scene& scene_;
    std::vector<Bounds> boxes_;
    std::vector<bool> known_;
};

// Triangles of a mesh, faces of a CAD part.
std::size_t pieces_of(const Shape& shape) {
    if (const auto* mesh = std::get_if<geometry::Mesh>(&shape)) return mesh->triangles.size();
    if (const auto* part = std::get_if<geometry::Brep>(&shape)) return part->face_count();
    return 0;
}

ReplyJson indices(const std::vector<scene::NodeId>& nodes) {
    ReplyJson list = ReplyJson::array();
    for (const scene::NodeId node : nodes) list.push_back(node.value);
    return list;
}

// Objects that the scene shows or hides, by index.
std::vector<bool> reached_of(const scene::Scene& scene) {
    std::vector<bool> reached(scene.nodes.size(), false);
    std::vector<scene::NodeId> open = scene.roots;
    while (!open.empty()) {
        const scene::NodeId node = open.back();
        open.pop_back();
        if (reached[node.value]) continue;
        reached[node.value] = true;
        open.insert(open.end(), scene.nodes[node.value].children.begin(), scene.nodes[node.value].children.end());
    }
    return reached;
}

}  // namespace

ReplyJson bounds_json(const Bounds& box, double metres) {
    if (!box.bounded()) return nullptr;
    return {{"low", vector_json(box.lower / metres)}, {"high", vector_json(box.upper / metres)}};
}

ToldObjects::Told ToldObjects::look_at(const scene::Scene& scene, std::uint32_t index, const Bounds& bounds) {
    Told told{true, scene.nodes[index], 0, 0, bounds};
    if (told.node.shape.valid()) {
        const Shape& shape = scene.shapes[told.node.shape.value].shape;
        told.shape_kind = shape.index() + 1;
        told.pieces = pieces_of(shape);
    }
    return told;
}

// All members if the object was not there.
ReplyJson ToldObjects::differences(const scene::Scene& scene, std::uint32_t index, const Told& before, const Told& now) {
    const double metres = scene.unit.metres;
    const auto material_json = [](scene::MaterialId id) { return id.valid() ? ReplyJson(id.value) : ReplyJson(nullptr); };
    const bool anew = !before.there;
    const scene::Node &was = before.node, &is = now.node;
    ReplyJson json = ReplyJson::object();
    if (anew || was.name != is.name) json["name"] = is.name;
    if (anew || was.visible != is.visible) json["visible"] = is.visible;
    if (anew || before.shape_kind != now.shape_kind || before.pieces != now.pieces) {
        json["shape"] = nullptr;
        if (is.shape.valid()) {
            const Shape& shape = scene.shapes[is.shape.value].shape;
            json["shape"] = geometry::shape_names[shape.index()];
            if (std::holds_alternative<geometry::Mesh>(shape)) json["triangles"] = now.pieces;
            if (std::holds_alternative<geometry::Brep>(shape)) json["faces"] = now.pieces;
        }
    }
    if (anew || was.materials != is.materials) {
        json["material"] = is.materials.empty() ? ReplyJson(nullptr) : material_json(is.materials[0]);
        if (is.materials.size() > 1 || was.materials.size() > 1) {
            json["materials"] = ReplyJson::array();
            for (const scene::MaterialId id : is.materials) json["materials"].push_back(material_json(id));
        }
    }
    if (anew || !(was.transform == is.transform)) {
        const math::Affine& t = is.transform;
        json["transform"] = {t.x.x, t.y.x, t.z.x, t.origin.x / metres, t.x.y, t.y.y, t.z.y, t.origin.y / metres, t.x.z, t.y.z, t.z.z, t.origin.z / metres};
    }
    if (anew || !same(before.bounds, now.bounds)) json["bounds"] = bounds_json(now.bounds, metres);
    if (anew || was.children != is.children) json["children"] = indices(is.children);
    if (json.empty()) return json;
    ReplyJson whole{{"index", index}};
    whole.update(json);
    return whole;
}

void ToldObjects::forget() {
    knows_ = false;
    told_.clear();
    roots_.clear();
}

void ToldObjects::tell(const scene::Scene& scene, ReplyJson& json) {
    const std::vector<bool> reached = reached_of(scene);
    NodeBounds bounds(scene);
    ReplyJson changed = ReplyJson::array(), gone = ReplyJson::array();
    told_.resize(scene.nodes.size());
    for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
        if (!reached[i]) {
            if (std::exchange(told_[i], {}).there) gone.push_back(i);
            continue;
        }
        Told now = look_at(scene, i, bounds.of(i));
        if (ReplyJson one = differences(scene, i, told_[i], now); !one.empty()) changed.push_back(std::move(one));
        told_[i] = std::move(now);
    }
    json[knows_ ? "changed" : "objects"] = std::move(changed);
    if (knows_) json["gone"] = std::move(gone);
    if (!knows_ || roots_ != scene.roots) json["roots"] = indices(scene.roots);
    roots_ = scene.roots;
    knows_ = true;
}

}  // namespace crescente::app
