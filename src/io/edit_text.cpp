#include "io/edit_text.h"

#include "io/ies_file.h"
#include "io/object_reader.h"
#include "io/panorama_file.h"
#include "io/scene_names.h"
#include "io/scene_parts.h"
#include "io/set_value.h"
#include "io/texture_files.h"

namespace crescente::io {
namespace {

using scene::Draft;
using scene::NodeId;

// Reads edits into a draft, one after the other: each finds what those before it made.
class EditReader : ObjectHome {
public:
    EditReader(const scene::Scene& scene, ProblemList& problems)
        : draft_(scene), problems_(problems), measure_{scene.unit.metres, scene.unit.name}, objects_(*this, measure_, problems, depth_) {}

    void read(const Json& json, const Place& place) {
        const auto verbs = names_of(edit_words());
        const Json::Member* member = only_member(json, place, verbs, problems_);
        if (!member) return;
        struct Verb {
            std::string_view name;
            void (EditReader::*read)(const Json&, const Place&);
        };
        static constexpr Verb table[] = {
            {"set", &EditReader::set_values},        {"move", &EditReader::move},           {"show", &EditReader::show},
            {"hide", &EditReader::hide},             {"assign", &EditReader::assign},       {"add", &EditReader::add_object},
            {"remove", &EditReader::remove},         {"duplicate", &EditReader::duplicate}, {"material", &EditReader::set_material},
            {"shape", &EditReader::set_shape},       {"light", &EditReader::set_light},     {"remove_light", &EditReader::remove_light},
            {"camera", &EditReader::set_camera},     {"environment", &EditReader::set_environment}, {"batch", &EditReader::batch}};
        for (const Verb& verb : table) {
            if (verb.name == member->key) (this->*verb.read)(member->value, place / member->key);
        }
    }

    const Draft& draft() const { return draft_; }

private:
    void must_be(const Json& json, const Place& place, const std::string& wanted) {
        problems_.add(json, place, "is " + std::string(json.kind()) + ", must be " + wanted);
    }
    // The members are known, and those that are required are there.
    bool has_members(const Json& json, const Place& place, std::span<const Word> words, std::initializer_list<const char*> required) {
        if (!json.object()) return must_be(json, place, "an object"), false;
        const auto known = names_of(words);
        bool complete = true;
        for (const auto& member : *json.object()) {
            if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
            unknown_member(member, place, known, problems_);
            complete = false;
        }
        for (const char* name : required) {
            if (json.find(name)) continue;
            problems_.add(json, place, "'" + std::string(name) + "' is missing");
            complete = false;
        }
        return complete;
    }
    // Which of two members is there; null and a problem if none or both.
    const char* one_of(const Json& json, const Place& place, const char* a, const char* b) {
        const bool has_a = json.find(a), has_b = json.find(b);
        if (has_a != has_b) return has_a ? a : b;
        problems_.add(json, place, has_a ? "has both " + std::string(a) + " and " + b : "'" + std::string(a) + "' or '" + b + "' is missing");
        return nullptr;
    }
    // The name that a thing must have.
    std::optional<std::string> required_name(const Json& json, const Place& place) {
        if (!json.object()) return must_be(json, place, "an object"), std::nullopt;
        std::string name = read_name(json, place, "", problems_);
        if (!name.empty()) return name;
        if (!json.find(name_word().name) || json.find(name_word().name)->text()) problems_.add(json, place, "'name' is missing");
        return std::nullopt;
    }

    // The objects as they are now: looked for again after nodes came or went.
    const ObjectNames& names() {
        if (!names_) names_.emplace(draft_);
        return *names_;
    }
    // Each node once, of one reference or a list of them.
    std::vector<ObjectPlace> find_all(const Json& json, const Place& place) {
        if (!json.array()) return names().find(json, place, problems_);
        std::vector<ObjectPlace> found;
        std::size_t index = 0;
        for (const Json& reference : *json.array()) {
            const auto more = names().find(reference, place / index++, problems_);
            found.insert(found.end(), more.begin(), more.end());
        }
        return found;
    }
    template <class Visit>
    void for_each_node(const Json& json, const Place& place, Visit&& visit) {
        std::vector<NodeId> nodes;
        for (const ObjectPlace& at : find_all(json, place)) {
            if (std::find(nodes.begin(), nodes.end(), at.node) == nodes.end()) nodes.push_back(at.node);
        }
        for (const NodeId node : nodes) visit(node);
    }
    // The one thing of a name, or of an index.
    template <class Things>
    std::optional<std::uint32_t> find_thing(const Things& things, const std::string& what, const Json& json, const Place& place) {
        if (const auto* index = json.integer()) {
            if (*index >= 0 && static_cast<std::uint64_t>(*index) < things.size()) return static_cast<std::uint32_t>(*index);
            problems_.add(json, place, "there is no " + what + " " + std::to_string(*index));
            return std::nullopt;
        }
        if (!json.text()) return must_be(json, place, "the name or index of a " + what), std::nullopt;
        const auto found = find_named(things, *json.text());
        if (found.size() == 1) return found.front();
        if (!found.empty()) {
            problems_.add(json, place, "there are " + std::to_string(found.size()) + " such, one must be meant", "by index, such as " + std::to_string(found.front()));
        } else {
            problems_.add(json, place, "there is no " + what + " '" + json.text()->substr(0, 300) + "'", problems_.full() ? std::string{} : nearest_named(things, *json.text()));
        }
        return std::nullopt;
    }

    // --- the verbs

    void set_values(const Json& json, const Place& place) {
        if (!json.object()) return must_be(json, place, "an object of paths and values");
        for (const auto& member : *json.object()) set_value(draft_, member.key, member.value, measure_, place / member.key, problems_);
    }

    void move(const Json& json, const Place& place) {
        if (!has_members(json, place, move_words(), {"object"})) return;
        const Json* motion = json.find("motion");
        const bool only_motion = motion && !json.find("transform") && !json.find("by");
        const char* how = only_motion ? nullptr : one_of(json, place, "transform", "by");
        if (!how && !only_motion) return;
        const math::Affine steps = how ? read_transform(*json.find(how), measure_, place / how, problems_) : math::Affine{};
        std::optional<math::Affine> course;
        if (motion && !motion->is_null()) course = read_transform(*motion, measure_, place / "motion", problems_);
        for_each_node(*json.find("object"), place / "object", [&](NodeId id) {
            scene::Node& node = draft_.nodes.change(id.value);
            if (how) node.transform = how == std::string_view("by") ? steps * node.transform : steps;
            if (motion) node.motion = course;
        });
    }

    void show(const Json& json, const Place& place) {
        for_each_node(json, place, [&](NodeId node) { draft_.nodes.change(node.value).visible = true; });
    }
    void hide(const Json& json, const Place& place) {
        for_each_node(json, place, [&](NodeId node) { draft_.nodes.change(node.value).visible = false; });
    }

    void assign(const Json& json, const Place& place) {
        if (!has_members(json, place, assign_words(), {"object"})) return;
        const char* how = one_of(json, place, "material", "materials");
        if (!how) return;
        std::vector<scene::MaterialId> materials;
        if (how == std::string_view("materials")) materials = objects_.read_materials(*json.find(how), place / how);
        else if (const auto single = material(*json.find(how), place / how, problems_)) materials.push_back(*single);
        bool below = false;
        if (const Json* given = json.find("below")) {
            if (given->boolean()) below = *given->boolean();
            else must_be(*given, place / "below", "true or false");
        }
        for_each_node(*json.find("object"), place / "object", [&](NodeId node) {
            draft_.nodes.change(node.value).materials = materials;
            if (below) bare_below(node);
        });
    }
    // Everything below the node loses materials of its own.
    void bare_below(NodeId top) {
        std::vector<bool> seen(draft_.nodes.size(), false);
        std::vector<NodeId> open = draft_.nodes[top.value].children;
        while (!open.empty()) {
            const NodeId node = open.back();
            open.pop_back();
            if (seen[node.value]) continue;
            seen[node.value] = true;
            if (!draft_.nodes[node.value].materials.empty()) draft_.nodes.change(node.value).materials.clear();
            const auto& children = draft_.nodes[node.value].children;
            open.insert(open.end(), children.begin(), children.end());
        }
    }

    void add_object(const Json& json, const Place& place) {
        if (!json.object()) return must_be(json, place, "an object");
        std::optional<ObjectPlace> group;
        const Json* to = json.find("to");
        if (to) group = names().find_one(*to, place / "to", problems_);
        const NodeId node = add_node();
        objects_.read_into(node, json, place, "", names_of(add_words()));
        if (group) draft_.nodes.change(group->node.value).children.push_back(node);
        else if (!to) draft_.roots.push_back(node);
        names_.reset();
    }

    void remove(const Json& json, const Place& place) {
        const auto take_out = [](std::vector<NodeId>& list, NodeId node) { std::erase(list, node); };
        for (const ObjectPlace& at : find_all(json, place)) {
            const auto from = [&](std::uint32_t parent) { take_out(draft_.nodes.change(parent).children, at.node); };
            if (at.parent.valid()) {
                from(at.parent.value);
                continue;
            }
            take_out(draft_.roots, at.node);
            for_each_parent(at.node, from);
        }
        names_.reset();
    }
    template <class Visit>
    void for_each_parent(NodeId node, Visit&& visit) {
        for (std::uint32_t p = 0; p < draft_.nodes.size(); ++p) {
            const auto& children = draft_.nodes[p].children;
            if (std::find(children.begin(), children.end(), node) != children.end()) visit(p);
        }
    }

    void duplicate(const Json& json, const Place& place) {
        if (!has_members(json, place, duplicate_words(), {"object", "name"})) return;
        const auto name = required_name(json, place);
        const auto source = names().find_one(*json.find("object"), place / "object", problems_);
        math::Affine steps;
        if (const Json* by = json.find("by")) steps = read_transform(*by, measure_, place / "by", problems_);
        if (!name || !source) return;
        scene::Node copy = draft_.nodes[source->node.value];
        copy.name = *name;
        copy.transform = steps * copy.transform;
        const NodeId node{draft_.nodes.add(std::move(copy))};
        const auto put = [&](std::uint32_t parent) { draft_.nodes.change(parent).children.push_back(node); };
        names_.reset();
        if (source->parent.valid()) return put(source->parent.value);
        if (std::find(draft_.roots.begin(), draft_.roots.end(), source->node) != draft_.roots.end()) draft_.roots.push_back(node);
        for_each_parent(source->node, put);
    }

    // Sets all things of the name, by `change`; adds one, by `add`, if there is none.
    template <class Things, class Change, class Add>
    void set_or_add(const Things& things, const std::string& name, Change&& change, Add&& add) {
        const auto found = find_named(things, name);
        for (const std::uint32_t i : found) change(i);
        if (found.empty()) add();
    }

    void set_material(const Json& json, const Place& place) {
        const auto name = required_name(json, place);
        if (!json.object()) return;
        scene::Material material = read_material(json, measure_, place, problems_);
        if (!name) return;
        material.name = *name;
        set_or_add(draft_.materials, *name, [&](std::uint32_t i) { draft_.materials.change(i) = material; },
                   [&] { draft_.materials.add(material); });
    }

    void set_shape(const Json& json, const Place& place) {
        const auto name = required_name(json, place);
        if (!json.object()) return;
        const auto shape = read_shape(json, measure_, place, problems_);
        if (!name || !shape) return;
        set_or_add(draft_.shapes, *name, [&](std::uint32_t i) { draft_.shapes.change(i).shape = *shape; }, [&] { draft_.shapes.add({*name, *shape}); });
    }

    void set_light(const Json& json, const Place& place) {
        const auto name = required_name(json, place);
        if (!json.object()) return;
        scene::Light light;
        const std::string own[] = {name_word().name};
        read_fields(json, light, scene::Light::fields(), measure_, place, problems_, own);
        if (json.object() && json.find("profile")) load_profile(light, *json.find("profile"), place / "profile", problems_);
        if (!name) return;
        light.name = *name;
        const auto change = [&](std::uint32_t i) {
            light.name = draft_.lights[i].name;
            draft_.lights[i] = light;
        };
        set_or_add(draft_.lights, *name, change, [&] { draft_.lights.push_back(light); });
    }

    void remove_light(const Json& json, const Place& place) {
        if (!json.text()) {
            if (const auto light = find_thing(draft_.lights, "light", json, place)) draft_.lights.erase(draft_.lights.begin() + *light);
            return;
        }
        const auto found = find_named(draft_.lights, *json.text());
        if (found.empty()) problems_.add(json, place, "there is no light '" + json.text()->substr(0, 300) + "'", nearest_named(draft_.lights, *json.text()));
        for (auto i = found.rbegin(); i != found.rend(); ++i) draft_.lights.erase(draft_.lights.begin() + *i);
    }

    void set_camera(const Json& json, const Place& place) {
        scene::Camera camera;
        read_fields(json, camera, scene::Camera::fields(), measure_, place, problems_);
        draft_.camera = camera;
    }

    void set_environment(const Json& json, const Place& place) {
        draft_.environment.reset();
        if (json.is_null()) return;
        scene::Environment& environment = draft_.environment.emplace();
        read_fields(json, environment, scene::Environment::fields(), measure_, place, problems_);
        for (const char* from : {"image", "sky"}) {
            const Json* named = json.object() ? json.find(from) : nullptr;
            if (named) load_panorama(environment, *named, place / from, problems_);
        }
    }

    void batch(const Json& json, const Place& place) {
        if (!json.array()) return must_be(json, place, "a list of edits");
        std::size_t index = 0;
        for (const Json& edit : *json.array()) read(edit, place / index++);
    }

    // --- what objects refer to, and where they go

    std::optional<scene::ShapeId> shape(const Json& json, const Place& place, ProblemList&) override {
        const auto found = find_thing(draft_.shapes, "shape", json, place);
        return found ? std::optional(scene::ShapeId{*found}) : std::nullopt;
    }
    std::optional<scene::MaterialId> material(const Json& json, const Place& place, ProblemList&) override {
        if (json.object()) {
            const scene::Material own = read_own_material(json, measure_, place, problems_);
            for (std::uint32_t i = 0; i < draft_.materials.size(); ++i) {
                if (draft_.materials[i].name == own.name && draft_.materials[i].model == own.model && draft_.materials[i].textures == own.textures) return scene::MaterialId{i};
            }
            return scene::MaterialId{draft_.materials.add(own)};
        }
        const auto found = find_thing(draft_.materials, "material", json, place);
        return found ? std::optional(scene::MaterialId{*found}) : std::nullopt;
    }
    // An object of the scene; else a group that nothing shows, or an object that was removed.
    std::optional<NodeId> instance(const Json& json, const Place& place, ProblemList&) override {
        if (json.text()) {
            ProblemList ignored{""};
            const auto aside = find_named(draft_.nodes, *json.text());
            if (aside.size() == 1 && names().find(json, place, ignored).empty()) return NodeId{aside.front()};
        }
        const auto found = names().find_one(json, place, problems_);
        return found ? std::optional(found->node) : std::nullopt;
    }
    std::vector<NodeId> file(const Json& json, bool, const Place& place, ProblemList&) override {
        problems_.add(json, place, "an edit cannot bring a file", "name it in the scene file");
        return {};
    }
    scene::ShapeId add(scene::NamedShape shape) override { return {draft_.shapes.add(std::move(shape))}; }
    NodeId add_node() override { return {draft_.nodes.add({})}; }
    void set(NodeId node, scene::Node value) override { draft_.nodes.change(node.value) = std::move(value); }

    Draft draft_;
    ProblemList& problems_;
    Measure measure_;
    int depth_ = 0;
    ObjectReader objects_;
    std::optional<ObjectNames> names_;
};

// The pictures that the edits bring. What a reader of files warns of is wrong here: there is nobody to be warned.
Expected<void> load_images(std::vector<scene::Edit>& edits, const std::string& file) {
    const auto load = [&](scene::Material& material) -> Expected<void> {
        auto warnings = load_textures({&material, 1}, file, {});
        if (!warnings) return tl::unexpected(warnings.error());
        if (!warnings->empty()) return tl::unexpected(Error{ErrorKind::input, std::move(*warnings)});
        return {};
    };
    for (scene::Edit& edit : edits) {
        Expected<void> loaded;
        if (auto* set = std::get_if<scene::SetMaterial>(&edit)) loaded = load(set->value);
        else if (auto* added = std::get_if<scene::AddMaterial>(&edit)) loaded = load(added->value);
        if (!loaded) return loaded;
    }
    return {};
}

}  // namespace

const Json::Member* only_member(const Json& json, const Place& place, std::span<const std::string> known, ProblemList& problems) {
    if (!json.object() || json.object()->size() != 1) {
        const std::string is = json.object() ? "an object of " + std::to_string(json.object()->size()) + " members" : std::string(json.kind());
        problems.add(json, place, "is " + is + ", must be an object with one member, a verb", "such as {\"hide\": \"wheel\"}; several edits are one in a batch");
        return nullptr;
    }
    const Json::Member& member = json.object()->front();
    if (std::find(known.begin(), known.end(), member.key) != known.end()) return &member;
    unknown_member(member, place, known, problems);
    return nullptr;
}

Expected<std::vector<scene::Edit>> read_edit(const Json& json, const scene::Scene& scene, const std::string& file, Problems* warnings) {
    ProblemList problems{file};
    EditReader reader(scene, problems);
    reader.read(json, Place{});
    if (!problems.empty()) return tl::unexpected(Error{ErrorKind::input, problems.take()});
    if (warnings) warnings->insert(warnings->end(), problems.warnings().begin(), problems.warnings().end());
    std::vector<scene::Edit> edits = reader.draft().edits();
    if (const auto loaded = load_images(edits, file); !loaded) return tl::unexpected(loaded.error());
    return edits;
}

Expected<std::vector<scene::Edit>> read_edit_text(std::string_view text, const scene::Scene& scene, const std::string& file) {
    ProblemList problems{file};
    const auto json = parse_json(text, problems);
    if (!problems.empty() || !json) return tl::unexpected(Error{ErrorKind::input, problems.take()});
    return read_edit(*json, scene, file);
}

}  // namespace crescente::io
