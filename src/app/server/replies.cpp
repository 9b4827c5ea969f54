#include "app/server/replies.h"

#include <vector>

namespace crescente::app {
namespace {

ReplyJson vector_json(math::Vec3 v) { return {v.x, v.y, v.z}; }

const char* name_of(ErrorKind kind) {
    switch (kind) {
        case ErrorKind::usage: return "usage";
        case ErrorKind::input: return "input";
        case ErrorKind::output: return "output";
        case ErrorKind::unsupported: return "unsupported";
        case ErrorKind::resource: return "resource";
        case ErrorKind::internal: return "internal";
    }
    return "internal";
}

}  // namespace

std::string reply(const std::string& name, ReplyJson value, const MessageId& id) {
    ReplyJson json = ReplyJson::object();
    json[name] = std::move(value);
    if (id) json["id"] = *id;
    return json.dump(-1, ' ', false, ReplyJson::error_handler_t::replace);
}

ReplyJson problems_json(const Problems& problems) {
    ReplyJson list = ReplyJson::array();
    for (const Problem& p : problems) list.push_back({{"file", p.file}, {"place", p.place}, {"reason", p.reason}, {"hint", p.hint}});
    return list;
}

std::string error_reply(const Error& error, const MessageId& id) { return reply("error", {{"kind", name_of(error.kind)}, {"problems", problems_json(error.problems)}}, id); }

std::string edited_reply(const render::EditReport& report, const EditState& state, const MessageId& id) {
    return reply("edited", {{"began_anew", report.began_anew}, {"seconds", report.seconds}, {"can_undo", state.undoable}, {"can_redo", state.redoable}, {"revision", state.revision}}, id);
}

std::string picked_reply(const std::optional<render::Pick>& pick, const scene::Scene& scene, const MessageId& id) {
    if (!pick) return reply("picked", nullptr, id);
    ReplyJson path = ReplyJson::array();
    for (const scene::NodeId node : pick->path) path.push_back(node.value);
    return reply("picked",
                 {{"path", std::move(path)},
                  {"face", pick->face},
                  {"material", pick->material.valid() ? ReplyJson(pick->material.value) : ReplyJson(nullptr)},
                  {"position", vector_json(pick->position / scene.unit.metres)},
                  {"normal", vector_json(pick->normal)}},
                 id);
}

std::span<const io::Word> reply_words() {
    static const std::vector<io::Word> words{
        {"welcome", "see the schema", "The first message"},
        {"opening", "file, fraction and stage", "A file is being read"},
        {"opened", "file", "It was read; `scene` follows"},
        {"files", "see the schema", "What can be opened"},
        {"scene", "see the schema", "All of the scene but geometry; after edits what they changed"},
        {"edited", "see the schema", "An edit is done"},
        {"picked", "see the schema, or `null`", "What is seen through a pixel"},
        {"replayed", "text and trees", "The ray trees of a pixel"},
        {"progress", "see the schema", "How far the picture is"},
        {"exporting", "number and fraction", "How far an export is"},
        {"exported", "see the schema", "An export is there"},
        {"error", "kind and problems", "What was asked for was not done"},
        {"closed", "reason", "The session was given up"},
    };
    return words;
}

}  // namespace crescente::app
