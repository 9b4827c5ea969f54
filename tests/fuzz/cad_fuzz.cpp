// What comes from the process that reads CAD files, and from the cache: its messages, models as bytes, entries. OpenCASCADE itself is not ours to fuzz: it
// works in a process of its own because it fails on damaged files. The first byte says which.
#include <cstring>

#include "base/checksum.h"
#include "engine.h"
#include "io/cad_cache.h"
#include "io/cad_messages.h"
#include "io/cad_scene.h"
#include "io/isolated_messages.h"

namespace {

using namespace crescente;

// Only small parts: leaves of patches multiply.
bool is_brief(const io::CadModel& model) {
    std::size_t points = 0;
    for (const auto& part : model.parts) {
        for (const auto& face : part.faces) {
            if (const auto* patches = std::get_if<geometry::PatchSurface>(&face.surface)) {
                for (const auto& patch : patches->patches) points += patch.points.size();
            }
            points += face.loops.size();
        }
    }
    return points < 500;
}

void exercise_model(std::optional<Expected<io::CadModel>> model) {
    if (!model) return;
    if (!*model) return fuzz::require(!model->error().problems.empty());
    const std::string bytes = io::pack_cad(*model);
    const auto again = io::unpack_cad(bytes);
    fuzz::require(again && *again && io::pack_cad(*again) == bytes);
    if (!is_brief(**model)) return;
    std::vector<io::UntraceableFace> untraceable;
    fuzz::exercise(io::cad_scene(**model, untraceable));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    if (size == 0) return 0;
    const std::string_view bytes{reinterpret_cast<const char*>(data) + 1, size - 1};
    if (data[0] == 'm') {  // messages, whole and byte by byte: the same comes out
        io::MessageReader whole(1 << 16, {}), slow(1 << 16, {});
        const bool good = whole.take(bytes);
        bool slow_good = true;
        for (std::size_t i = 0; i < bytes.size() && slow_good; ++i) slow_good = slow.take(bytes.substr(i, 1));
        fuzz::require(good == slow_good && whole.complete() == slow.complete());
        if (good) fuzz::require(whole.answer() == slow.answer());
    } else if (data[0] == 'c') {  // an entry of the cache: with the checksum put right, so that what lies behind is reached
        std::string entry(bytes);
        constexpr std::size_t header = 14 + 4 + 8 + 8;  // mark, version, size, checksum
        if (entry.size() > header) {
            const std::uint64_t body = entry.size() - header, checksum = crescente::checksum(std::string_view(entry).substr(header));
            std::memcpy(entry.data() + 18, &body, sizeof body);
            std::memcpy(entry.data() + 26, &checksum, sizeof checksum);
        }
        if (const auto found = io::cad_cache_entry(entry)) fuzz::require(!found->files.empty());
    } else {
        exercise_model(io::unpack_cad(bytes));
    }
    return 0;
}
