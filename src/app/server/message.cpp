#include "app/server/message.h"

#include <algorithm>

#include "base/spelling.h"
#include "io/edit_text.h"
#include "io/json_fields.h"

namespace crescente::app {
namespace {

using io::Json;
using io::Place;
using io::ProblemList;

constexpr int most_times = 10'000;
constexpr std::size_t longest_text = 4096;
constexpr std::int64_t most_view_pixels = std::int64_t{1} << 24;    // of which all trees are kept
constexpr std::int64_t most_export_pixels = std::int64_t{1} << 28;

// Reads the value of one verb; every function tells what is wrong and then returns anything.
class RequestReader {
public:
    explicit RequestReader(ProblemList& problems) : problems_(problems) {}

    Request read(std::string_view verb, Json& value, const Place& place) {
        struct Verb {
            std::string_view name;
            Request (RequestReader::*read)(Json&, const Place&);
        };
        static constexpr Verb table[] = {
            {"undo", &RequestReader::undo},     {"redo", &RequestReader::redo},       {"look", &RequestReader::look},
            {"view", &RequestReader::view},     {"until", &RequestReader::until},     {"pause", &RequestReader::pause},
            {"attend", &RequestReader::attend}, {"layer", &RequestReader::layer},     {"pick", &RequestReader::pick},
            {"replay", &RequestReader::replay}, {"shown", &RequestReader::shown},     {"open", &RequestReader::open},
            {"files", &RequestReader::files},   {"studio", &RequestReader::studio},   {"environment_file", &RequestReader::environment_file},
            {"ground", &RequestReader::ground},
            {"export", &RequestReader::export_picture}, {"cancel", &RequestReader::cancel}};
        for (const Verb& known : table) {
            if (known.name == verb) return (this->*known.read)(value, place);
        }
        return EditScene{};
    }

private:
    void must_be(const Json& json, const Place& place, const std::string& wanted) { problems_.add(json, place, "is " + std::string(json.kind()) + ", must be " + wanted); }

    std::int64_t whole(const Json& json, const Place& place, std::int64_t least, std::int64_t most) {
        const auto* number = json.integer();
        if (number && *number >= least && *number <= most) return *number;
        problems_.add(json, place, "must be a whole number from " + std::to_string(least) + " to " + std::to_string(most));
        return least;
    }
    // Members of an object: all of these are there, maybe the optional ones, and no others.
    bool members(const Json& json, const Place& place, std::vector<std::string> known, const std::vector<std::string>& optional = {}) {
        if (!json.object()) return must_be(json, place, "an object"), false;
        bool right = true;
        const std::vector<std::string> required = known;
        known.insert(known.end(), optional.begin(), optional.end());
        for (const auto& member : *json.object()) {
            if (std::find(known.begin(), known.end(), member.key) != known.end()) continue;
            io::unknown_member(member, place, known, problems_);
            right = false;
        }
        for (const std::string& name : required) {
            if (json.find(name)) continue;
            problems_.add(json, place, "'" + name + "' is missing");
            right = false;
        }
        return right;
    }
    std::string text(const Json& json, const Place& place) {
        const std::string* read = json.text();
        if (!read) return must_be(json, place, "a text"), std::string{};
        if (read->empty() || read->size() > longest_text || read->find('\0') != std::string::npos) {
            problems_.add(json, place, "must be a text of 1 to " + std::to_string(longest_text) + " bytes without zeros");
            return {};
        }
        return *read;
    }
    // The place of a text in a list of names.
    std::size_t one_of(const Json& json, const Place& place, std::span<const std::string_view> names) {
        const std::string name = text(json, place);
        const auto found = std::find(names.begin(), names.end(), name);
        if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
        if (!name.empty()) problems_.add(json, place, "'" + name.substr(0, 300) + "' is not known", spelling_hint(name.substr(0, 300), std::vector<std::string>(names.begin(), names.end())));
        return 0;
    }
    scene::Level level(const Json& json, const Place& place) {
        const auto& fields = scene::Settings::fields();
        const auto found = std::find_if(fields.begin(), fields.end(), [](const auto& f) { return f.info.name == "level"; });
        const auto value = io::read_value(json, found->info, {}, place, problems_);
        return value ? static_cast<scene::Level>(std::get<std::int64_t>(*value)) : scene::Level::edges;
    }

    void check_pixels(const Json& json, const Place& place, int width, int height, std::int64_t most) {
        if (std::int64_t{width} * height > most) problems_.add(json, place, "is larger than " + std::to_string(most) + " pixels");
    }

    Request undo(Json& json, const Place& place) { return UndoEdits{static_cast<int>(whole(json, place, 1, most_times))}; }
    Request redo(Json& json, const Place& place) { return RedoEdits{static_cast<int>(whole(json, place, 1, most_times))}; }
    Request look(Json& json, const Place& place) {
        if (!json.object()) must_be(json, place, "a camera of a scene file");
        return Look{std::move(json)};
    }
    Request view(Json& json, const Place& place) {
        if (!members(json, place, {"width", "height"})) return ViewSize{};
        const ViewSize size{static_cast<int>(whole(*json.find("width"), place / "width", 1, widest_view)), static_cast<int>(whole(*json.find("height"), place / "height", 1, widest_view))};
        check_pixels(json, place, size.width, size.height, most_view_pixels);
        return size;
    }
    Request until(Json& json, const Place& place) { return GrowUntil{level(json, place)}; }
    Request pause(Json& json, const Place& place) {
        if (!json.boolean()) return must_be(json, place, "true or false"), Pause{};
        return Pause{*json.boolean()};
    }
    Request attend(Json& json, const Place& place) {
        if (json.is_null()) return Attend{};
        if (!members(json, place, {"x", "y", "width", "height"})) return Attend{};
        const auto number = [&](const char* name) { return static_cast<int>(whole(*json.find(name), place / name, -widest_view, widest_view)); };
        return Attend{render::Area{number("x"), number("y"), number("width"), number("height")}};
    }
    Request layer(Json& json, const Place& place) { return ShowLayer{static_cast<ShownLayer>(one_of(json, place, layer_names()))}; }
    template <class At>
    Request pixel(Json& json, const Place& place) {
        if (!members(json, place, {"x", "y"})) return At{};
        return At{static_cast<int>(whole(*json.find("x"), place / "x", 0, widest_view)), static_cast<int>(whole(*json.find("y"), place / "y", 0, widest_view))};
    }
    Request pick(Json& json, const Place& place) { return pixel<PickAt>(json, place); }
    Request replay(Json& json, const Place& place) { return pixel<ReplayAt>(json, place); }
    Request shown(Json& json, const Place& place) { return FrameShown{static_cast<std::uint32_t>(whole(json, place, 0, 0xffffffff))}; }
    Request open(Json& json, const Place& place) { return OpenFile{text(json, place)}; }
    Request files(Json& json, const Place& place) {
        if (json.is_null()) return ListFiles{};
        return ListFiles{text(json, place)};
    }
    Request studio(Json& json, const Place& place) {
        if (json.is_null()) return SetStudio{};
        return SetStudio{text(json, place)};
    }
    Request ground(Json& json, const Place& place) { return SetGround{static_cast<scene::Ground>(one_of(json, place, ground_names()))}; }
    Request environment_file(Json& json, const Place& place) {
        if (json.is_null()) return EnvironmentFile{};
        return EnvironmentFile{text(json, place)};
    }
    Request export_picture(Json& json, const Place& place) {
        const Json* format = json.find("format");
        const bool scene_only = format && format->text() && *format->text() == "json";
        const std::vector<std::string> of_picture{"width", "height", "level"};
        std::vector<std::string> needed{"format"}, optional{"camera"};
        auto& place_of_size = scene_only ? optional : needed;
        place_of_size.insert(place_of_size.end(), of_picture.begin(), of_picture.end());
        if (!members(json, place, needed, optional)) return Export{};
        Export wanted;
        wanted.format = export_formats()[one_of(*format, place / "format", export_formats())];
        constexpr int largest = 32768;
        if (const Json* width = json.find("width")) wanted.width = static_cast<int>(whole(*width, place / "width", 1, largest));
        if (const Json* height = json.find("height")) wanted.height = static_cast<int>(whole(*height, place / "height", 1, largest));
        check_pixels(json, place, wanted.width, wanted.height, most_export_pixels);
        if (const Json* of = json.find("level")) wanted.level = level(*of, place / "level");
        for (Json::Member& member : *json.object()) {
            if (member.key != "camera" || member.value.is_null()) continue;
            if (!member.value.object()) must_be(member.value, place / "camera", "a camera of a scene file");
            wanted.camera = std::move(member.value);
        }
        return wanted;
    }
    Request cancel(Json& json, const Place& place) { return CancelExport{static_cast<std::uint32_t>(whole(json, place, 0, 0xffffffff))}; }

    ProblemList& problems_;
};

// What stands beside the verb goes into the message, and the verb remains.
void take_beside(Json::Object& object, Message& message, ProblemList& problems) {
    const Place top;
    std::erase_if(object, [&](Json::Member& member) {
        if (member.key == "id") {
            if (member.value.integer()) message.id = *member.value.integer();
            else problems.add(member.value, top / "id", "must be a whole number");
            return true;
        }
        if (member.key == "gesture") {
            constexpr std::size_t longest_gesture = 256;
            if (member.value.text() && member.value.text()->size() <= longest_gesture) message.gesture = *member.value.text();
            else problems.add(member.value, top / "gesture", "must be a text of at most 256 bytes");
            return true;
        }
        return false;
    });
}

}  // namespace

std::span<const io::Word> request_words() {
    static const std::vector<io::Word> words{
        {"undo", "whole number", "Takes back so many edits, the last first"},
        {"redo", "whole number", "Makes so many edits again that were taken back"},
        {"look", "camera of a scene file", "A camera that `undo` does not take back; only the newest counts"},
        {"view", "width and height", "Size of the picture in pixels; only the newest counts"},
        {"until", "level of realism", "Where growing stops"},
        {"pause", "boolean", "Whether the picture grows"},
        {"attend", "area, or `null`", "What grows first"},
        {"layer", "name of a layer", "What the frames show"},
        {"pick", "x and y", "What is seen through a pixel"},
        {"replay", "x and y", "The ray trees of a pixel"},
        {"shown", "number of a frame", "The page has drawn it, and may get more"},
        {"open", "file", "Opens a model: an upload, an example, a recent file, or a file in an allowed folder"},
        {"files", "folder, or `null`", "What can be opened"},
        {"studio", "name of a studio, or `null`", "Lights, surroundings and ground in place of those that are there, or none"},
        {"ground", "name of a ground", "What the model stands on: solid, catch (only shadows and reflections are seen) or none"},
        {"environment_file", "file, or `null`", "A picture that surrounds the scene, or none"},
        {"export", "see below", "Makes a picture, or the scene, to be downloaded"},
        {"cancel", "number of an export", "Gives it up"},
    };
    return words;
}

std::span<const io::Word> beside_words() {
    static const std::vector<io::Word> words{
        {"id", "whole number", "The answer repeats it"},
        {"gesture", "text", "Consecutive edits with the same one are taken back as one"},
    };
    return words;
}

std::span<const std::string_view> layer_names() {
    static constexpr std::string_view names[] = {"color", "samples", "influence", "level"};
    return names;
}

std::span<const std::string_view> ground_names() {
    static constexpr std::string_view names[] = {"solid", "catch", "none"};
    return names;
}

std::span<const std::string_view> export_formats() {
    static constexpr std::string_view names[] = {"png", "exr", "tiff", "jpeg", "hdr", "json"};
    return names;
}

Message read_message(std::string_view text) {
    ProblemList problems{""};
    Message message{std::nullopt, {}, Request{EditScene{}}};
    const auto done = [&]() -> Message&& {
        if (!problems.empty()) message.request = tl::unexpected(Error{ErrorKind::input, problems.take()});
        return std::move(message);
    };
    if (text.size() > longest_message) {
        problems.add("", "is longer than " + std::to_string(longest_message) + " bytes");
        return done();
    }
    auto json = io::parse_json(text, problems);
    if (!json) return done();
    if (json->object()) take_beside(*json->object(), message, problems);
    auto verbs = io::names_of(request_words());
    for (const io::Word& word : io::edit_words()) verbs.push_back(word.name);
    const Json::Member* member = io::only_member(*json, Place{}, verbs, problems);
    if (!member) return done();
    const auto own = request_words();
    if (std::any_of(own.begin(), own.end(), [&](const io::Word& word) { return word.name == member->key; })) {
        const Place top;
        Json::Member& taken = json->object()->front();
        message.request = RequestReader(problems).read(taken.key, taken.value, top / taken.key);
    } else {
        message.request = Request{EditScene{std::move(*json)}};
    }
    return done();
}

}  // namespace crescente::app
