#include "app/server/scene_json.h"

#include <functional>

#include "app/server/message.h"
#include "io/scene_parts.h"
#include "scene/studio.h"

namespace crescente::app {
namespace {

using geometry::Shape;
using math::Bounds;

ReplyJson vector_json(math::Vec3 v) { return {v.x, v.y, v.z}; }

// null where there is nothing, or nothing that ends.
ReplyJson bounds_json(const Bounds& box, double metres) {
    if (!box.bounded()) return nullptr;
    return {{"low", vector_json(box.lower / metres)}, {"high", vector_json(box.upper / metres)}};
}

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

void add_shape(const Shape& shape, ReplyJson& json) {
    json["shape"] = geometry::shape_names[shape.index()];
    if (const auto* mesh = std::get_if<geometry::Mesh>(&shape)) json["triangles"] = mesh->triangles.size();
    if (const auto* part = std::get_if<geometry::Brep>(&shape)) json["faces"] = part->face_count();
}

ReplyJson indices(const std::vector<scene::NodeId>& nodes) {
    ReplyJson list = ReplyJson::array();
    for (const scene::NodeId node : nodes) list.push_back(node.value);
    return list;
}

// Those that the scene shows or hides, in the order of their index.
ReplyJson objects_json(const scene::Scene& scene) {
    std::vector<bool> reached(scene.nodes.size(), false);
    std::vector<scene::NodeId> open = scene.roots;
    while (!open.empty()) {
        const scene::NodeId node = open.back();
        open.pop_back();
        if (reached[node.value]) continue;
        reached[node.value] = true;
        open.insert(open.end(), scene.nodes[node.value].children.begin(), scene.nodes[node.value].children.end());
    }
    const double metres = scene.unit.metres;
    NodeBounds bounds(scene);
    ReplyJson list = ReplyJson::array();
    for (std::uint32_t i = 0; i < scene.nodes.size(); ++i) {
        if (!reached[i]) continue;
        const scene::Node& node = scene.nodes[i];
        const math::Affine& t = node.transform;
        ReplyJson json{{"index", i}, {"name", node.name}, {"visible", node.visible}, {"shape", nullptr}, {"material", nullptr}};
        if (node.shape.valid()) add_shape(scene.shapes[node.shape.value].shape, json);
        if (!node.materials.empty()) json["material"] = node.materials[0].valid() ? ReplyJson(node.materials[0].value) : ReplyJson(nullptr);
        if (node.materials.size() > 1) {
            json["materials"] = ReplyJson::array();
            for (const scene::MaterialId id : node.materials) json["materials"].push_back(id.valid() ? ReplyJson(id.value) : ReplyJson(nullptr));
        }
        json["transform"] = {t.x.x, t.y.x, t.z.x, t.origin.x / metres, t.x.y, t.y.y, t.z.y, t.origin.y / metres, t.x.z, t.y.z, t.z.z, t.origin.z / metres};
        json["bounds"] = bounds_json(bounds.of(i), metres);
        json["children"] = indices(node.children);
        list.push_back(std::move(json));
    }
    return list;
}

template <class Owner>
ReplyJson fields_json(const Owner& owner, const io::Measure& measure) {
    ReplyJson json = ReplyJson::object();
    io::write_fields(owner, Owner::fields(), measure, json);
    return json;
}

}  // namespace

SceneParts& SceneParts::operator|=(const SceneParts& other) {
    objects |= other.objects, materials |= other.materials, lights |= other.lights;
    camera |= other.camera, environment |= other.environment, settings |= other.settings;
    return *this;
}

SceneParts parts_of(std::span<const scene::Edit> edits) {
    SceneParts parts;
    for (const scene::Edit& edit : edits) {
        const auto is = [&]<class... Kinds>() { return (std::holds_alternative<Kinds>(edit) || ...); };
        parts.materials |= is.operator()<scene::SetMaterial, scene::AddMaterial>();
        parts.lights |= is.operator()<scene::SetLight, scene::InsertLight, scene::RemoveLight>();
        parts.objects |= is.operator()<scene::SetShape, scene::AddShape, scene::SetNode, scene::AddNode, scene::SetRoots>();
        parts.camera |= is.operator()<scene::SetCamera>();
        parts.environment |= is.operator()<scene::SetEnvironment>();
        parts.settings |= is.operator()<scene::SetSettings>();
    }
    return parts;
}

ReplyJson scene_json(const scene::Scene& scene, const SceneParts& parts) {
    const io::Measure measure{scene.unit.metres, scene.unit.name};
    ReplyJson json{{"name", scene.name}, {"unit", scene.unit.name}, {"metres", scene.unit.metres}};
    if (parts.objects) {
        json["bounds"] = bounds_json(bounds_without_ground(scene), measure.metres);
        json["ground"] = ground_names()[static_cast<std::size_t>(scene::ground_of(scene))];
        json["objects"] = objects_json(scene);
        json["roots"] = indices(scene.roots);
    }
    if (parts.materials) {
        json["materials"] = ReplyJson::array();
        for (const scene::Material& material : scene.materials) {
            ReplyJson one{{"name", material.name}};
            io::write_material(material, measure, one);
            json["materials"].push_back(std::move(one));
        }
    }
    if (parts.lights) {
        const auto studio = scene::studio_of(scene);
        json["studio"] = studio ? ReplyJson(scene::studio_names[static_cast<std::size_t>(*studio)]) : ReplyJson(nullptr);
        json["lights"] = ReplyJson::array();
        for (const scene::Light& light : scene.lights) {
            ReplyJson one{{"name", light.name}};
            io::write_fields(light, scene::Light::fields(), measure, one);
            json["lights"].push_back(std::move(one));
        }
    }
    if (parts.camera) json["camera"] = scene.camera ? fields_json(*scene.camera, measure) : ReplyJson(nullptr);
    if (parts.environment) json["environment"] = scene.environment ? fields_json(*scene.environment, measure) : ReplyJson(nullptr);
    if (parts.settings) json["settings"] = fields_json(scene.settings, measure);
    return json;
}

}  // namespace crescente::app
