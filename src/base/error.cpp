#include "base/error.h"

namespace crescente {

std::string Problem::text() const {
    std::string result;
    for (const std::string* part : {&file, &place}) {
        if (!part->empty()) result += *part + ": ";
    }
    result += reason;
    if (!hint.empty()) result += " (" + hint + ")";
    return result;
}

std::string Error::text() const {
    std::string result;
    for (const Problem& problem : problems) {
        if (!result.empty()) result += '\n';
        result += problem.text();
    }
    return result;
}

}  // namespace crescente
