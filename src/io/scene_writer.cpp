// Writing the native scene format (io/scene_file.h).
#include <deque>
#include <unordered_map>
#include <unordered_set>

#include "base/atomic_file.h"
#include "io/json_fields.h"
#include "io/json_print.h"
#include "io/scene_file.h"
#include "io/scene_parts.h"
#include "io/scene_words.h"
#include "io/spline_parts.h"

namespace crescente::io {
namespace {

using nlohmann::ordered_json;
using scene::Node;
using scene::NodeId;
using scene::Scene;

// Objects nested deeper than this are written as groups and referred to, for the sake of readers (and people).
constexpr int deepest_nesting = 60;

std::string valid_text(const std::string& text) { return nlohmann::json::parse(quoted(text)).get<std::string>(); }

// Keys of an object: a name as it is where it is free, else with a number.
class Keys {
public:
    explicit Keys(std::string nameless) : nameless_(std::move(nameless)) {}

    std::string key_for(const std::string& name) {
        const std::string base = name.empty() ? nameless_ : valid_text(name);
        if (!name.empty() && used_.insert(base).second) return base;
        for (std::size_t& number = last_number_[base];;) {
            std::string key = base + " " + std::to_string(++number);
            if (used_.insert(key).second) return key;
        }
    }

private:
    std::string nameless_;
    std::unordered_set<std::string> used_;
    std::unordered_map<std::string, std::size_t> last_number_;
};

class Writer {
public:
    Writer(const Scene& scene, const ShapeSources& sources) : scene_(scene), sources_(sources), measure_(measure_of(scene)) {}

    std::string write() {
        out_ = "{";
        if (!scene_.name.empty()) member("name", scene_.name);
        member("unit", measure_.name);
        ordered_json settings = ordered_json::object();
        write_fields(scene_.settings, scene::Settings::fields(), measure_, settings);
        if (!settings.empty()) member("settings", settings);
        if (scene_.camera) member("camera", fields_of(*scene_.camera));
        if (scene_.environment) member("environment", fields_of(*scene_.environment));
        write_lights();
        write_materials();
        write_shapes();
        write_objects();
        return out_ + "\n}\n";
    }

private:
    // --- the frame: members of the document, and of its objects by name

    void begin_member(const std::string& key) {
        out_ += out_.back() == '{' ? "\n  " : ",\n  ";
        out_ += quoted(key) + ": ";
    }
    void member(const std::string& key, const ordered_json& value) {
        begin_member(key);
        print_json(value, out_, 2);
    }
    void begin_entry(std::string& out, bool& first, const std::string& key) {
        out += first ? "\n    " : ",\n    ";
        first = false;
        if (!key.empty()) out += quoted(key) + ": ";
    }

    // --- things by name

    template <class Owner>
    ordered_json fields_of(const Owner& owner) {
        ordered_json json = ordered_json::object();
        write_fields(owner, Owner::fields(), measure_, json);
        return json;
    }

    static ordered_json named(const std::string& name, const std::string& key) {
        ordered_json json = ordered_json::object();
        if (valid_text(name) != key) json[name_word().name] = name;
        return json;
    }

    void write_lights() {
        if (scene_.lights.empty()) return;
        begin_member("lights");
        out_ += '{';
        Keys keys{"light"};
        bool first = true;
        for (const auto& light : scene_.lights) {
            const std::string key = keys.key_for(light.name);
            ordered_json json = named(light.name, key);
            write_fields(light, scene::Light::fields(), measure_, json);
            begin_entry(out_, first, key);
            print_json(json, out_, 4);
        }
        out_ += "\n  }";
    }

    void write_materials() {
        if (scene_.materials.empty()) return;
        begin_member("materials");
        out_ += '{';
        Keys keys{"material"};
        bool first = true;
        for (const auto& material : scene_.materials) {
            material_keys_.push_back(keys.key_for(material.name));
            ordered_json json = named(material.name, material_keys_.back());
            write_material(material, measure_, json);
            begin_entry(out_, first, material_keys_.back());
            print_json(json, out_, 4);
        }
        out_ += "\n  }";
    }

    void write_shapes() {
        if (scene_.shapes.empty()) return;
        begin_member("shapes");
        out_ += '{';
        Keys keys{"shape"};
        bool first = true;
        for (std::uint32_t i = 0; i < scene_.shapes.size(); ++i) {
            const scene::NamedShape& shape = scene_.shapes[i];
            shape_keys_.push_back(keys.key_for(shape.name));
            ordered_json json = named(shape.name, shape_keys_.back());
            const std::string kind{geometry::shape_names[shape.shape.index()]};
            json[kind] = std::visit([&](const auto& s) {
                ordered_json parameters = fields_of(s);
                write_arrays(s, parameters);
                return parameters;
            }, shape.shape);
            if (std::holds_alternative<geometry::Brep>(shape.shape)) {
                const ShapeSource& source = sources_.at(i);
                json[kind] = {{"file", valid_text(source.file.string())}, {"index", source.index}};
            }
            begin_entry(out_, first, shape_keys_.back());
            print_json(json, out_, 4);
        }
        out_ += "\n  }";
    }

    double length(double metres) const { return length_in(metres, measure_.metres); }
    ordered_json point(math::Vec3 p) const { return ordered_json::array({length(p.x), length(p.y), length(p.z)}); }

    template <class Kind>
    void write_arrays(const Kind& shape, ordered_json& json) {
        if constexpr (has_spline_arrays<Kind>) write_spline_arrays(shape, measure_, json);
    }
    void write_arrays(const geometry::Polygon& polygon, ordered_json& json) {
        ordered_json loops = ordered_json::array();
        for (const auto& loop : polygon.loops) {
            ordered_json points = ordered_json::array();
            for (const auto& p : loop) points.push_back(point(p));
            loops.push_back(std::move(points));
        }
        json["loops"] = std::move(loops);
    }
    void write_arrays(const geometry::Mesh& mesh, ordered_json& json) {
        ordered_json positions = ordered_json::array(), triangles = ordered_json::array(), normals = ordered_json::array();
        for (const auto& p : mesh.positions) {
            for (int axis = 0; axis < 3; ++axis) positions.push_back(length(p[axis]));
        }
        for (const auto& triangle : mesh.triangles) {
            for (const auto vertex : triangle) triangles.push_back(vertex);
        }
        for (const auto& normal : mesh.normals) {
            for (const float component : normal) normals.push_back(short_double(component));
        }
        json["positions"] = std::move(positions);
        json["triangles"] = std::move(triangles);
        if (!mesh.normals.empty()) json["normals"] = std::move(normals);
        if (!mesh.slots.empty()) json["slots"] = mesh.slots;
        write_attributes("coordinates", mesh.coordinates[0], json);
        write_attributes("coordinates_2", mesh.coordinates[1], json);
        write_attributes("colors", mesh.colors, json);
        write_attributes("tangents", mesh.tangents, json);
    }
    template <std::size_t n>
    static void write_attributes(const char* key, const std::vector<std::array<float, n>>& attributes, ordered_json& json) {
        if (attributes.empty()) return;
        ordered_json numbers = ordered_json::array();
        for (const auto& one : attributes) {
            for (const float component : one) numbers.push_back(short_double(component));
        }
        json[key] = std::move(numbers);
    }

    // --- the hierarchy

    void write_objects() {
        std::vector<std::uint32_t> mentions(scene_.nodes.size(), 0);
        for (const auto& node : scene_.nodes) {
            for (const NodeId child : node.children) ++mentions.at(child.value);
        }
        for (const NodeId root : scene_.roots) ++mentions.at(root.value);
        for (std::uint32_t i = 0; i < mentions.size(); ++i) {
            if (mentions[i] != 1) group_of(NodeId{i});
        }
        std::string objects = "[";
        bool first = true;
        for (const NodeId root : scene_.roots) {
            begin_entry(objects, first, "");
            print_json(reference_or_object(root, 0), objects, 4);
        }
        objects += "\n  ]";
        std::string groups = "{";  // grows while it is written: deep groups begin others
        for (bool first_group = true; !unwritten_.empty();) {
            const NodeId node = unwritten_.front();
            unwritten_.pop_front();
            begin_entry(groups, first_group, group_keys_.at(node.value));
            print_json(object_of(node, named(scene_.nodes[node.value].name, group_keys_.at(node.value)), 0), groups, 4);
        }
        groups += "\n  }";
        if (!group_keys_.empty()) begin_member("groups"), out_ += groups;
        if (!scene_.roots.empty()) begin_member("objects"), out_ += objects;
    }

    const std::string& group_of(NodeId node) {
        const auto [found, is_new] = group_keys_.try_emplace(node.value);
        if (is_new) {
            found->second = group_names_.key_for(scene_.nodes[node.value].name);
            unwritten_.push_back(node);
        }
        return found->second;
    }

    ordered_json reference_or_object(NodeId id, int depth) {
        if (const auto group = group_keys_.find(id.value); group != group_keys_.end()) return {{"instance", group->second}};
        if (depth >= deepest_nesting) return {{"instance", group_of(id)}};
        ordered_json json = ordered_json::object();
        if (const std::string& name = scene_.nodes[id.value].name; !name.empty()) json["name"] = name;
        return object_of(id, std::move(json), depth);
    }

    ordered_json object_of(NodeId id, ordered_json json, int depth) {
        const Node& node = scene_.nodes[id.value];
        if (node.shape.valid()) json["shape"] = shape_keys_.at(node.shape.value);
        if (node.materials.size() == 1) json["material"] = material_keys_.at(node.materials[0].value);
        if (node.materials.size() > 1) {
            json["materials"] = ordered_json::array();
            for (const auto material : node.materials) json["materials"].push_back(material_keys_.at(material.value));
        }
        if (node.transform != math::Affine{}) json["transform"] = transform_of(node.transform);
        if (node.motion) json["motion"] = transform_of(*node.motion);
        if (!node.visible) json["visible"] = false;
        if (!node.children.empty()) {
            ordered_json children = ordered_json::array();
            for (const NodeId child : node.children) children.push_back(reference_or_object(child, depth + 1));
            json["children"] = std::move(children);
        }
        return json;
    }

    ordered_json transform_of(const math::Affine& a) const {
        math::Affine moved;
        moved.origin = a.origin;
        if (a == moved) return {{"translate", point(a.origin)}};
        return {{"matrix", {a.x.x, a.y.x, a.z.x, length(a.origin.x), a.x.y, a.y.y, a.z.y, length(a.origin.y), a.x.z, a.y.z, a.z.z,
                            length(a.origin.z)}}};
    }

    const Scene& scene_;
    const ShapeSources& sources_;
    Measure measure_;
    std::string out_;
    std::vector<std::string> material_keys_, shape_keys_;
    Keys group_names_{"group"};
    std::unordered_map<std::uint32_t, std::string> group_keys_;
    std::deque<NodeId> unwritten_;
};

}  // namespace

Expected<void> write_scene_file(const std::filesystem::path& file, const Scene& scene, ShapeSources sources) {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::weakly_canonical(std::filesystem::absolute(file, error).parent_path(), error);
    for (auto& [shape, source] : sources) {
        const std::filesystem::path from_there = source.file.lexically_relative(folder);
        if (!error && !from_there.empty() && *from_there.begin() != "..") source.file = from_there;
    }
    return write_atomically(file, write_scene_text(scene, sources));
}

std::string write_scene_text(const Scene& scene, const ShapeSources& sources) { return Writer{scene, sources}.write(); }

}  // namespace crescente::io
