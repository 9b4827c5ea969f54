#include "io/occt/references.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "io/text_file.h"

namespace crescente::io::occt {
namespace {

namespace fs = std::filesystem;

// The first text in the parentheses after each of these words.
void add_names(std::string_view text, std::string_view word, std::set<std::string>& names) {
    for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + word.size())) {
        const std::size_t end = text.find(';', at), begin = text.find('\'', at);
        if (begin == std::string_view::npos || begin > end) continue;
        const std::size_t close = text.find('\'', begin + 1);
        if (close == std::string_view::npos || close == begin + 1) continue;
        names.emplace(text.substr(begin + 1, close - begin - 1));
    }
}

bool leaves_folder(const std::string& name) {
    const bool encoded = name.find("\\X") != std::string::npos;  // a directive that may stand for any character
    const fs::path path(name);
    return encoded || path.is_absolute() || std::find(path.begin(), path.end(), "..") != path.end();
}

}  // namespace

Expected<std::vector<std::string>> references_of(const fs::path& file, const std::string& shown_name) {
    const fs::path folder = file.parent_path();
    std::vector<std::string> result;
    std::set<std::string> seen;
    std::vector<fs::path> open{file};
    std::error_code code;
    while (!open.empty()) {
        const auto text = read_whole_file(open.back());
        open.pop_back();
        if (!text) continue;
        std::set<std::string> names;
        for (const char* word : {"DOCUMENT_FILE", "EXTERNAL_IDENTIFICATION_ASSIGNMENT", "EXTERNAL_SOURCE"}) add_names(*text, word, names);
        for (const std::string& name : names) {
            if (!seen.insert(name).second) continue;
            const fs::path at = folder / name;
            if (leaves_folder(name)) {
                if (name.find("\\X") == std::string::npos && !fs::exists(at, code)) continue;
                return failure(ErrorKind::input, {shown_name, {}, "refers to '" + name.substr(0, 100) + "', which does not lie in its folder", "put it beside this file"});
            }
            if (fs::is_regular_file(at, code)) {
                result.push_back(name);
                open.push_back(at);
            }
        }
    }
    return result;
}

}  // namespace crescente::io::occt
