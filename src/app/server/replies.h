// What the program says to the page (docs/protocol.md): each function makes one text message.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "io/scene_words.h"
#include "render/session.h"

namespace crescente::app {

using ReplyJson = nlohmann::ordered_json;
using MessageId = std::optional<std::int64_t>;  // of the message that is answered

// {"NAME": value}, with the id if there is one. Text that is not UTF-8 is replaced.
std::string reply(const std::string& name, ReplyJson value, const MessageId& id = {});

std::string error_reply(const Error& error, const MessageId& id);
ReplyJson problems_json(const Problems& problems);

// After an edit. revision: of the scene, which the message `scene` has, too.
struct EditState {
    std::size_t undoable = 0, redoable = 0;
    std::uint64_t revision = 0;
};
std::string edited_reply(const render::EditReport& report, const EditState& state, const MessageId& id);

// Lengths in the scene's unit.
std::string picked_reply(const std::optional<render::Pick>& pick, const scene::Scene& scene, const MessageId& id);

// Messages to the page: name, what its value looks like, what it says.
std::span<const io::Word> reply_words();

}  // namespace crescente::app
