#include "io/edit_script.h"

#include <algorithm>

#include "io/json_fields.h"

namespace crescente::io {
namespace {

using scene::Settings;

constexpr int most_times = 1'000'000;
constexpr double longest_seconds = 1e6;

class ScriptReader {
public:
    ScriptReader(std::string_view text, const std::string& file) : rest_(text), problems_(file) {}

    Expected<std::vector<ScriptLine>> run() {
        for (std::uint32_t number = 1; !rest_.empty(); ++number) {
            const auto end = std::min(rest_.find('\n'), rest_.size());
            read_line(trimmed(rest_.substr(0, end)), number);
            rest_.remove_prefix(std::min(end + 1, rest_.size()));
        }
        if (!problems_.empty()) return tl::unexpected(Error{ErrorKind::input, problems_.take()});
        return std::move(lines_);
    }

private:
    static std::string_view trimmed(std::string_view text) {
        constexpr std::string_view blank = " \t\r";
        const auto first = text.find_first_not_of(blank);
        if (first == std::string_view::npos) return {};
        return text.substr(first, text.find_last_not_of(blank) - first + 1);
    }

    void read_line(std::string_view text, std::uint32_t number) {
        if (text.empty() || text.starts_with("//")) return;
        auto json = parse_json(text, problems_, number);
        if (!json) return;
        auto verbs = names_of(script_words());
        for (const Word& word : edit_words()) verbs.push_back(word.name);
        const Json::Member* member = only_member(*json, Place{}, verbs, problems_);
        if (!member) return;
        const Place top;
        const Place place = top / member->key;
        ScriptLine line{number, std::string(text), {}};
        if (member->key == "undo") line.step = Undo{times(member->value, place)};
        else if (member->key == "redo") line.step = Redo{times(member->value, place)};
        else if (member->key == "advance") line.step = advance(member->value, place);
        else if (member->key == "picture") line.step = picture(member->value, place);
        else line.step = std::move(*json);
        lines_.push_back(std::move(line));
    }

    int times(const Json& json, const Place& place) {
        const auto* number = json.integer();
        if (number && *number >= 1 && *number <= most_times) return static_cast<int>(*number);
        problems_.add(json, place, "must be a whole number from 1 to " + std::to_string(most_times));
        return 1;
    }

    Advance advance(const Json& json, const Place& place) {
        Advance read;
        if (!json.object()) {
            problems_.add(json, place, "is " + std::string(json.kind()) + ", must be an object", R"(such as {"seconds": 0.1}, {"level": "shadows"} or {})");
            return read;
        }
        const auto known = names_of(advance_words());
        for (const auto& member : *json.object()) {
            const Place here = place / member.key;
            if (member.key == "seconds") {
                read.seconds = member.value.number();
                if (!read.seconds || !(*read.seconds >= 0 && *read.seconds <= longest_seconds)) problems_.add(member.value, here, "must be a number from 0 to 1e6");
            } else if (member.key == "level") {
                const auto& fields = Settings::fields();
                const auto level = std::find_if(fields.begin(), fields.end(), [](const auto& f) { return f.info.name == "level"; });
                if (const auto value = read_value(member.value, level->info, {}, here, problems_)) {
                    read.level = static_cast<scene::Level>(std::get<std::int64_t>(*value));
                }
            } else {
                unknown_member(member, place, known, problems_);
            }
        }
        return read;
    }

    SavePicture picture(const Json& json, const Place& place) {
        if (json.text() && !json.text()->empty() && json.text()->find('\0') == std::string::npos) return {*json.text()};
        problems_.add(json, place, "must be the path of a file");
        return {};
    }

    std::string_view rest_;
    ProblemList problems_;
    std::vector<ScriptLine> lines_;
};

}  // namespace

Expected<std::vector<ScriptLine>> read_edit_script(std::string_view text, const std::string& file) { return ScriptReader(text, file).run(); }

}  // namespace crescente::io
