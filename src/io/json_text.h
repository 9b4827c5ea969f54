// JSON as scene files use it: comments allowed, every value knows its line, members keep their order, and a key given twice is
// an error. Tokens come from nlohmann's parser; the values are our own because its values know neither line nor order.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/error.h"

namespace crescente::io {

class Json {
public:
    struct Member;
    using Array = std::vector<Json>;
    using Object = std::vector<Member>;

    Json() = default;
    explicit Json(bool v) : value_(v) {}
    explicit Json(std::int64_t v) : value_(v) {}
    explicit Json(double v) : value_(v) {}
    explicit Json(std::string v) : value_(std::make_unique<std::string>(std::move(v))) {}
    static Json make_array() { return Json{Value{std::make_unique<Array>()}}; }
    static Json make_object() { return Json{Value{std::make_unique<Object>()}}; }

    // Null where the value is of another kind. A number may be written with or without a fraction.
    bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
    const bool* boolean() const { return std::get_if<bool>(&value_); }
    const std::int64_t* integer() const { return std::get_if<std::int64_t>(&value_); }
    std::optional<double> number() const;
    const std::string* text() const { return pointee<std::string>(); }
    const Array* array() const { return pointee<Array>(); }
    const Object* object() const { return pointee<Object>(); }
    Array* array() { return const_cast<Array*>(std::as_const(*this).array()); }
    Object* object() { return const_cast<Object*>(std::as_const(*this).object()); }

    const Json* find(std::string_view key) const;  // a member's value; null if this is no object or has no such member
    std::string_view kind() const;                 // "a number", "an object", ...
    std::uint32_t line() const { return line_; }   // from 1; 0: unknown
    void set_line(std::uint32_t line) { line_ = line; }

private:
    using Value = std::variant<std::monostate, bool, std::int64_t, double, std::unique_ptr<std::string>, std::unique_ptr<Array>,
                               std::unique_ptr<Object>>;
    explicit Json(Value v) : value_(std::move(v)) {}
    template <class T>
    const T* pointee() const {
        const auto* p = std::get_if<std::unique_ptr<T>>(&value_);
        return p ? p->get() : nullptr;
    }

    Value value_;
    std::uint32_t line_ = 0;
};

struct Json::Member {
    std::string key;
    Json value;
};

// Where a value stands: a chain of keys and indices on the stack of the reader, written out only when there is a problem.
struct Place {
    const Place* parent = nullptr;
    std::string_view key{};
    std::size_t index = none;

    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    Place operator/(std::string_view member) const { return {this, member, none}; }
    Place operator/(std::size_t element) const { return {this, {}, element}; }
    std::string pointer() const;  // JSON pointer (RFC 6901)
};

// The problems of one file. Past a limit they are only counted: a hostile file must not fill the memory with complaints.
class ProblemList {
public:
    explicit ProblemList(std::string file) : file_(std::move(file)) {}

    void add(const Json& value, const Place& place, std::string reason, std::string hint = {});
    void add(std::string place, std::string reason, std::string hint = {});
    bool empty() const { return problems_.empty(); }
    bool full() const { return problems_.size() >= limit; }
    const std::string& file() const { return file_; }
    Problems take();  // with one more that counts those left out

    // What is not as it should be, but does no harm.
    void warn(const Problems& warnings) { warnings_.insert(warnings_.end(), warnings.begin(), warnings.end()); }
    const Problems& warnings() const { return warnings_; }

private:
    static constexpr std::size_t limit = 500;
    std::string file_;
    Problems problems_, warnings_;
    std::size_t left_out_ = 0;
};

// A problem for a member that is not among the known ones, with the nearest spelling.
void unknown_member(const Json::Member& member, const Place& object, std::span<const std::string> known, ProblemList& problems);

// Nothing if the text is not JSON; all that is wrong is told in `problems`. Nesting deeper than 512 is refused. `first_line`: that of the text in its
// file.
std::optional<Json> parse_json(std::string_view text, ProblemList& problems, std::uint32_t first_line = 1);

}  // namespace crescente::io
