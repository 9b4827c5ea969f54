// Messages from the page (docs/protocol.md): what is asked for, read from a text that may come from anybody.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "io/json_text.h"
#include "io/scene_words.h"
#include "render/session.h"
#include "scene/settings.h"
#include "scene/studio.h"

namespace crescente::app {

struct EditScene {
    io::Json edit;  // an edit of docs/edits.md, to be read against the scene of the moment
};
struct UndoEdits {
    int times = 1;
};
struct RedoEdits {
    int times = 1;
};
struct Look {
    io::Json camera;
    std::uint32_t number = 0;  // of the connection's looks, given when it arrives
};
struct ViewSize {
    int width = 0, height = 0;
};
struct GrowUntil {
    scene::Level level = scene::Level::edges;
};
struct Pause {
    bool paused = false;
};
struct Attend {
    std::optional<render::Area> area;
};
enum class ShownLayer { color, samples, influence, level };
struct ShowLayer {
    ShownLayer layer = ShownLayer::color;
};
struct PickAt {
    int x = 0, y = 0;
};
struct ReplayAt {
    int x = 0, y = 0;
};
struct FrameShown {
    std::uint32_t number = 0;
};
struct OpenFile {
    std::string file;
};
struct ListFiles {
    std::optional<std::string> folder;  // none: the start page
};
struct SetStudio {
    std::optional<std::string> name;
};
struct SetGround {
    scene::Ground ground = scene::Ground::none;
};
struct EnvironmentFile {
    std::optional<std::string> file;  // none: the gradient again
};
struct Export {
    std::string format;
    int width = 0, height = 0;
    scene::Level level = scene::Level::edges;
    std::optional<io::Json> camera;  // none: the one by which the picture is seen
};
struct CancelExport {
    std::uint32_t number = 0;
};
using Request = std::variant<EditScene, UndoEdits, RedoEdits, Look, ViewSize, GrowUntil, Pause, Attend, ShowLayer, PickAt, ReplayAt, FrameShown, OpenFile, ListFiles,
                             SetStudio, SetGround, EnvironmentFile, Export, CancelExport>;

struct Message {
    std::optional<std::int64_t> id;  // that the answer repeats
    std::string gesture;             // consecutive edits with the same one, unless it is empty, are one for undo
    Expected<Request> request;       // or every problem (input), each with its JSON pointer
};

// Raised when a message that was right gets another meaning, or one side has to know of a new one.
inline constexpr int protocol_version = 2;
inline constexpr std::size_t longest_message = std::size_t{1} << 20;  // bytes
inline constexpr int widest_view = 8192;                              // pixels, also the highest

// The verbs besides those of edits, and what stands beside a verb.
std::span<const io::Word> request_words();
std::span<const io::Word> beside_words();
std::span<const std::string_view> layer_names();    // by ShownLayer
std::span<const std::string_view> export_formats();
std::span<const std::string_view> ground_names();   // by scene::Ground

Message read_message(std::string_view text);

}  // namespace crescente::app
