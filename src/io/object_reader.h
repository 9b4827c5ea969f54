// Objects as scene files and edits write them: shape, materials, transform, children.
#pragma once

#include "io/json_fields.h"
#include "scene/scene.h"

namespace crescente::io {

// What a text's objects refer to, and where they and what they bring go.
class ObjectHome {
public:
    virtual ~ObjectHome() = default;

    // What a reference means; nothing and a problem where it means nothing.
    virtual std::optional<scene::ShapeId> shape(const Json& reference, const Place& place, ProblemList& problems) = 0;
    virtual std::optional<scene::MaterialId> material(const Json& reference, const Place& place, ProblemList& problems) = 0;
    virtual std::optional<scene::NodeId> instance(const Json& reference, const Place& place, ProblemList& problems) = 0;
    // The top nodes of a file; `bare`: without materials of their own.
    virtual std::vector<scene::NodeId> file(const Json& reference, bool bare, const Place& place, ProblemList& problems) = 0;

    virtual scene::ShapeId add(scene::NamedShape shape) = 0;
    virtual scene::NodeId add_node() = 0;
    virtual void set(scene::NodeId node, scene::Node value) = 0;
};

// The name that the object says, or else its key.
std::string read_name(const Json& json, const Place& place, const std::string& key, ProblemList& problems);

// Calls visit(value, place, key) for each entry of an object by name or of a list; the key of a list's entry is empty.
template <class Visit>
void for_each_entry(const Json& json, const Place& place, ProblemList& problems, Visit&& visit) {
    if (json.object()) {
        for (const auto& member : *json.object()) visit(member.value, place / member.key, member.key);
    } else if (json.array()) {
        std::size_t index = 0;
        for (const Json& element : *json.array()) visit(element, place / index++, std::string{});
    } else {
        problems.add(json, place, "is " + std::string(json.kind()) + ", must be an object by name, or a list");
    }
}

class ObjectReader {
public:
    // `depth` counts objects within objects, over all files that are open.
    ObjectReader(ObjectHome& home, const Measure& measure, ProblemList& problems, int& depth) : home_(home), measure_(measure), problems_(problems), depth_(depth) {}

    // The nodes of objects by name, or of a list.
    std::vector<scene::NodeId> read_all(const Json& json, const Place& place);

    // An object as a new node. Nothing but a reference to a group: the group itself.
    scene::NodeId read(const Json& json, const Place& place, const std::string& key);

    // An object into a node that is there. `also`: members that the caller reads itself.
    void read_into(scene::NodeId node, const Json& json, const Place& place, const std::string& key, std::span<const std::string> also = {});

    // A list of references to materials.
    std::vector<scene::MaterialId> read_materials(const Json& json, const Place& place);

private:
    void must_be(const Json& json, const Place& place, const std::string& wanted) {
        problems_.add(json, place, "is " + std::string(json.kind()) + ", must be " + wanted);
    }
    scene::ShapeId read_object_shape(const Json& json, const Place& place, const std::string& name);

    ObjectHome& home_;
    const Measure& measure_;
    ProblemList& problems_;
    int& depth_;
};

}  // namespace crescente::io
