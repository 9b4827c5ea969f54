#include "io/json_text.h"

#include <algorithm>
#include <iterator>
#include <unordered_set>

#include <nlohmann/json.hpp>

#include "base/spelling.h"

namespace crescente::io {
namespace {

constexpr std::size_t deepest_nesting = 512;

// The lines that the parser has read so far. A number is known to end only at the character after it, which may already be a
// line feed; `line_before` is the line of the character read last.
struct Cursor {
    std::uint32_t line = 1, line_before = 1;
};

// Characters that count lines while nlohmann's parser takes them.
struct CountingIterator {
    using iterator_category = std::input_iterator_tag;
    using value_type = char;
    using difference_type = std::ptrdiff_t;
    using pointer = const char*;
    using reference = const char&;

    const char* at = nullptr;
    Cursor* cursor = nullptr;

    const char& operator*() const { return *at; }
    CountingIterator& operator++() {
        cursor->line_before = cursor->line;
        if (*at == '\n') ++cursor->line;
        ++at;
        return *this;
    }
    CountingIterator operator++(int) {
        CountingIterator old = *this;
        ++*this;
        return old;
    }
    bool operator==(const CountingIterator& other) const { return at == other.at; }
};

std::string line_and_column(std::string_view text, std::size_t byte, std::uint32_t first_line) {
    const std::string_view before = text.substr(0, std::min(byte > 0 ? byte - 1 : 0, text.size()));
    const auto line = first_line + std::count(before.begin(), before.end(), '\n');
    const std::size_t start = before.rfind('\n');
    const std::size_t column = before.size() - (start == std::string_view::npos ? 0 : start + 1) + 1;
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

// "[json.exception.parse_error.101] parse error at line 1, column 5: syntax error while ..." without what comes before the matter.
std::string matter_of(std::string message) {
    if (const auto bracket = message.find("] "); message.starts_with('[') && bracket != std::string::npos) message.erase(0, bracket + 2);
    if (message.starts_with("parse error at line ")) message.erase(0, message.find(": ") + 2);
    constexpr std::size_t longest = 300;
    if (message.size() > longest) message = message.substr(0, longest) + "...";
    return message;
}

// Builds values from nlohmann's events.
class Builder {
public:
    using number_integer_t = nlohmann::json::number_integer_t;
    using number_unsigned_t = nlohmann::json::number_unsigned_t;
    using number_float_t = nlohmann::json::number_float_t;
    using string_t = nlohmann::json::string_t;
    using binary_t = nlohmann::json::binary_t;

    Builder(std::string_view text, const Cursor& cursor, ProblemList& problems)
        : text_(text), cursor_(cursor), first_line_(cursor.line), problems_(problems) {}

    bool null() { return put(Json{}, cursor_.line); }
    bool boolean(bool v) { return put(Json{v}, cursor_.line); }
    bool number_integer(number_integer_t v) { return put(Json{std::int64_t{v}}, cursor_.line_before); }
    bool number_unsigned(number_unsigned_t v) {
        const bool fits = v <= static_cast<number_unsigned_t>(std::numeric_limits<std::int64_t>::max());
        return put(fits ? Json{static_cast<std::int64_t>(v)} : Json{static_cast<double>(v)}, cursor_.line_before);
    }
    bool number_float(number_float_t v, const string_t&) { return put(Json{v}, cursor_.line_before); }
    bool string(string_t& v) { return put(Json{std::move(v)}, cursor_.line); }
    bool binary(binary_t&) { return false; }
    bool start_object(std::size_t) { return open(Json::make_object()); }
    bool start_array(std::size_t) { return open(Json::make_array()); }
    bool key(string_t& name) {
        open_.back()->object()->push_back({std::move(name), Json{}});
        open_.back()->object()->back().value.set_line(cursor_.line);
        return true;
    }
    bool end_object() {
        report_duplicates(*open_.back());
        open_.pop_back();
        return true;
    }
    bool end_array() {
        open_.pop_back();
        return true;
    }
    bool parse_error(std::size_t byte, const std::string&, const nlohmann::detail::exception& error) {
        problems_.add(line_and_column(text_, byte, first_line_), matter_of(error.what()));
        return false;
    }

    Json root;

private:
    Json* place(Json value, std::uint32_t line) {
        value.set_line(line);
        if (open_.empty()) {
            root = std::move(value);
            return &root;
        }
        if (auto* array = open_.back()->array()) {
            array->push_back(std::move(value));
            return &array->back();
        }
        auto& member = open_.back()->object()->back();
        member.value = std::move(value);
        return &member.value;
    }
    bool put(Json value, std::uint32_t line) {
        place(std::move(value), line);
        return true;
    }
    bool open(Json container) {
        if (open_.size() >= deepest_nesting) {
            problems_.add("line " + std::to_string(cursor_.line), "nested deeper than " + std::to_string(deepest_nesting) + " levels");
            return false;
        }
        open_.push_back(place(std::move(container), cursor_.line));
        return true;
    }
    void report_duplicates(const Json& object) {
        if (object.object()->size() < 2) return;
        std::unordered_set<std::string_view> seen;
        for (const auto& member : *object.object()) {
            if (seen.insert(member.key).second) continue;
            problems_.add("line " + std::to_string(member.value.line()), "'" + member.key + "' is given twice in one object");
        }
    }

    std::string_view text_;
    const Cursor& cursor_;
    std::uint32_t first_line_;
    ProblemList& problems_;
    std::vector<Json*> open_;  // the containers not yet closed, outermost first
};

}  // namespace

std::optional<double> Json::number() const {
    if (const auto* v = std::get_if<double>(&value_)) return *v;
    if (const auto* v = integer()) return static_cast<double>(*v);
    return std::nullopt;
}

const Json* Json::find(std::string_view key) const {
    if (!object()) return nullptr;
    for (const Member& member : *object()) {
        if (member.key == key) return &member.value;
    }
    return nullptr;
}

std::string_view Json::kind() const {
    constexpr std::string_view names[] = {"null", "a boolean", "a number", "a number", "a text", "an array", "an object"};
    return names[value_.index()];
}

std::string Place::pointer() const {
    std::vector<const Place*> chain;
    for (const Place* p = this; p->parent; p = p->parent) chain.push_back(p);
    std::string result;
    for (auto p = chain.rbegin(); p != chain.rend(); ++p) {
        result += '/';
        if ((*p)->index != none) {
            result += std::to_string((*p)->index);
            continue;
        }
        for (const char c : (*p)->key) {
            if (c == '~') result += "~0";
            else if (c == '/') result += "~1";
            else result += c;
        }
    }
    return result;
}

void ProblemList::add(const Json& value, const Place& place, std::string reason, std::string hint) {
    if (full()) {
        ++left_out_;
        return;
    }
    std::string where = value.line() ? "line " + std::to_string(value.line()) : std::string{};
    if (const std::string pointer = place.pointer(); !pointer.empty()) where += (where.empty() ? "" : ", ") + pointer;
    add(std::move(where), std::move(reason), std::move(hint));
}

void ProblemList::add(std::string place, std::string reason, std::string hint) {
    if (full()) ++left_out_;
    else problems_.push_back({file_, std::move(place), std::move(reason), std::move(hint)});
}

Problems ProblemList::take() {
    if (left_out_ > 0) problems_.push_back({file_, {}, "and " + std::to_string(left_out_) + " more problems", {}});
    left_out_ = 0;
    return std::exchange(problems_, {});
}

void unknown_member(const Json::Member& member, const Place& object, std::span<const std::string> known, ProblemList& problems) {
    // The search for a spelling is not free: not for problems that nobody will read.
    const std::string hint = problems.full() ? std::string{} : spelling_hint(member.key, known);
    problems.add(member.value, object / member.key, "'" + member.key.substr(0, 100) + "' is not known here", hint);
}

std::optional<Json> parse_json(std::string_view text, ProblemList& problems, std::uint32_t first_line) {
    Cursor cursor{first_line, first_line};
    Builder builder{text, cursor, problems};
    const CountingIterator first{text.data(), &cursor}, last{text.data() + text.size(), &cursor};
    constexpr bool strict = true, comments = true;
    if (!nlohmann::json::sax_parse(first, last, &builder, nlohmann::json::input_format_t::json, strict, comments)) return std::nullopt;
    return std::move(builder.root);
}

}  // namespace crescente::io
