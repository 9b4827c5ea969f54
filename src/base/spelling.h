// The nearest valid spelling of a name that does not exist.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace crescente {

// The candidate with the smallest edit distance (Damerau 1964, adjacent transpositions count one) if it is at most a third of
// the name's length plus one; otherwise empty. Case differences are free.
std::string nearest_spelling(std::string_view name, std::span<const std::string> candidates);

// "did you mean 'x'?", or "one of a, b, c" when nothing is near and the list is short, or empty.
std::string spelling_hint(std::string_view name, std::span<const std::string> candidates);

}  // namespace crescente
