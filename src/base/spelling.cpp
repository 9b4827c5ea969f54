#include "base/spelling.h"

#include <algorithm>
#include <cctype>
#include <vector>

namespace crescente {
namespace {

char lower(char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }

std::size_t distance(std::string_view a, std::string_view b) {
    std::vector<std::vector<std::size_t>> d(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
    for (std::size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
    for (std::size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (same ? 0 : 1)});
            if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1])) {
                d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
            }
        }
    }
    return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_spelling(std::string_view name, std::span<const std::string> candidates) {
    constexpr std::size_t longest_name = 64;  // hostile input: the distance is quadratic
    if (name.size() > longest_name) return {};
    std::string best;
    std::size_t best_distance = name.size() / 3 + 2;
    for (const std::string& candidate : candidates) {
        if (candidate.size() > longest_name) continue;
        const std::size_t d = distance(name, candidate);
        if (d < best_distance) {
            best_distance = d;
            best = candidate;
        }
    }
    return best;
}

std::string spelling_hint(std::string_view name, std::span<const std::string> candidates) {
    if (const std::string best = nearest_spelling(name, candidates); !best.empty()) return "did you mean '" + best + "'?";
    constexpr std::size_t short_list = 12;
    if (candidates.empty() || candidates.size() > short_list) return {};
    std::string list = "one of ";
    for (std::size_t i = 0; i < candidates.size(); ++i) list += (i ? ", " : "") + candidates[i];
    return list;
}

}  // namespace crescente
