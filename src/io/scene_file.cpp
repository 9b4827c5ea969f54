#include "io/scene_file.h"

#include <cctype>
#include <deque>
#include <limits>
#include <map>
#include <unordered_map>

#include "base/spelling.h"
#include "io/ies_file.h"
#include "io/json_fields.h"
#include "io/object_reader.h"
#include "io/panorama_file.h"
#include "io/scene_parts.h"
#include "io/scene_words.h"
#include "io/texture_parts.h"
#include "io/text_file.h"

namespace crescente::io {
namespace {

namespace fs = std::filesystem;
using math::Affine;
using math::Vec3;
using scene::NodeId;
using scene::Scene;

using Roots = std::vector<NodeId>;

// What the files of one scene share while they are read.
struct Loading {
    ReadOptions options;
    Loaded loaded;
    Problems problems;
    std::map<fs::path, std::optional<Roots>> files;         // nothing: being read
    std::map<fs::path, std::deque<scene::NamedShape>> shapes_of;  // of model files whose shapes are named one by one
    std::vector<fs::path> chain;                            // the files being read, outermost first
    std::unordered_map<std::uint32_t, NodeId> without_materials;  // copies of nodes whose own materials were taken away
    int depth = 0;

    Scene& scene() { return loaded.scene; }
    NodeId new_node() {
        scene().nodes.emplace_back();
        return NodeId{static_cast<std::uint32_t>(scene().nodes.size() - 1)};
    }
};

// The z axis up to the y axis up.
constexpr Affine upright{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {0, 0, 0}};
constexpr Affine lying{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, 0}};  // its inverse

template <class Owner>
void turn(Owner& owner, const Affine& rotation, std::initializer_list<Vec3 Owner::*> members) {
    for (const auto member : members) owner.*member = rotation.vector(owner.*member);
}
void turn(scene::Camera& c, const Affine& r) { turn(c, r, {&scene::Camera::position, &scene::Camera::target, &scene::Camera::up, &scene::Camera::travel, &scene::Camera::target_travel}); }
void turn(scene::Light& l, const Affine& r) { turn(l, r, {&scene::Light::position, &scene::Light::direction, &scene::Light::up}); }

// The kind of shapes whose faces are in another file.
const std::string part_name{*std::rbegin(geometry::shape_names)};

bool is_scene_file(const fs::path& file) { return file.extension() == ".json"; }

bool is_url(const std::string& path) {
    const auto colon = path.find(':');
    if (colon == std::string::npos || colon == 0) return false;
    return std::all_of(path.begin(), path.begin() + static_cast<std::ptrdiff_t>(colon),
                       [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '-' || c == '.'; });
}

// The index of things by the name under which the file's references find them.
class Names {
public:
    explicit Names(std::string what) : what_(std::move(what)) {}

    void add(const std::string& name, std::uint32_t index, const Json& json, const Place& place, ProblemList& problems) {
        if (name.empty()) return;
        if (index_.emplace(name, index).second) names_.push_back(name);
        else problems.add(json, place, "there is another " + what_ + " '" + name.substr(0, 100) + "'");
    }
    std::optional<std::uint32_t> find(const Json& json, const Place& place, ProblemList& problems) const {
        if (!json.text()) {
            problems.add(json, place, "is " + std::string(json.kind()) + ", must be the name of a " + what_);
            return std::nullopt;
        }
        if (const auto found = index_.find(*json.text()); found != index_.end()) return found->second;
        const std::string hint = problems.full() || names_.size() > 1000 ? std::string{} : spelling_hint(*json.text(), names_);
        problems.add(json, place, "there is no " + what_ + " '" + json.text()->substr(0, 100) + "'", hint);
        return std::nullopt;
    }

private:
    std::string what_;
    std::unordered_map<std::string, std::uint32_t> index_;
    std::vector<std::string> names_;
};

// Reads one file into the scene.
class Document : ObjectHome {
public:
    Document(Loading& loading, std::string name, fs::path folder) : loading_(loading), problems_(std::move(name)), folder_(std::move(folder)) {}

    Roots read(std::string_view text) {
        Roots roots;
        if (const auto json = parse_json(text, problems_)) roots = read_document(*json);
        for (Problem& problem : problems_.take()) loading_.problems.push_back(std::move(problem));
        for (const Problem& warning : problems_.warnings()) loading_.loaded.warnings.push_back(warning);
        return roots;
    }

private:
    Scene& scene() { return loading_.scene(); }
    bool outermost() const { return loading_.chain.size() == 1; }
    void must_be(const Json& json, const Place& place, const std::string& wanted) {
        problems_.add(json, place, "is " + std::string(json.kind()) + ", must be " + wanted);
    }

    // References go by key; by name for the entries of a list.
    static const std::string& handle(const std::string& key, const std::string& name) { return key.empty() ? name : key; }

    Roots read_document(const Json& json) {
        const Place top;
        if (!json.object()) return must_be(json, top, "an object"), Roots{};
        const auto known = names_of(document_words());
        for (const auto& member : *json.object()) {
            if (std::find(known.begin(), known.end(), member.key) == known.end()) unknown_member(member, top, known, problems_);
        }
        read_measure(json, top);
        const std::string name = read_name(json, top, "", problems_);
        if (outermost()) scene().name = name;
        read_surroundings(json, top);
        if (const Json* lights = json.find("lights")) read_lights(*lights, top / "lights");
        if (const Json* materials = json.find("materials")) {
            for_each_entry(*materials, top / "materials", problems_, [&](const Json& value, const Place& place, const std::string& key) {
                scene().materials.push_back(read_material(value, measure_, place, problems_));
                scene().materials.back().name = read_name(value, place, key, problems_);
                materials_.add(handle(key, scene().materials.back().name), std::uint32_t(scene().materials.size() - 1), value, place, problems_);
            });
        }
        if (const Json* shapes = json.find("shapes")) {
            for_each_entry(*shapes, top / "shapes", problems_, [&](const Json& value, const Place& place, const std::string& key) {
                const std::string shape_name = read_name(value, place, key, problems_);
                const Json* part = value.find(part_name);
                auto shape = part ? read_part(value, *part, place) : read_shape(value, measure_, place, problems_);
                scene().shapes.push_back({shape_name, shape ? std::move(*shape) : geometry::Shape{}});
                shapes_.add(handle(key, shape_name), std::uint32_t(scene().shapes.size() - 1), value, place, problems_);
            });
        }
        ObjectReader objects(*this, measure_, problems_, loading_.depth);
        if (const Json* groups = json.find("groups")) {
            for_each_entry(*groups, top / "groups", problems_, [&](const Json& value, const Place& place, const std::string& key) {
                groups_.add(handle(key, read_name(value, place, key, problems_)), loading_.new_node().value, value, place, problems_);
                group_nodes_.push_back(NodeId{std::uint32_t(scene().nodes.size() - 1)});
            });
            std::size_t index = 0;
            for_each_entry(*groups, top / "groups", problems_, [&](const Json& value, const Place& place, const std::string& key) {
                objects.read_into(group_nodes_[index++], value, place, key);
            });
        }
        Roots roots;
        if (const Json* shown = json.find("objects")) roots = objects.read_all(*shown, top / "objects");
        if (!z_up_ || roots.empty()) return roots;
        const NodeId turned = loading_.new_node();
        scene().nodes[turned.value].name = "z up";
        scene().nodes[turned.value].transform = upright;
        scene().nodes[turned.value].children = std::move(roots);
        return {turned};
    }

    // The exact faces of a shape of a model file, for the shape that comes next.
    std::optional<geometry::Shape> read_part(const Json& json, const Json& part, const Place& place) {
        const std::vector<std::string> own{part_name, name_word().name};
        for (const auto& member : *json.object()) {
            if (std::find(own.begin(), own.end(), member.key) == own.end()) unknown_member(member, place, own, problems_);
        }
        const Place here = place / part_name;
        if (!part.object()) return must_be(part, here, "an object"), std::nullopt;
        const auto known = names_of(brep_words());
        for (const auto& member : *part.object()) {
            if (std::find(known.begin(), known.end(), member.key) == known.end()) unknown_member(member, here, known, problems_);
        }
        const Json* file = part.find("file");
        if (!file) return problems_.add(part, here, "has no member 'file'"), std::nullopt;
        std::uint32_t index = 0;
        if (const Json* which = part.find("index")) {
            const std::int64_t* number = which->integer();
            if (!number || *number < 0 || *number > std::numeric_limits<std::int32_t>::max()) return must_be(*which, here / "index", "a whole number, 0 or more"), std::nullopt;
            index = static_cast<std::uint32_t>(*number);
        }
        const auto identity = existing_file(*file, here / "file");
        if (!identity) return std::nullopt;
        if (is_scene_file(*identity)) return problems_.add(*file, here / "file", "is a scene file: name the model file itself"), std::nullopt;
        const std::deque<scene::NamedShape>& shapes = shapes_of(*identity);
        if (index >= shapes.size()) {
            if (!shapes.empty()) problems_.add(part, here, "there is no shape " + std::to_string(index) + " among the " + std::to_string(shapes.size()) + " of the file");
            return std::nullopt;
        }
        if (!std::holds_alternative<geometry::Brep>(shapes[index].shape)) return problems_.add(part, here, "shape " + std::to_string(index) + " of the file is no exact one"), std::nullopt;
        loading_.loaded.sources[static_cast<std::uint32_t>(scene().shapes.size())] = {*identity, index};
        return shapes[index].shape;
    }

    // Read at the first mention. Where it cannot be, that is told once, and there are none.
    const std::deque<scene::NamedShape>& shapes_of(const fs::path& file) {
        const auto [found, is_new] = loading_.shapes_of.try_emplace(file);
        if (!is_new) return found->second;
        auto model = read_scene(file, loading_.options);
        if (!model) return take_problems(model.error()), found->second;
        for (Problem& warning : model->warnings) loading_.loaded.warnings.push_back(std::move(warning));
        return found->second = std::move(model->scene.shapes);
    }

    void read_measure(const Json& json, const Place& top) {
        if (const Json* unit = json.find("unit")) {
            std::vector<std::string> names;
            for (const auto& known : length_units()) names.push_back(known.name);
            const LengthUnit* found = unit->text() ? find_unit(*unit->text()) : nullptr;
            if (found) measure_ = {found->metres, found->name};
            else if (!unit->text()) must_be(*unit, top / "unit", "a text");
            else problems_.add(*unit, top / "unit", "'" + unit->text()->substr(0, 100) + "' is no unit of length", spelling_hint(*unit->text(), names));
        }
        if (outermost()) scene().unit = {measure_.name, measure_.metres};
        if (const Json* up = json.find("up")) {
            z_up_ = up->text() && *up->text() == "z";
            if (!z_up_ && !(up->text() && *up->text() == "y")) problems_.add(*up, top / "up", "must be \"y\" or \"z\"");
        }
    }

    // What only the outermost file may say; in the others it is checked and left out.
    void read_surroundings(const Json& json, const Place& top) {
        if (const Json* settings = json.find("settings")) {
            scene::Settings read;
            read_fields(*settings, read, scene::Settings::fields(), measure_, top / "settings", problems_);
            if (outermost()) scene().settings = read;
        }
        if (const Json* camera = json.find("camera")) {
            scene::Camera read;
            if (z_up_) turn(read, lying);  // so that what the file leaves out stays as it is
            read_fields(*camera, read, scene::Camera::fields(), measure_, top / "camera", problems_);
            if (z_up_) turn(read, upright);
            if (outermost()) scene().camera = read;
        }
        if (const Json* environment = json.find("environment")) {
            scene::Environment read;
            read_fields(*environment, read, scene::Environment::fields(), measure_, top / "environment", problems_);
            if (outermost()) {
                for (const char* from : {"image", "sky"}) {
                    if (const Json* named = environment->find(from)) load_panorama(read, *named, top / "environment" / from, problems_);
                }
                scene().environment = read;
            }
        }
    }

    void read_lights(const Json& json, const Place& place) {
        const std::string own[] = {name_word().name};
        std::size_t count = 0;
        for_each_entry(json, place, problems_, [&](const Json& value, const Place& here, const std::string& key) {
            scene::Light light;
            if (z_up_) turn(light, lying);
            read_fields(value, light, scene::Light::fields(), measure_, here, problems_, own);
            if (z_up_) turn(light, upright);
            const Json* profile = value.object() && outermost() ? value.find("profile") : nullptr;
            if (profile) load_profile(light, *profile, here / "profile", problems_);
            light.name = read_name(value, here, key, problems_);
            ++count;
            if (outermost()) scene().lights.push_back(std::move(light));
        });
        if (!outermost() && count > 0) {
            loading_.loaded.warnings.push_back({problems_.file(), place.pointer(), "the lights of a scene within a scene are left out", {}});
        }
    }

    std::optional<scene::ShapeId> shape(const Json& json, const Place& place, ProblemList& problems) override {
        const auto found = shapes_.find(json, place, problems);
        return found ? std::optional(scene::ShapeId{*found}) : std::nullopt;
    }
    std::optional<scene::MaterialId> material(const Json& json, const Place& place, ProblemList& problems) override {
        if (json.object()) {
            const scene::Material own = read_own_material(json, measure_, place, problems);
            auto& all = scene().materials;
            auto same = std::find_if(all.begin(), all.end(), [&own](const scene::Material& m) { return m.name == own.name && m.model == own.model && m.textures == own.textures; });
            if (same == all.end()) same = all.insert(all.end(), own);
            return scene::MaterialId{static_cast<std::uint32_t>(same - all.begin())};
        }
        const auto found = materials_.find(json, place, problems);
        return found ? std::optional(scene::MaterialId{*found}) : std::nullopt;
    }
    std::optional<NodeId> instance(const Json& json, const Place& place, ProblemList& problems) override {
        const auto found = groups_.find(json, place, problems);
        return found ? std::optional(NodeId{*found}) : std::nullopt;
    }
    std::vector<NodeId> file(const Json& json, bool bare, const Place& place, ProblemList&) override {
        Roots roots = file_roots(json, place);
        if (bare) std::transform(roots.begin(), roots.end(), roots.begin(), [this](NodeId root) { return stripped(root); });
        return roots;
    }
    scene::ShapeId add(scene::NamedShape shape) override {
        scene().shapes.push_back(std::move(shape));
        return {static_cast<std::uint32_t>(scene().shapes.size() - 1)};
    }
    NodeId add_node() override { return loading_.new_node(); }
    void set(NodeId node, scene::Node value) override { scene().nodes[node.value] = std::move(value); }

    // The file that is named, by its whole path. Nothing, told: there is none.
    std::optional<fs::path> existing_file(const Json& json, const Place& place) {
        if (!json.text() || json.text()->empty() || json.text()->find('\0') != std::string::npos) return must_be(json, place, "the path of a file"), std::nullopt;
        const std::string& reference = *json.text();
        if (is_url(reference)) return problems_.add(json, place, "'" + reference.substr(0, 100) + "' is an address, not a file's path"), std::nullopt;
        std::error_code error;
        const fs::path file = folder_ / reference;
        fs::path identity = fs::weakly_canonical(file, error);
        if (error) identity = file;
        if (loading_.files.contains(identity) || fs::is_regular_file(identity, error)) return identity;
        return problems_.add(json, place, "there is no file '" + reference.substr(0, 300) + "'"), std::nullopt;
    }

    // The top nodes of another file, read at its first mention.
    Roots file_roots(const Json& json, const Place& place) {
        const auto found = existing_file(json, place);
        if (!found) return {};
        const fs::path &identity = *found, file = folder_ / *json.text();
        if (const auto known = loading_.files.find(identity); known != loading_.files.end()) {
            if (known->second) return *known->second;
            problems_.add(json, place, "the files refer to each other in a ring: " + ring_text(identity));
            return {};
        }
        loading_.files[identity] = std::nullopt;
        Roots roots = is_scene_file(identity) ? read_inner_scene(file, identity) : read_model(file);
        loading_.files[identity] = roots;
        return roots;
    }

    Roots read_inner_scene(const fs::path& file, const fs::path& identity) {
        const auto text = read_whole_file(file);
        if (!text) return take_problems(text.error()), Roots{};
        loading_.chain.push_back(identity);
        Document inner{loading_, file.string(), file.parent_path()};
        Roots roots = inner.read(*text);
        loading_.chain.pop_back();
        return roots;
    }

    Roots read_model(const fs::path& file) {
        auto model = read_scene(file, loading_.options);
        if (!model) return take_problems(model.error()), Roots{};
        for (Problem& warning : model->warnings) loading_.loaded.warnings.push_back(std::move(warning));
        Scene& from = model->scene;
        Scene& to = scene();
        const auto materials = std::uint32_t(to.materials.size()), shapes = std::uint32_t(to.shapes.size()), nodes = std::uint32_t(to.nodes.size());
        for (auto& [shape, source] : model->sources) loading_.loaded.sources[shape + shapes] = std::move(source);
        for (auto& material : from.materials) to.materials.push_back(std::move(material));
        for (auto& shape : from.shapes) to.shapes.push_back(std::move(shape));
        for (auto& node : from.nodes) {
            if (node.shape.valid()) node.shape.value += shapes;
            for (auto& material : node.materials) material.value += materials;
            for (auto& child : node.children) child.value += nodes;
            to.nodes.push_back(std::move(node));
        }
        for (auto& root : from.roots) root.value += nodes;
        return std::move(from.roots);
    }

    void take_problems(const Error& error) {
        for (const Problem& problem : error.problems) loading_.problems.push_back(problem);
    }

    std::string ring_text(const fs::path& file) const {
        std::string text;
        const auto first = std::find(loading_.chain.begin(), loading_.chain.end(), file);
        for (auto link = first; link != loading_.chain.end(); ++link) text += link->filename().string() + " -> ";
        return text + file.filename().string();
    }

    // The node, and what is below it, without materials of its own, so that those of an object above hold. Each node is
    // copied once, however many objects show it.
    NodeId stripped(NodeId root) {
        std::vector<NodeId> open;
        const auto copy_of = [&](NodeId node) {
            auto& done = loading_.without_materials;
            if (const auto found = done.find(node.value); found != done.end()) return found->second;
            const NodeId copy = loading_.new_node();
            scene().nodes[copy.value] = scene().nodes[node.value];
            done[node.value] = copy;
            done[copy.value] = copy;  // nothing is left to take away from it
            open.push_back(node);
            return copy;
        };
        const NodeId result = copy_of(root);
        while (!open.empty()) {
            const NodeId node = open.back();
            open.pop_back();
            std::vector<NodeId> children;
            for (const NodeId child : std::vector<NodeId>(scene().nodes[node.value].children)) children.push_back(copy_of(child));
            scene::Node& copy = scene().nodes[loading_.without_materials.at(node.value).value];
            copy.children = std::move(children);
            copy.materials.clear();
        }
        return result;
    }

    Loading& loading_;
    ProblemList problems_;
    fs::path folder_;
    Measure measure_;
    bool z_up_ = false;
    Names materials_{"material"}, shapes_{"shape"}, groups_{"group"};
    std::vector<NodeId> group_nodes_;
};

Expected<Loaded> read_outermost(std::string_view text, const std::string& name, const fs::path& folder, const fs::path& identity, const ReadOptions& options) {
    Loading loading;
    loading.options = options;
    loading.chain.push_back(identity);
    loading.files[identity] = std::nullopt;
    Document document{loading, name, folder};
    loading.scene().roots = document.read(text);
    if (!loading.problems.empty()) return tl::unexpected(Error{ErrorKind::input, std::move(loading.problems)});
    return std::move(loading.loaded);
}

}  // namespace

Expected<Loaded> read_scene_file(const fs::path& file, const ReadOptions& options) {
    const auto text = read_whole_file(file);
    if (!text) return tl::unexpected(text.error());
    std::error_code error;
    const fs::path identity = fs::weakly_canonical(file, error);
    return read_outermost(*text, file.string(), file.parent_path(), error ? file : identity, options);
}

Expected<Loaded> read_scene_text(std::string_view text, const std::string& name, const fs::path& folder) {
    return read_outermost(text, name, folder, folder / name, {});
}

}  // namespace crescente::io
