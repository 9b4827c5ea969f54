#include "io/content_hash.h"

#include <cinttypes>
#include <cstdio>
#include <fstream>
#include <memory>
#include <vector>

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace crescente::io {

Expected<std::string> content_hash(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::vector<char> block(1 << 18);
    const std::unique_ptr<XXH64_state_t, decltype(&XXH64_freeState)> state(XXH64_createState(), XXH64_freeState);
    if (!state) return failure(ErrorKind::resource, {file.string(), "", "not enough memory to read it", ""});
    XXH64_reset(state.get(), 0);
    while (stream) {
        stream.read(block.data(), static_cast<std::streamsize>(block.size()));
        XXH64_update(state.get(), block.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (!stream.eof()) return failure(ErrorKind::input, {file.string(), "", "cannot be read", ""});
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016" PRIx64, static_cast<std::uint64_t>(XXH64_digest(state.get())));
    return std::string(digits);
}

}  // namespace crescente::io
