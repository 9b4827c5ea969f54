#include "io/ies_file.h"

#include <charconv>
#include <cmath>
#include <optional>

#include "io/text_file.h"

namespace crescente::io {
namespace {

constexpr double degree = math::pi / 180;

// Lines, and after them numbers between blanks and commas.
class Reader {
public:
    Reader(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

    // Nothing at the end.
    std::optional<std::string_view> line() {
        if (rest_.empty()) return std::nullopt;
        const auto end = rest_.find('\n');
        std::string_view one = rest_.substr(0, end);
        rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
        line_ = ++ended_;
        if (!one.empty() && one.back() == '\r') one.remove_suffix(1);
        return one;
    }

    // The next number; what is wrong is kept, and all that follows is 0.
    double number(const char* what) {
        if (problem_) return 0;
        while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t' || rest_.front() == '\r' || rest_.front() == '\n' || rest_.front() == ',')) {
            ended_ += rest_.front() == '\n';
            rest_.remove_prefix(1);
        }
        line_ = ended_ + 1;
        if (!rest_.empty() && rest_.front() == '+') rest_.remove_prefix(1);
        double value = 0;
        const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
        if (error != std::errc{} || !std::isfinite(value)) {
            wrong(rest_.empty() ? "the file ends where there should be " + std::string(what)
                                : "'" + std::string(rest_.substr(0, std::min<std::size_t>(rest_.find_first_of(" \t\r\n,"), 40))) + "' should be " + what);
            return 0;
        }
        rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
        return value;
    }
    std::vector<double> numbers(std::size_t count, const char* what) {
        std::vector<double> list;
        while (list.size() < count && !problem_) list.push_back(number(what));
        return list;
    }

    void wrong(std::string reason, std::string hint = {}) {
        if (!problem_) problem_ = Problem{file_, "line " + std::to_string(std::max(1, line_)), std::move(reason), std::move(hint)};
    }
    const std::optional<Problem>& problem() const { return problem_; }
    std::size_t left() const { return rest_.size(); }

private:
    std::string_view rest_;
    const std::string& file_;
    int ended_ = 0, line_ = 0;  // lines that were gone past; the one that was read from last
    std::optional<Problem> problem_;
};

bool rises(const std::vector<double>& angles) {
    for (std::size_t i = 1; i < angles.size(); ++i) {
        if (!(angles[i] > angles[i - 1])) return false;
    }
    return true;
}

bool is_one_of(double value, std::initializer_list<double> choices) { return std::find(choices.begin(), choices.end(), value) != choices.end(); }

}  // namespace

Expected<std::shared_ptr<const scene::LightProfile>> read_ies(std::string_view text, const std::string& file) {
    Reader in(text, file);
    const auto problem = [&] { return tl::unexpected<Error>({ErrorKind::input, {*in.problem()}}); };
    std::string_view tilt;
    while (tilt.empty()) {
        const auto line = in.line();
        if (!line) {
            in.wrong("there is no line TILT=", "IES files (LM-63) have one before their numbers");
            return problem();
        }
        if (line->substr(0, 5) == "TILT=") tilt = *line;
    }
    if (tilt.substr(5, 4) != "NONE") in.wrong("'" + std::string(tilt.substr(0, 80)) + "': only lamps without tilt can be read", "TILT=NONE");
    in.number("the number of lamps"), in.number("lumens");
    const double multiplier = in.number("the candela multiplier");
    const double rows = in.number("the number of vertical angles"), columns = in.number("the number of horizontal angles");
    const auto countable = [&](double n) { return n >= 1 && n <= 10000 && n == std::floor(n); };
    if (!in.problem() && (!countable(rows) || !countable(columns) || rows * columns > static_cast<double>(in.left()))) in.wrong("there cannot be so many angles");
    if (in.number("the photometric type") != 1) in.wrong("only photometry of type C (1) can be read");
    in.number("the units of lengths"), in.number("a width"), in.number("a length"), in.number("a height");
    const double ballast = in.number("the ballast factor");
    in.number("a number for future use"), in.number("the input watts");
    if (multiplier < 0 || ballast < 0) in.wrong("the candela multiplier and the ballast factor must not be negative");
    if (in.problem()) return problem();
    std::vector<double> vertical = in.numbers(static_cast<std::size_t>(rows), "a vertical angle");
    if (!in.problem() && (!rises(vertical) || !is_one_of(vertical.front(), {0, 90}) || !is_one_of(vertical.back(), {0, 90, 180}))) {
        in.wrong("the vertical angles must rise from 0 or 90 to 90 or 180 degrees");
    }
    std::vector<double> horizontal = in.numbers(static_cast<std::size_t>(columns), "a horizontal angle");
    if (!in.problem() && (!rises(horizontal) || horizontal.front() != 0 || !is_one_of(horizontal.back(), {0, 90, 180, 360}))) {
        in.wrong("the horizontal angles must rise from 0 to 0, 90, 180 or 360 degrees");
    }
    std::vector<double> candela;
    while (candela.size() < vertical.size() * horizontal.size() && !in.problem()) {
        candela.push_back(in.number("a candela value") * multiplier * ballast);
        if (!(candela.back() >= 0 && std::isfinite(candela.back()))) in.wrong("a candela value must be finite and not negative");
    }
    if (in.problem()) return problem();
    for (double& angle : vertical) angle *= degree;
    for (double& angle : horizontal) angle *= degree;
    return std::make_shared<const scene::LightProfile>(std::move(vertical), std::move(horizontal), std::move(candela));
}

Expected<std::shared_ptr<const scene::LightProfile>> read_ies_file(const std::filesystem::path& file) {
    const auto text = read_whole_file(file);
    if (!text) return tl::unexpected(text.error());
    return read_ies(*text, file.string());
}

void load_profile(scene::Light& light, const Json& json, const Place& place, ProblemList& problems) {
    light.measured = nullptr;
    if (light.profile.empty()) return;
    if (light.profile.find('\0') != std::string::npos) return problems.add(json, place, "must be the path of a file");
    const std::filesystem::path named = std::filesystem::path(problems.file()).parent_path() / light.profile;
    auto read = read_ies_file(named);
    if (!read) {
        for (const Problem& problem : read.error().problems) problems.add(json, place, problem.text());
        return;
    }
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::absolute(named, error);
    if (!error) light.profile = whole.lexically_normal().string();
    light.measured = std::move(*read);
}

}  // namespace crescente::io
