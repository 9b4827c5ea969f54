#include "app/server/protocol_schema.h"

#include <nlohmann/json.hpp>

#include "app/server/message.h"
#include "app/server/replies.h"
#include "io/edit_text.h"
#include "io/json_print.h"
#include "io/scene_schema.h"
#include "render/level.h"
#include "scene/studio.h"

namespace crescente::app {
namespace {

using Schema = nlohmann::ordered_json;

Schema of_type(const char* type) { return {{"type", type}}; }
Schema text() { return of_type("string"); }
Schema number() { return of_type("number"); }
Schema boolean() { return of_type("boolean"); }
Schema whole(std::int64_t least = 0) { return {{"type", "integer"}, {"minimum", least}}; }
Schema ref(const std::string& name) { return {{"$ref", "#/$defs/" + name}}; }
Schema list_of(Schema items) { return {{"type", "array"}, {"items", std::move(items)}}; }
Schema any_of(std::initializer_list<Schema> choices) { return {{"anyOf", choices}}; }
Schema or_null(Schema schema) { return any_of({std::move(schema), of_type("null")}); }

Schema numbers(int count) {
    Schema list = list_of(number());
    list["minItems"] = list["maxItems"] = count;
    return list;
}

template <class Names>
Schema one_of(const Names& names) {
    Schema list = Schema::array();
    for (const auto& name : names) list.push_back(std::string(name));
    return {{"enum", std::move(list)}};
}

// All members are there, but for those whose name ends in "?".
Schema object(std::initializer_list<std::pair<std::string, Schema>> members) {
    Schema properties = Schema::object(), required = Schema::array();
    for (const auto& [name, schema] : members) {
        const bool optional = name.back() == '?';
        const std::string bare = optional ? name.substr(0, name.size() - 1) : name;
        properties[bare] = schema;
        if (!optional) required.push_back(bare);
    }
    return {{"type", "object"}, {"properties", std::move(properties)}, {"required", std::move(required)}};
}

Schema level_names() {
    std::vector<std::string> names;
    for (const render::LevelKind& level : render::levels()) names.emplace_back(level.name);
    return one_of(names);
}

// What may name objects in an edit, and how they are moved.
Schema thing() { return any_of({text(), whole()}); }
Schema things() { return any_of({text(), whole(), list_of(thing())}); }
Schema steps() { return ref("transform"); }

Schema edit_values() {
    const Schema material = any_of({text(), whole(), ref("material")});
    return {{"set", {{"type", "object"}}},
            {"move", object({{"object", things()}, {"transform?", steps()}, {"by?", steps()}})},
            {"show", things()},
            {"hide", things()},
            {"assign", object({{"object", things()}, {"material?", material}, {"materials?", list_of(material)}, {"below?", boolean()}})},
            {"add", of_type("object")},
            {"remove", things()},
            {"duplicate", object({{"object", thing()}, {"name", text()}, {"by?", steps()}})},
            {"material", ref("material")},
            {"shape", of_type("object")},
            {"light", ref("light")},
            {"remove_light", thing()},
            {"camera", ref("camera")},
            {"environment", or_null(ref("environment"))},
            {"batch", list_of(ref("edit"))}};
}

Schema request_values() {
    const Schema pixel = object({{"x", whole()}, {"y", whole()}});
    const auto integer = [] { return of_type("integer"); };
    return {{"undo", whole(1)},
            {"redo", whole(1)},
            {"look", ref("camera")},
            {"view", object({{"width", whole(1)}, {"height", whole(1)}})},
            {"until", ref("level")},
            {"pause", boolean()},
            {"attend", or_null(object({{"x", integer()}, {"y", integer()}, {"width", integer()}, {"height", integer()}}))},
            {"layer", one_of(layer_names())},
            {"pick", pixel},
            {"replay", pixel},
            {"shown", whole()},
            {"open", text()},
            {"files", or_null(text())},
            {"studio", or_null(one_of(scene::studio_names))},
            {"ground", one_of(ground_names())},
            {"environment_file", or_null(text())},
            {"export", object({{"format", one_of(export_formats())}, {"width?", whole(1)}, {"height?", whole(1)}, {"level?", ref("level")}, {"camera?", or_null(ref("camera"))}})},
            {"cancel", whole()}};
}

Schema reply_values() {
    const Schema bounds = or_null(object({{"low", numbers(3)}, {"high", numbers(3)}}));
    const Schema index = whole(), index_or_null = or_null(whole());
    const Schema file = object({{"name", text()}, {"title", text()}, {"file", text()}, {"bytes?", whole()}, {"time?", of_type("integer")}});
    const Schema problem = object({{"file", text()}, {"place", text()}, {"reason", text()}, {"hint", text()}});
    const Schema entry = object({{"index", index}, {"name", text()}, {"visible", boolean()}, {"shape", or_null(text())}, {"triangles?", whole()}, {"faces?", whole()},
                                 {"material", index_or_null}, {"materials?", list_of(index_or_null)}, {"transform", numbers(12)}, {"bounds", bounds}, {"children", list_of(index)}});
    Schema changed = entry;  // its index, and those members that are other than they were
    changed["required"] = {"index"};
    return {{"welcome",
             object({{"version", text()}, {"protocol", {{"const", protocol_version}}}, {"session", text()}, {"taken_up", boolean()},
                     {"limits", object({{"upload", whole()}, {"message", whole()}, {"width", whole()}, {"height", whole()}})},
                     {"levels", list_of(ref("level"))}, {"layers", list_of(text())}, {"formats", list_of(text())}, {"studios", list_of(text())},
                     {"library", list_of(object({{"name", text()}, {"group", text()}, {"note", text()}, {"color", numbers(3)}}))}})},
            {"opening", object({{"file", text()}, {"fraction", number()}, {"stage", text()}})},
            {"opened", object({{"file", text()}})},
            {"files", object({{"folder", or_null(text())}, {"folders", list_of(text())}, {"files", list_of(file)}, {"environments", list_of(file)}, {"examples", list_of(file)}, {"recent", list_of(file)}})},
            {"scene", object({{"name", text()}, {"unit", text()}, {"metres", number()}, {"file", text()}, {"revision", whole()}, {"can_undo", whole()}, {"can_redo", whole()}, {"opened?", {{"const", true}}},
                              {"warnings?", list_of(problem)}, {"bounds?", bounds}, {"objects?", list_of(entry)}, {"changed?", list_of(changed)}, {"gone?", list_of(index)}, {"roots?", list_of(index)}, {"ground?", one_of(ground_names())},
                              {"materials?", list_of(ref("material"))}, {"lights?", list_of(ref("light"))}, {"studio?", or_null(one_of(scene::studio_names))}, {"camera?", or_null(ref("camera"))},
                              {"environment?", or_null(ref("environment"))}, {"settings?", ref("settings")}})},
            {"edited", object({{"began_anew", boolean()}, {"seconds", number()}, {"can_undo", whole()}, {"can_redo", whole()}, {"revision", whole()}})},
            {"picked", or_null(object({{"path", list_of(index)}, {"face", whole()}, {"material", index_or_null}, {"position", numbers(3)}, {"normal", numbers(3)}}))},
            {"replayed", object({{"text", text()}, {"trees", list_of(ref("tree"))}})},
            {"progress", object({{"level", text()}, {"fraction", number()}, {"until", ref("level")}, {"done", boolean()}, {"paused", boolean()}, {"first_picture", boolean()}, {"seconds", number()},
                                 {"rays", whole()}, {"rays_per_second", number()}, {"bytes", whole()}, {"nodes", whole()}, {"edit_rays", whole()}, {"edit_camera_rays", whole()}, {"edit_tiles", whole()},
                                 {"fresh_rays", or_null(whole())}})},
            {"exporting", object({{"number", whole()}, {"fraction", number()}})},
            {"exported", object({{"number", whole()}, {"name", text()}, {"bytes", whole()}, {"address", text()}})},
            {"error", object({{"kind", one_of(std::vector<std::string>{"usage", "input", "output", "unsupported", "resource", "internal"})}, {"problems", list_of(problem)}})},
            {"closed", object({{"reason", text()}})}};
}

Schema tree_schema() {
    const Schema light = object({{"light", whole()}, {"name", text()}, {"state", text()}, {"share", numbers(3)}, {"strength", numbers(3)}});
    return object({{"kind", text()}, {"object", or_null(whole())}, {"influence", numbers(3)}, {"color", numbers(3)}, {"at?", numbers(2)}, {"direction?", numbers(3)}, {"material?", or_null(whole())},
                   {"face?", whole()}, {"inside?", boolean()}, {"distance?", number()}, {"position?", numbers(3)}, {"normal?", numbers(3)}, {"local?", numbers(3)}, {"lights?", list_of(light)},
                   {"children?", list_of(ref("tree"))}, {"not_grown?", list_of(object({{"kind", text()}, {"influence", number()}}))}});
}

// An object with one of the words, and what may stand beside it.
Schema one_member(std::span<const io::Word> words, const Schema& values, const Schema& beside) {
    Schema choices = Schema::array();
    for (const io::Word& word : words) {
        Schema value = {{"description", word.doc}};
        value.update(values.at(word.name));
        Schema properties{{word.name, std::move(value)}};
        properties.update(beside);
        choices.push_back({{"type", "object"}, {"properties", std::move(properties)}, {"required", {word.name}}});
    }
    return {{"oneOf", std::move(choices)}};
}

}  // namespace

std::string protocol_schema() {
    const Schema scenes = Schema::parse(io::scene_schema());
    Schema defs = scenes.at("$defs");
    defs["level"] = level_names();
    Schema beside = Schema::object();
    for (const io::Word& word : beside_words()) beside[word.name] = {{"description", word.doc}, {"type", word.name == "id" ? "integer" : "string"}};
    const Schema edits = one_member(io::edit_words(), edit_values(), Schema::object());
    defs["edit"] = edits;
    Schema requests = one_member(io::edit_words(), edit_values(), beside);
    const Schema own = one_member(request_words(), request_values(), beside);
    for (const Schema& one : own.at("oneOf")) requests["oneOf"].push_back(one);
    defs["request"] = std::move(requests);
    defs["tree"] = tree_schema();
    defs["reply"] = one_member(reply_words(), reply_values(), {{"id", {{"description", "Of the message that is answered"}, {"type", "integer"}}}});
    Schema schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Crescente viewer protocol, version " + std::to_string(protocol_version)}};
    schema["anyOf"] = {ref("request"), ref("reply")};
    schema["$defs"] = std::move(defs);
    std::string out;
    io::print_json(schema, out);
    return out + "\n";
}

}  // namespace crescente::app
