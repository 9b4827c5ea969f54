#include "io/object_reader.h"

#include "io/scene_parts.h"
#include "io/scene_words.h"

namespace crescente::io {
namespace {

using scene::NodeId;

// Objects within objects: what the reader's recursion is allowed.
constexpr int deepest_objects = 300;

}  // namespace

std::string read_name(const Json& json, const Place& place, const std::string& key, ProblemList& problems) {
    const Json* name = json.find(name_word().name);
    if (!name) return key;
    if (name->text()) return *name->text();
    problems.add(*name, place / name_word().name, "is " + std::string(name->kind()) + ", must be a text");
    return key;
}

std::vector<NodeId> ObjectReader::read_all(const Json& json, const Place& place) {
    std::vector<NodeId> nodes;
    for_each_entry(json, place, problems_, [&](const Json& value, const Place& here, const std::string& key) {
        if (const NodeId node = read(value, here, key); node.valid()) nodes.push_back(node);
    });
    return nodes;
}

NodeId ObjectReader::read(const Json& json, const Place& place, const std::string& key) {
    // Nothing but a reference: the group itself, shared, not a new node around it.
    const Json* instance = json.find("instance");
    if (instance && json.object()->size() == 1 && key.empty()) {
        return home_.instance(*instance, place / "instance", problems_).value_or(NodeId{});
    }
    const NodeId node = home_.add_node();
    read_into(node, json, place, key);
    return node;
}

void ObjectReader::read_into(NodeId node, const Json& json, const Place& place, const std::string& key, std::span<const std::string> also) {
    if (!json.object()) return must_be(json, place, "an object");
    if (depth_ >= deepest_objects) {
        return problems_.add(json, Place{}, "objects are nested deeper than " + std::to_string(deepest_objects), "use groups and instances");
    }
    ++depth_;
    auto known = names_of(object_words());
    known.insert(known.end(), also.begin(), also.end());
    scene::Node read;
    read.name = read_name(json, place, key, problems_);
    for (const auto& member : *json.object()) {
        const Place here = place / member.key;
        if (member.key == "transform") read.transform = read_transform(member.value, measure_, here, problems_);
        else if (member.key == "motion") read.motion = read_transform(member.value, measure_, here, problems_);
        else if (member.key == "shape") read.shape = read_object_shape(member.value, here, read.name);
        else if (member.key == "material") {
            if (const auto material = home_.material(member.value, here, problems_)) read.materials.push_back(*material);
        } else if (member.key == "materials") read.materials = read_materials(member.value, here);
        else if (member.key == "visible") {
            if (member.value.boolean()) read.visible = *member.value.boolean();
            else must_be(member.value, here, "true or false");
        } else if (std::find(known.begin(), known.end(), member.key) == known.end()) unknown_member(member, place, known, problems_);
    }
    if (json.find("material") && json.find("materials")) problems_.add(json, place, "has both material and materials");
    if (const Json* instance = json.find("instance")) {
        if (const auto group = home_.instance(*instance, place / "instance", problems_)) read.children.push_back(*group);
    }
    if (const Json* file = json.find("file")) {
        for (const NodeId root : home_.file(*file, !read.materials.empty(), place / "file", problems_)) read.children.push_back(root);
    }
    if (const Json* children = json.find("children")) {
        for (const NodeId child : read_all(*children, place / "children")) read.children.push_back(child);
    }
    home_.set(node, std::move(read));
    --depth_;
}

scene::ShapeId ObjectReader::read_object_shape(const Json& json, const Place& place, const std::string& name) {
    if (!json.object()) return home_.shape(json, place, problems_).value_or(scene::ShapeId{});
    auto shape = read_shape(json, measure_, place, problems_);
    if (!shape) return {};
    return home_.add({read_name(json, place, name, problems_), std::move(*shape)});
}

std::vector<scene::MaterialId> ObjectReader::read_materials(const Json& json, const Place& place) {
    std::vector<scene::MaterialId> materials;
    if (!json.array()) return must_be(json, place, "a list of names of materials"), materials;
    std::size_t index = 0;
    for (const Json& name : *json.array()) {
        if (const auto material = home_.material(name, place / index++, problems_)) materials.push_back(*material);
    }
    return materials;
}

}  // namespace crescente::io
